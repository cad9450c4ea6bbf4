// SPDX-License-Identifier: MIT
// The engine against the naive model over random lives of a network: links come and go, time passes, frames of few
// sources, targets and sequence numbers, so that copies, echoes, roaming and reboots happen.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <array>

#include "property/route/model.hpp"
#include "support/seed.hpp"

namespace mavloom::route {
namespace {

using namespace std::chrono_literals;
using test::Bytes;
using test::Id;
using test::Model;
using test::ModelPolicy;
using test::pick;
using test::Terms;

using Step = std::array<std::uint8_t, 7>;

const Nanoseconds pauses[] = {0s, 1ms, 40ms, 250ms, 900ms, 2s, 3s, 7s, 10s, 31s};
const Nanoseconds pauses_of_group[] = {1ms, 499ms, 500ms, 1s, 1999ms, 2s, 2999ms, 3s};
const std::uint8_t systems[] = {1, 1, 2, 255, 0}, components[] = {1, 1, 154, 190};

ModelPolicy policy_of(const Step& s) {
    ModelPolicy policy;
    const Terms by_message{.messages = {"0", "30", "703710"}}, by_system{.systems = {1, 2}},
        by_component{.components = {154}};
    const Terms none{};
    const Terms* const terms[] = {&none, &none, &none, &by_message, &by_system, &by_component};
    policy.in_allow = *pick(terms, s[1]);
    policy.in_block = *pick(terms, s[2]);
    policy.out_allow = *pick(terms, s[3]);
    policy.out_block = *pick(terms, s[4]);
    policy.group = s[5] % 4 == 3 ? 0 : s[5] % 4;
    policy.mode = static_cast<GroupMode>(s[6] % 3);
    policy.order = s[6] / 3 % 3;
    policy.endpoint = s[6] / 9 % 4 == 2 ? 1 + s[4] % 2 : 0;
    policy.tap = s[5] / 4 % 8 == 1;
    policy.is_private = s[5] / 4 % 8 == 2;
    policy.rank = std::array{Rank::stranger, Rank::own, Rank::verified, Rank::stranger}[s[5] / 32 % 4];
    policy.learns_first = s[5] / 32 % 4 == 3;
    if (s[6] / 9 % 4 == 1) policy.attitude_interval = 500ms;
    if (s[6] / 36 % 4 == 1) policy.other_interval = 1s;
    if (s[4] / 6 % 4 == 1) policy.bytes_per_s = s[4] / 24;
    return policy;
}

LinkPolicy compiled(const ModelPolicy& policy) {
    LinkPolicy link{.in = test::make_filter(policy.in_allow, policy.in_block),
                    .out = test::make_filter(policy.out_allow, policy.out_block),
                    .group = GroupId{policy.group},
                    .group_mode = policy.mode,
                    .group_order = policy.order,
                    .endpoint = policy.endpoint,
                    .tap = policy.tap,
                    .is_private = policy.is_private,
                    .rank = policy.rank,
                    .learns_first = policy.learns_first,
                    .max_bytes_per_s = policy.bytes_per_s};
    std::vector<dialect::RateTerm> rates;
    const auto add = [&](const char* message, std::optional<Nanoseconds> interval) {
        if (interval) rates.push_back({message, 1e9 / static_cast<double>(interval->count())});
    };
    add("ATTITUDE", policy.attitude_interval);
    add("*", policy.other_interval);
    link.max_rate = test::make_rates(rates);
    return link;
}

Bytes frame_of(const Step& s) {
    const Id source{pick(systems, s[2]), pick(components, s[3])};
    const std::uint8_t sequence = s[6] % 4;
    const test::Fields target{{"target_system", pick(systems, s[4])},
                              {"target_component", s[5] % 2 ? pick(components, s[5]) : 0u}};
    const auto version = s[6] / 4 % 8 == 0 ? wire::Version::v1 : wire::Version::v2;
    switch (s[0] % 8) {
        case 0: return test::make_frame("HEARTBEAT", source, {}, sequence, version);
        case 1:
            return test::make_frame("ATTITUDE", source, {{"yawspeed", s[4] % 2 ? 0x3f800000u : 0}}, sequence, version);
        case 2: return test::make_frame("SYSTEM_TIME", source, {{"time_boot_ms", s[4] * 100u}}, sequence, version);
        case 3: return test::make_frame("MANUAL_CONTROL", source, {{"target", pick(systems, s[4])}}, sequence, version);
        case 4: return test::make_frame("SET_MODE", source, {target[0]}, sequence, version);
        case 5: return test::make_unknown(source, sequence);
        default: return test::make_frame("COMMAND_LONG", source, target, sequence, version);
    }
}

// A network whose answers are compared with the model's after every step.
class Life {
public:
    // The first `still` links are private and hear nothing: they only take places.
    explicit Life(const Options& options, std::uint32_t still = 0)
        : routing_(dialect::default_dialect().wire_table(), options),
          explaining_(dialect::default_dialect().wire_table(), options),
          model_(options),
          still_(still) {
        while (last_ < still) add_link({.is_private = true});
    }

    void step(const Step& s) {
        const std::uint32_t link = still_ + 1 + s[1] % (last_ - still_ + 1);
        switch (s[0] % 32) {
            case 20:
            case 21:
            case 22:
            case 23: return frames_.empty() ? void() : again(link, s);
            case 24: return add(s);
            case 25: return s[2] % 2 == 0 ? remove(link) : beat(link, s[2] / 2);
            case 26: return reboot(link, {pick(systems, s[2]), pick(components, s[3])});
            case 27:
            case 28:
            case 29:
            case 30:
            case 31: now_ += pick(pauses, s[1]); return;
            default: frames_.push_back(frame_of(s)); return pass(link, frames_.back());
        }
    }
    // Links 1 and 2 are a group, of which 3 sends something through one.
    void step_of_group(const Step& s) {
        const std::uint32_t link = 1 + s[1] % 2;
        switch (s[0] % 5) {
            case 0: beat(link, s[2] % 8); break;
            case 1:
                for (int n = s[2] % 100; n > 0; --n) {
                    heartbeat(1);
                    pass(2, frames_.back());
                }
                break;
            case 2: heartbeat(link); break;
            case 3:
                if (!frames_.empty()) pass(link, frames_.back());
                break;
            default: now_ += pick(pauses_of_group, s[2]);
        }
        pass(3, test::make_frame("ATTITUDE", {255, 190}, {{"time_boot_ms", ++beats_}}));
    }
    void add(const Step& s) {
        if (last_ < still_ + 12) add_link(policy_of(s));
    }

private:
    void add_link(const ModelPolicy& policy) {
        const LinkId id{++last_};
        RC_ASSERT(routing_.add_link(id, compiled(policy)));
        RC_ASSERT(explaining_.add_link(id, compiled(policy)));
        model_.add(last_, policy);
    }

    void again(std::uint32_t link, const Step& s) {
        const Bytes frame = frames_[frames_.size() - 1 - s[2] % std::min<std::size_t>(frames_.size(), 3)];
        pass(link, frame, s[3] % 2 == 0);
    }
    void remove(std::uint32_t link) {
        routing_.remove_link(LinkId{link});
        explaining_.remove_link(LinkId{link});
        model_.remove(link);
    }
    void reboot(std::uint32_t link, Id source) {
        if (!model_.reboot(link, source.system, source.component, now_)) return;
        for (Engine* engine : {&routing_, &explaining_}) engine->note_reboot(LinkId{link}, source, now_);
        check_routes();
    }
    // HEARTBEATs that no other link hears.
    void beat(std::uint32_t link, std::uint32_t count) {
        while (count-- > 0) heartbeat(link);
    }
    void heartbeat(std::uint32_t link) {
        frames_.push_back(test::make_frame("HEARTBEAT", {1, 1}, {{"custom_mode", ++beats_}}));
        pass(link, frames_.back());
    }
    void pass(std::uint32_t link, const Bytes& bytes, bool is_repeated = false) {
        const auto frame = wire::FrameView::unchecked(bytes);
        const auto* const info = dialect::default_dialect().wire_table().find(frame.id());
        const auto expected = model_.route(link, bytes, now_, is_repeated);
        std::vector<Explanation> why;
        const auto explained = explaining_.explain(frame, info, LinkId{link}, now_, why, is_repeated);
        const auto decision = routing_.route(frame, routing_.mark_of(frame), info, LinkId{link}, now_, is_repeated);

        RC_ASSERT(verdict_name(decision.verdict) == verdict_name(expected.verdict));
        RC_ASSERT(verdict_name(explained.verdict) == verdict_name(expected.verdict));
        RC_ASSERT(test::ids_of(decision.links) == expected.links());
        RC_ASSERT(test::ids_of(explained.links) == expected.links());
        std::map<std::uint32_t, std::string_view> reasons, expected_reasons;
        for (const auto& e : why) reasons[e.link.value] = reason_text(e.reason);
        for (const auto& [id, reason] : expected.why) expected_reasons[id] = reason_text(reason);
        RC_ASSERT(reasons == expected_reasons);
        check_routes();
    }
    void check_routes() const {
        std::set<std::tuple<std::uint32_t, int, int, std::uint64_t>> routes;
        for (const auto& r : routing_.routes(now_))
            routes.emplace(r.link.value, r.source.system.value, r.source.component.value, r.frames);
        RC_ASSERT(routes == model_.routes(now_));
    }

    Engine routing_, explaining_;
    Model model_;
    std::vector<Bytes> frames_;
    MonoTime now_{std::chrono::hours{1}};
    std::uint32_t last_ = 0, beats_ = 0;
    std::uint32_t still_;
};

Options options_of(std::uint8_t bits) {
    Options options{.recent_frames = 8192};
    if (bits & 1) options.dedup = bits & 2 ? Nanoseconds{250ms} : Nanoseconds{5s};
    if (bits & 4) options.unknown_component = UnknownComponent::drop;
    if (bits & 8) options.unknown_target = UnknownTarget::flood;
    if (bits & 16) options.own = Source{SystemId{1}, ComponentId{190}};
    return options;
}

// Ten times as many steps as RapidCheck's size would give: what is interesting needs a past.
std::vector<Step> life() {
    return *rc::gen::scale(
        10.0, rc::gen::container<std::vector<Step>>(rc::gen::container<Step>(rc::gen::arbitrary<std::uint8_t>())));
}

RC_GTEST_PROP(Engine, DecidesAsTheModelDoes, (std::uint8_t bits)) {
    Life sut(options_of(bits));
    for (int i = 0; i < 3; ++i) sut.add(*rc::gen::container<Step>(rc::gen::arbitrary<std::uint8_t>()));
    for (const Step& step : life()) sut.step(step);
}

RC_GTEST_PROP(Engine, DecidesAsTheModelDoesWithPlainLinks, (std::uint8_t bits)) {
    Life sut(options_of(bits));
    // Two strangers, two own links, a verified one.
    for (const auto rank : std::initializer_list<std::uint8_t>{3, 3, 35, 35, 67}) sut.add({0, 0, 0, 0, 0, rank, 0});
    for (const Step& step : life()) sut.step(step);
}

RC_GTEST_PROP(Engine, TakesTheBestLinkAsTheModelDoes, ()) {
    Life sut(options_of(0));
    for (const Step& policy : {Step{0, 0, 0, 0, 0, 1, 1}, Step{0, 0, 0, 0, 0, 1, 1}, Step{0, 0, 0, 0, 0, 3, 0}})
        sut.add(policy);
    for (const Step& step :
         *rc::gen::container<std::vector<Step>>(60, rc::gen::container<Step>(rc::gen::arbitrary<std::uint8_t>())))
        sut.step_of_group(step);
}

RC_GTEST_PROP(Engine, DecidesAsTheModelDoesBeyondSixtyFourLinks, (std::uint8_t bits)) {
    Life sut(options_of(bits), 59);
    for (int i = 0; i < 8; ++i) sut.add({0, 0, 0, 0, 0, static_cast<std::uint8_t>(i % 3 * 32 + 3), 0});
    for (const Step& step :
         *rc::gen::container<std::vector<Step>>(40, rc::gen::container<Step>(rc::gen::arbitrary<std::uint8_t>())))
        sut.step(step);
}

}  // namespace
}  // namespace mavloom::route
