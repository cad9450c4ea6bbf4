// SPDX-License-Identifier: MIT
// Adversaries without a key: whatever they send, a frame between two verified links goes where it went without them.
// The table of decisions is in docs/design/security.md.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <array>

#include "support/seed.hpp"
#include "unit/route/route_frames.hpp"

namespace mavloom::route {
namespace {

using namespace std::chrono_literals;
using test::Bytes;
using test::Id;
using test::pick;

using KeylessStep = std::array<std::uint8_t, 6>;

constexpr LinkId vehicle_link{1}, station_link{2};
constexpr Id vehicle{1, 1}, camera{1, 100}, station{255, 190};
constexpr Id ids[] = {vehicle, camera, station, {1, 0}, {1, 77}, {2, 1}, {255, 77}, {0, 0}};
const Nanoseconds rests[] = {0s, 1ms, 40ms, 600ms, 1s, 2s, 6s, 11s};

Bytes frame_of(const KeylessStep& s, Id source) {
    const Id target = pick(ids, s[3]);
    const test::Fields fields{{"target_system", target.system}, {"target_component", target.component}};
    switch (s[4] % 4) {
        case 0: return test::make_frame("HEARTBEAT", source, {}, s[5] % 4);
        case 1: return test::make_frame("SYSTEM_TIME", source, {{"time_boot_ms", s[5] * 100u}}, s[5] % 4);
        case 2: return test::make_frame("ATTITUDE", source, {}, s[5] % 4);
        default: return test::make_frame("COMMAND_LONG", source, fields, s[5] % 4);
    }
}

// One router with honest traffic alone, and one with adversaries beside it.
class TwoRouters {
public:
    TwoRouters(const Options& options, const LinkPolicy& limits)
        : quiet_(dialect::default_dialect().wire_table(), options),
          attacked_(dialect::default_dialect().wire_table(), options) {
        LinkPolicy policy = limits;
        policy.is_verified = true;
        for (Engine* engine : {&quiet_, &attacked_})
            for (const LinkId link : {vehicle_link, station_link}) engine->add_link(link, policy);
    }

    void step(const KeylessStep& s) {
        switch (s[0] % 8) {
            case 0: now_ += pick(rests, s[1]); return;
            case 1:
            case 2:
            case 3: return honest(s);
            case 4: return replay(s);
            case 5: return attacked_.note_reboot(adversary(s[1]), pick(ids, s[2]), now_);
            case 6: return come_and_go(s[1]);
            default: return attack(s[1], frame_of(s, pick(ids, s[2])));
        }
    }

private:
    [[nodiscard]] static LinkId adversary(std::uint8_t n) { return LinkId{3u + n % 3u}; }

    void honest(const KeylessStep& s) {
        const bool from_vehicle = s[1] % 2 == 0;
        const Bytes bytes = frame_of(s, from_vehicle ? (s[1] % 8 == 0 ? camera : vehicle) : station);
        sent_.push_back(bytes);
        const auto frame = wire::FrameView::unchecked(bytes);
        const LinkId from = from_vehicle ? vehicle_link : station_link;
        const auto expected = verified_of(quiet_.route(frame, from, now_));
        RC_ASSERT(verified_of(attacked_.route(frame, from, now_)) == expected);
    }
    void attack(std::uint8_t n, const Bytes& bytes) {
        attacked_.add_link(adversary(n), {});
        (void)attacked_.route(wire::FrameView::unchecked(bytes), adversary(n), now_);
    }
    // Bytes that an honest link sent, or will send next.
    void replay(const KeylessStep& s) {
        if (s[2] % 2 == 0 && !sent_.empty()) return attack(s[1], sent_[sent_.size() - 1 - s[3] % sent_.size()]);
        KeylessStep next = s;
        attack(s[1], frame_of(next, s[3] % 2 == 0 ? vehicle : station));
    }
    void come_and_go(std::uint8_t n) { attacked_.remove_link(adversary(n)); }

    static std::vector<std::uint32_t> verified_of(const Decision& decision) {
        std::vector<std::uint32_t> links;
        for (const LinkId link : decision.links)
            if (link <= station_link) links.push_back(link.value);
        return links;
    }

    Engine quiet_, attacked_;
    std::vector<Bytes> sent_;
    MonoTime now_{std::chrono::hours{1}};
};

RC_GTEST_PROP(Keyless, NobodyWithoutAKeyChangesTheTrafficOfVerifiedLinks, (std::uint8_t bits)) {
    Options options{.recent_frames = 8192};
    if (bits & 1) options.dedup = 250ms;
    if (bits & 2) options.unknown_component = UnknownComponent::drop;
    if (bits & 4) options.unknown_target = UnknownTarget::flood;
    LinkPolicy limits;
    if (bits & 8) limits.max_rate = test::make_rates({{"COMMAND_LONG", 2}, {"HEARTBEAT", 2}, {"*", 1}});
    if (bits & 16) limits.max_bytes_per_s = 200;
    TwoRouters sut(options, limits);
    const auto steps = *rc::gen::scale(10.0, rc::gen::container<std::vector<KeylessStep>>(
                                                 rc::gen::container<KeylessStep>(rc::gen::arbitrary<std::uint8_t>())));
    for (const KeylessStep& step : steps) sut.step(step);
}

}  // namespace
}  // namespace mavloom::route
