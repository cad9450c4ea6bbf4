// SPDX-License-Identifier: MIT
// Rates, phases, stalls and limits of the telemetry streams, on a clock that the test moves.
#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "mavloom/msg/attitude.hpp"
#include "mavloom/msg/attitude_target.hpp"
#include "mavloom/msg/command_long.hpp"
#include "mavloom/msg/enums/mav_cmd.hpp"
#include "mavloom/msg/enums/mav_type.hpp"
#include "mavloom/msg/global_position_int.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/link_node_status.hpp"
#include "mavloom/msg/ping.hpp"
#include "mavloom/msg/radio_status.hpp"
#include "mavloom/msg/timesync.hpp"
#include "unit/sim/rig.hpp"

namespace mavloom::sim {
namespace {

using test::Peer;
using test::Rig;
using test::Sent;

constexpr Profile all_profiles[] = {Profile::lite,        Profile::normal,    Profile::px4_normal,
                                    Profile::px4_onboard, Profile::ardupilot, Profile::original};

std::vector<FlightTime> times_of(const Rig& rig, MessageId message, LinkId link = LinkId{1}) {
    std::vector<FlightTime> times;
    for (const Sent& sent : rig.sink.frames)
        if (sent.link == link && sent.frame().id() == message) times.push_back(sent.at);
    return times;
}

std::size_t count_of(const Rig& rig, MessageId message, LinkId link = LinkId{1}) {
    return times_of(rig, message, link).size();
}

StreamReport report_of(const Rig& rig, MessageId message, LinkId link = LinkId{1}) {
    for (const StreamReport& report : rig.vehicle.stream_reports(link))
        if (report.message == message) return report;
    return {};
}

// A late call: nothing happened for `time`, then the owner wakes up.
void stall(Rig& rig, Nanoseconds time) {
    rig.flight += time;
    rig.sink.now = rig.flight;
    rig.vehicle.advance(rig.now());
}

void set_interval(Rig& rig, MessageId message, float microseconds, LinkId link = LinkId{1}) {
    rig.send(msg::CommandLong{.target_system = 1,
                              .target_component = 1,
                              .command = msg::MAV_CMD_SET_MESSAGE_INTERVAL,
                              .param1 = static_cast<float>(message.value),
                              .param2 = microseconds},
             Peer{.link = link});
}

TEST(Streams, HeartbeatBeginsAtOnceAndKeepsItsRate) {
    Rig rig;

    rig.run(60.0);

    const auto times = times_of(rig, msg::Heartbeat::id);
    ASSERT_GE(times.size(), 61u);
    EXPECT_EQ(rig.sink.frames.front().frame().id(), msg::Heartbeat::id);
    EXPECT_EQ(times.front(), FlightTime{0});
}

class EveryProfile : public testing::TestWithParam<Profile> {};
INSTANTIATE_TEST_SUITE_P(Streams, EveryProfile, testing::ValuesIn(all_profiles));

// One rounding error of an interval may be as large as half a nanosecond; over the minute they add up.
TEST_P(EveryProfile, StreamsKeepTheirGridToTheMicrosecond) {
    for (const Autopilot autopilot : {Autopilot::px4, Autopilot::ardupilot}) {
        Rig rig({.autopilot = autopilot, .ready_after = Nanoseconds{0}}, {.profile = GetParam()});
        rig.run(3.0);  // what changes at the start is announced between the instants of the grid
        rig.forget();
        rig.run(60.0);

        for (const StreamReport& report : rig.vehicle.stream_reports(LinkId{1})) {
            SCOPED_TRACE(report.name);
            const auto times = times_of(rig, report.message);
            if (report.sent < 3) continue;
            const double interval = 1e9 / report.asked_hz;
            EXPECT_NEAR(static_cast<double>(times.size()), 60 * report.asked_hz, 1);
            for (std::size_t n = 0; n < times.size(); ++n)
                ASSERT_NEAR(static_cast<double>((times[n] - times[0]).count()), static_cast<double>(n) * interval, 1e3);
            EXPECT_NEAR(report.achieved_hz, report.asked_hz, report.asked_hz * 1e-6);
            EXPECT_EQ(report.skipped, 0u);
        }
    }
}

TEST(Streams, WakeUpsThatComeTooLateCauseNoDrift) {
    Rig rig({}, {.profile = Profile::px4_onboard});

    for (int i = 0; i < 8'600; ++i) stall(rig, std::chrono::microseconds{7'000});

    for (const StreamReport& report : rig.vehicle.stream_reports(LinkId{1})) {
        if (report.sent < 3) continue;
        EXPECT_NEAR(report.achieved_hz, report.asked_hz, report.asked_hz * 1e-3) << report.name;
        EXPECT_EQ(report.skipped, 0u) << report.name;
    }
    EXPECT_EQ(count_of(rig, msg::Attitude::id), 6020u) << "100 Hz for 60.2 s";
}

TEST(Streams, AStallIsSkippedAndCountedAndCausesNoBurst) {
    Rig rig({}, {.profile = Profile::px4_normal});
    rig.run(5.0);
    const auto before = times_of(rig, msg::Attitude::id);
    rig.forget();

    stall(rig, std::chrono::milliseconds{497});

    std::map<std::uint32_t, int> counts;
    for (const Sent& sent : rig.sink.frames) ++counts[sent.frame().id().value];
    for (const auto& [id, count] : counts) EXPECT_LE(count, 1) << "message " << id;
    EXPECT_EQ(report_of(rig, msg::Attitude::id).skipped, 24u) << "of the 25 instants in 0.5 s one is caught up";

    rig.forget();
    rig.run(1.0);
    const auto after = times_of(rig, msg::Attitude::id);
    ASSERT_FALSE(after.empty());
    EXPECT_EQ((after[0] - before[0]) % std::chrono::milliseconds{20}, Nanoseconds{0}) << "the grid stays";
    EXPECT_NEAR(report_of(rig, msg::Attitude::id).achieved_hz, 50, 0.25) << "skipped time does not count";
}

TEST(Streams, LatenessIsMeasuredFromTheDeadline) {
    Rig rig({}, {.profile = Profile::px4_normal});
    rig.run(1.0);
    for (int i = 0; i < 50; ++i) stall(rig, std::chrono::milliseconds{3});

    const Lateness lateness = report_of(rig, msg::Attitude::id).lateness;
    EXPECT_GT(lateness.at(0.99), std::chrono::microseconds{500});
    EXPECT_LE(lateness.at(1), std::chrono::microseconds{5'120});
}

TEST(Streams, MessagesOfOneVehicleDoNotBurst) {
    Rig rig({}, {.profile = Profile::px4_normal});
    rig.run(10.0);
    rig.forget();
    rig.run(10.0);

    std::map<std::int64_t, int> slots;
    for (const Sent& sent : rig.sink.frames) ++slots[sent.at / std::chrono::milliseconds{1}];
    int most = 0;
    for (const auto& [slot, count] : slots) most = std::max(most, count);
    EXPECT_LE(most, 5) << "PX4 sends up to 23 messages within a millisecond";
}

TEST(Streams, HeartbeatsOfAFleetSpreadOverTheSecond) {
    std::map<std::int64_t, int> slots;
    for (unsigned system = 1; system <= 200; ++system) {
        Rig rig({.system = SystemId{static_cast<std::uint8_t>(system)}}, {.profile = Profile::lite});
        ASSERT_EQ(count_of(rig, msg::Heartbeat::id) + (system == 1), 1u) << "the first one comes at once";
        rig.run(0.001);
        ASSERT_EQ(count_of(rig, msg::Heartbeat::id), 1u) << system;
        rig.run(5.0);
        const auto times = times_of(rig, msg::Heartbeat::id);
        ++slots[times.back() % std::chrono::seconds{1} / std::chrono::milliseconds{20}];
        EXPECT_NEAR(report_of(rig, msg::Heartbeat::id).achieved_hz, 1, 1e-9);
    }
    for (const auto& [slot, count] : slots) EXPECT_LE(count, 6) << slot;
    EXPECT_GE(slots.size(), 48u) << "of 50 slots";
}

TEST(Streams, TheSequenceNumberCountsEveryFrameOfALink) {
    Rig rig({}, {.profile = Profile::px4_normal});
    rig.vehicle.open(LinkId{2}, {.profile = Profile::lite}, rig.now());
    rig.run(10.0);

    std::map<std::uint32_t, std::uint8_t> next;
    for (const Sent& sent : rig.sink.frames) {
        ASSERT_EQ(sent.frame().sequence(), next[sent.link.value]);
        ++next[sent.link.value];
    }
}

TEST(Streams, EachLinkHasItsOwnRates) {
    Rig rig({}, {.profile = Profile::px4_normal});
    rig.vehicle.open(LinkId{2}, {.profile = Profile::px4_normal}, rig.now());
    rig.run(5.0);
    set_interval(rig, msg::Attitude::id, 100'000, LinkId{2});
    rig.run(0.1);
    rig.forget();
    rig.run(10.0);

    EXPECT_NEAR(static_cast<double>(count_of(rig, msg::Attitude::id)), 500, 1);
    EXPECT_NEAR(static_cast<double>(count_of(rig, msg::Attitude::id, LinkId{2})), 100, 1);
}

TEST(Streams, AClosedLinkIsForgotten) {
    Rig rig({}, {.profile = Profile::px4_normal});
    rig.run(1.0);
    rig.vehicle.close(LinkId{1});
    rig.forget();
    rig.run(1.0);

    EXPECT_TRUE(rig.sink.frames.empty());
    EXPECT_TRUE(rig.vehicle.stream_reports(LinkId{1}).empty());
}

// Sizes of MAVLink 2 frames: 12 bytes around the full payload.
double bytes_s(const Rig& rig, double seconds) {
    double bytes = 0;
    for (const StreamReport& report : rig.vehicle.stream_reports(LinkId{1})) {
        const auto* const info = dialect::default_dialect().wire_table().find(report.message);
        bytes += (info->max_length + 12) * static_cast<double>(count_of(rig, report.message));
    }
    return bytes / seconds;
}

TEST(Streams, ASlowLinkSlowsAllButTheHeartbeatByOneFactor) {
    Rig rig({}, {.profile = Profile::px4_normal, .max_bytes_s = 4'000});
    rig.run(10.0);
    rig.forget();
    rig.run(100.0);

    EXPECT_NEAR(static_cast<double>(count_of(rig, msg::Heartbeat::id)), 100, 1);
    const double factor = static_cast<double>(count_of(rig, msg::Attitude::id)) / (100 * 50);
    EXPECT_GT(factor, 0.1);
    EXPECT_LT(factor, 0.5);
    EXPECT_NEAR(static_cast<double>(count_of(rig, msg::LinkNodeStatus::id)), 100 * factor, 1);
    EXPECT_NEAR(bytes_s(rig, 100), 4'000, 200);
}

TEST(Streams, NoStreamSlowsToLessThanATwentieth) {
    Rig rig({}, {.profile = Profile::px4_normal, .max_bytes_s = 10});
    rig.run(40.0);

    EXPECT_NEAR(static_cast<double>(count_of(rig, msg::Attitude::id)), 100, 2);
    EXPECT_NEAR(static_cast<double>(count_of(rig, msg::Heartbeat::id)), 41, 1);
}

TEST(Streams, ARadioWithAFullBufferSlowsItsLinkAndAnEmptyOneFreesIt) {
    Rig rig({}, {.profile = Profile::px4_normal, .max_bytes_s = 25'000});
    rig.vehicle.open(LinkId{2}, {.profile = Profile::px4_normal, .max_bytes_s = 25'000}, rig.now());
    const auto hear = [&](std::uint8_t free_percent, int times) {
        for (int i = 0; i < times; ++i) {
            rig.send(msg::RadioStatus{.txbuf = free_percent}, Peer{.id = {SystemId{51}, ComponentId{68}}});
            rig.run(0.1);
        }
        rig.forget();
        rig.run(10.0);
        return static_cast<double>(count_of(rig, msg::Attitude::id)) / 10;
    };

    const double slow = hear(10, 6);  // 0.8^6 = 0.26
    EXPECT_LT(slow, 20);
    EXPECT_NEAR(static_cast<double>(count_of(rig, msg::Attitude::id, LinkId{2})) / 10, 50, 0.2) << "the other link";
    EXPECT_NEAR(hear(40, 20), slow, 0.2) << "between 35 and 50 % nothing changes";
    EXPECT_NEAR(hear(90, 100), 50, 0.2);
}

TEST(Streams, AnIntervalChangesTheRateAndTheDefaultComesBack) {
    Rig rig({}, {.profile = Profile::px4_normal});
    const auto rate_over = [&](double seconds) {
        rig.forget();
        rig.run(seconds);
        return static_cast<double>(count_of(rig, msg::GlobalPositionInt::id)) / seconds;
    };
    rig.run(5.0);
    set_interval(rig, msg::GlobalPositionInt::id, 50'000);
    EXPECT_NEAR(rate_over(10), 20, 0.2);
    set_interval(rig, msg::GlobalPositionInt::id, -1);
    EXPECT_EQ(rate_over(10), 0);
    set_interval(rig, msg::GlobalPositionInt::id, 0);
    EXPECT_NEAR(rate_over(10), 50, 0.2);
    set_interval(rig, msg::GlobalPositionInt::id, 1);
    EXPECT_NEAR(rate_over(10), 250, 0.2) << "no faster than the vehicle steps";
}

TEST(Streams, AStreamThatAClientAsksForStartsSoonAndManyDoNotStartTogether) {
    Rig rig({.ready_after = Nanoseconds{0}}, {.profile = Profile::lite});
    rig.run(5.0);
    rig.forget();
    const FlightTime asked = rig.flight;
    for (const std::uint32_t id : {24, 30, 31, 32, 33, 74, 83, 105, 141, 245, 331})
        set_interval(rig, MessageId{id}, 4e5);
    rig.run(0.02);

    std::set<std::int64_t> instants;
    for (const std::uint32_t id : {24u, 30u, 31u, 32u, 33u, 74u, 83u, 105u, 141u, 245u, 331u}) {
        const auto times = times_of(rig, MessageId{id});
        ASSERT_GE(times.size(), 1u) << id;
        EXPECT_LE(times.back() - asked, std::chrono::milliseconds{20});
        instants.insert((times.back() - asked).count());
    }
    EXPECT_EQ(instants.size(), 11u);
}

// MAVProxy and MAVSDK repeat their requests for the same rates.
TEST(Streams, ARepeatedRequestForTheSameRateDisturbsNothing) {
    Rig rig({}, {.profile = Profile::px4_normal});
    rig.run(5.0);
    const auto phase = times_of(rig, msg::Attitude::id).front() % std::chrono::milliseconds{20};
    rig.forget();
    for (int i = 0; i < 100; ++i) {
        set_interval(rig, msg::Attitude::id, 20'000);
        rig.run(0.033);
    }

    for (const FlightTime time : times_of(rig, msg::Attitude::id))
        ASSERT_EQ(time % std::chrono::milliseconds{20}, phase);
    EXPECT_NEAR(static_cast<double>(count_of(rig, msg::Attitude::id)), 165, 1);
}

// ATTITUDE_TARGET of the default profile needs an armed vehicle. Time without it must not lower the reported rate.
TEST(Streams, OnlyARadioSlowsALinkAndOnlyItsOwn) {
    const LinkOptions limited{.profile = Profile::px4_normal, .max_bytes_s = 4000};
    Rig rig({.ready_after = Nanoseconds{0}}, limited);
    rig.vehicle.open(LinkId{2}, limited, rig.now());
    const auto rate = [&](LinkId link) {
        rig.forget();
        rig.run(10.0);
        return static_cast<double>(count_of(rig, msg::Attitude::id, link)) / 10;
    };
    const double before = rate(LinkId{2});
    for (int i = 0; i < 50; ++i) rig.send(msg::RadioStatus{.txbuf = 0}, Peer{.link = LinkId{2}});
    EXPECT_NEAR(rate(LinkId{2}), before, 0.2) << "from a client that is no radio";
    const Source radio{SystemId{51}, ComponentId{68}};
    for (int i = 0; i < 50; ++i) rig.send(msg::RadioStatus{.txbuf = 0}, Peer{.link = LinkId{1}, .id = radio});
    rig.send(msg::RadioStatus{.txbuf = 45}, Peer{.link = LinkId{2}, .id = radio});
    EXPECT_LT(rate(LinkId{1}), before / 2);
    EXPECT_NEAR(rate(LinkId{2}), before, 0.2);
}

TEST(Streams, ARequestBetweenTwoInstantsDoesNotChangeWhatIsDueBefore) {
    // Woken late, the vehicle hears a client first; what was due before still shows its own instant.
    const auto stamps = [](bool is_asked) {
        Rig rig({.ready_after = Nanoseconds{0}}, {.profile = Profile::px4_normal});
        rig.forget();
        for (int i = 0; i < 200; ++i) {
            rig.flight += std::chrono::milliseconds{15};
            if (is_asked) rig.send(msg::Timesync{.tc1 = 0, .ts1 = 1});
            rig.vehicle.advance(rig.now());
        }
        std::vector<std::uint32_t> all;
        for (const auto& message : rig.all<msg::Attitude>()) all.push_back(message.time_boot_ms);
        return all;
    };
    EXPECT_EQ(stamps(true), stamps(false));
}

TEST(Streams, AConditionalStreamReportsTheRateOfTheTimeInWhichItRan) {
    Rig rig({.ready_after = Nanoseconds{0}});
    rig.run(5.0);
    EXPECT_EQ(count_of(rig, msg::AttitudeTarget::id), 0u);
    for (int i = 0; i < 3; ++i) {
        ASSERT_TRUE(rig.vehicle.arm(true));
        rig.run(3.0);
        ASSERT_TRUE(rig.vehicle.disarm(true));
        rig.run(3.0);
    }

    const StreamReport report = report_of(rig, msg::AttitudeTarget::id);
    EXPECT_NEAR(static_cast<double>(report.sent), 3 * 3 * 20, 3);
    EXPECT_NEAR(report.achieved_hz, 20, 0.01);
    EXPECT_EQ(report.skipped, 0u);
}

TEST(Streams, TheOriginIsSentOnceOnEveryLink) {
    Rig rig({}, {.profile = Profile::px4_normal});
    rig.run(20.0);
    rig.vehicle.open(LinkId{2}, {.profile = Profile::px4_onboard}, rig.now());
    rig.run(20.0);

    EXPECT_EQ(count_of(rig, MessageId{49}), 1u);
    EXPECT_EQ(count_of(rig, MessageId{49}, LinkId{2}), 1u);
}

// A real vehicle forgets intervals with its memory.
TEST(Streams, ARebootRestoresTheProfile) {
    Rig rig({}, {.profile = Profile::px4_normal});
    rig.run(5.0);
    set_interval(rig, msg::Attitude::id, 1'000'000);
    rig.send(msg::CommandLong{.target_system = 1, .command = msg::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, .param1 = 1});
    rig.forget();
    rig.run(2.0);
    EXPECT_TRUE(rig.sink.frames.empty());
    rig.run(5.0);
    rig.forget();
    rig.run(10.0);

    EXPECT_NEAR(static_cast<double>(count_of(rig, msg::Attitude::id)), 500, 1);
    EXPECT_EQ(report_of(rig, msg::Attitude::id).skipped, 0u);
}

TEST(Streams, PingsOfALinkAreNumbered) {
    Rig rig({}, {.profile = Profile::px4_onboard});
    rig.run(3.5);

    const auto pings = rig.all<msg::Ping>();
    ASSERT_GE(pings.size(), 3u);
    for (std::size_t i = 0; i < pings.size(); ++i) EXPECT_EQ(pings[i].seq, i);
    EXPECT_EQ(pings[0].target_system, 0);
}

TEST(Streams, LinkNodeStatusCountsTheTrafficOfItsLink) {
    Rig rig({.ready_after = Nanoseconds{0}}, {.profile = Profile::px4_normal});
    rig.vehicle.open(LinkId{2}, {.profile = Profile::lite}, rig.now());
    for (int i = 0; i < 10; ++i) {
        rig.send(msg::Heartbeat{.type = msg::MAV_TYPE_GCS, .mavlink_version = 3});
        rig.run(1.0);
    }

    std::size_t frames = 0, bytes = 0;
    FlightTime last{};
    for (const Sent& sent : rig.sink.frames) {
        if (sent.link != LinkId{1}) continue;
        if (sent.frame().id() == msg::LinkNodeStatus::id) {
            const auto status = msg::LinkNodeStatus::decode(sent.frame().payload());
            EXPECT_EQ(status.messages_sent, frames);
            if (last != FlightTime{}) {
                EXPECT_NEAR(status.tx_rate, static_cast<double>(bytes), 1500);
            }
            bytes = 0;
            last = sent.at;
        }
        ++frames;
        bytes += sent.bytes.size();
    }
    const auto status = rig.last<msg::LinkNodeStatus>();
    ASSERT_TRUE(status);
    EXPECT_EQ(status->messages_received, 10u);
    EXPECT_NEAR(status->rx_rate, 12 + 9, 1);
}

}  // namespace
}  // namespace mavloom::sim
