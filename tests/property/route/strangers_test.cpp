// SPDX-License-Identifier: MIT
// Strangers: whatever they send, a frame between two verified links, or between two own links, reaches the far side as
// without them. The rules: docs/design/routing-rules.md, "Trust".
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

using StrangerStep = std::array<std::uint8_t, 6>;

constexpr LinkId vehicle_link{1}, station_link{2};
constexpr Id vehicle{1, 1}, camera{1, 100}, station{255, 190};
constexpr Id ids[] = {vehicle, camera, station, {1, 0}, {1, 77}, {2, 1}, {255, 77}, {0, 0}};
const Nanoseconds rests[] = {0s, 1ms, 40ms, 600ms, 1s, 2s, 6s, 11s};

Bytes frame_of(const StrangerStep& s, Id source, std::uint32_t more = 0) {
    const Id target = pick(ids, s[3]);
    const test::Fields fields{
        {"target_system", target.system}, {"target_component", target.component}, {"param1", more}};
    switch (s[4] % 4) {
        case 0: return test::make_frame("HEARTBEAT", source, {{"custom_mode", more}}, s[5] % 4);
        case 1: return test::make_frame("SYSTEM_TIME", source, {{"time_boot_ms", s[5] * 100u + more}}, s[5] % 4);
        case 2: return test::make_frame("ATTITUDE", source, {{"time_boot_ms", more}}, s[5] % 4);
        default: return test::make_frame("COMMAND_LONG", source, fields, s[5] % 4);
    }
}

// One router with honest traffic alone, and one with strangers beside it. Nobody can predict the bytes of an honest
// frame if `is_predictable` is false: then each has bytes of its own.
class TwoRouters {
public:
    TwoRouters(const Options& options, const LinkPolicy& honest, bool is_predictable)
        : quiet_(dialect::default_dialect().wire_table(), options),
          attacked_(dialect::default_dialect().wire_table(), options),
          is_predictable_(is_predictable) {
        for (Engine* engine : {&quiet_, &attacked_})
            for (const LinkId link : {vehicle_link, station_link}) engine->add_link(link, honest);
        honest_frame(vehicle_link, test::make_frame("HEARTBEAT", vehicle, {{"custom_mode", unique()}}));
    }

    void step(const StrangerStep& s) {
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

    void honest(const StrangerStep& s) {
        const bool from_vehicle = s[1] % 2 == 0;
        const Bytes bytes = frame_of(s, from_vehicle ? (s[1] % 8 == 0 ? camera : vehicle) : station, unique());
        sent_.push_back(bytes);
        honest_frame(from_vehicle ? vehicle_link : station_link, bytes);
    }
    void honest_frame(LinkId from, const Bytes& bytes) {
        const auto frame = wire::FrameView::unchecked(bytes);
        const auto expected = honest_of(quiet_.route(frame, from, now_));
        RC_ASSERT(honest_of(attacked_.route(frame, from, now_)) == expected);
    }
    void attack(std::uint8_t n, const Bytes& bytes) {
        attacked_.add_link(adversary(n), {.rank = Rank::stranger, .learns_first = n % 2 == 0});
        (void)attacked_.route(wire::FrameView::unchecked(bytes), adversary(n), now_);
    }
    // Bytes that an honest link sent, or will send next.
    void replay(const StrangerStep& s) {
        if (s[2] % 2 == 0 && !sent_.empty()) return attack(s[1], sent_[sent_.size() - 1 - s[3] % sent_.size()]);
        StrangerStep next = s;
        attack(s[1], frame_of(next, s[3] % 2 == 0 ? vehicle : station));
    }
    void come_and_go(std::uint8_t n) { attacked_.remove_link(adversary(n)); }

    static std::vector<std::uint32_t> honest_of(const Decision& decision) {
        std::vector<std::uint32_t> links;
        for (const LinkId link : decision.links)
            if (link <= station_link) links.push_back(link.value);
        return links;
    }

    [[nodiscard]] std::uint32_t unique() noexcept { return is_predictable_ ? 0 : ++count_; }

    Engine quiet_, attacked_;
    bool is_predictable_;
    std::uint32_t count_ = 0;
    std::vector<Bytes> sent_;
    MonoTime now_{std::chrono::hours{1}};
};

void play(std::uint8_t bits, Rank rank, bool is_predictable) {
    Options options{.route_timeout = 1h, .recent_frames = 8192};
    if (bits & 1) options.dedup = 250ms;
    if (bits & 2) options.unknown_component = UnknownComponent::drop;
    if (bits & 4) options.unknown_target = UnknownTarget::flood;
    LinkPolicy honest{.rank = rank};
    if (bits & 8) honest.max_rate = test::make_rates({{"COMMAND_LONG", 2}, {"HEARTBEAT", 2}, {"*", 1}});
    if (bits & 16) honest.max_bytes_per_s = 200;
    TwoRouters sut(options, honest, is_predictable);
    const auto steps = *rc::gen::scale(10.0, rc::gen::container<std::vector<StrangerStep>>(
                                                 rc::gen::container<StrangerStep>(rc::gen::arbitrary<std::uint8_t>())));
    for (const StrangerStep& step : steps) sut.step(step);
}

RC_GTEST_PROP(Strangers, ChangeNoTrafficOfVerifiedLinks, (std::uint8_t bits)) { play(bits, Rank::verified, true); }

RC_GTEST_PROP(Strangers, ChangeNoTrafficOfOwnLinks, (std::uint8_t bits)) { play(bits, Rank::own, false); }

}  // namespace
}  // namespace mavloom::route
