// SPDX-License-Identifier: MIT
// The clock, the schedule and the fleet: which vehicle gets which frame, and when each is advanced.
#include "simserve/fleet.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "mavloom/msg/command_ack.hpp"
#include "mavloom/msg/command_long.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "simserve/flight_clock.hpp"
#include "simserve/schedule.hpp"
#include "unit/sim/rig.hpp"

namespace mavloom::simserve {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::UnorderedElementsAre;

TEST(FlightClock, RunsAtItsSpeed) {
    FlightClock sut(10);
    const MonoTime start{5s};
    EXPECT_EQ(sut.at(start).flight, 0ns);

    sut.start(start);

    EXPECT_EQ(sut.at(start + 3s).flight, 30s);
    EXPECT_EQ(sut.at(start + 3s).real, start + 3s);
}

TEST(FlightClock, StandsStillAndRunsAgain) {
    FlightClock sut(10);
    const MonoTime start{5s};
    sut.start(start);

    sut.pause(start + 1s);
    EXPECT_EQ(sut.at(start + 7s).flight, 10s);
    EXPECT_EQ(sut.when(11s), MonoTime::max());
    sut.set(12s);
    sut.resume(start + 9s);

    EXPECT_EQ(sut.at(start + 10s).flight, 22s);
    EXPECT_EQ(sut.when(32s), start + 11s + 1ns);
    sut.resume(start + 20s);
    EXPECT_EQ(sut.at(start + 20s).flight, 122s) << "it ran already";
}

TEST(FlightClock, ThatIsFreeShowsWhatItIsSetTo) {
    FlightClock sut(max_speed);
    const MonoTime start{5s};
    sut.start(start);

    sut.set(1h);

    EXPECT_EQ(sut.at(start + 1s).flight, 1h);
    EXPECT_EQ(sut.at(start + 1s).real, MonoTime{1h}) << "time-outs and signatures, too";
    EXPECT_LE(sut.when(2h), start);
}

// A loop that slept until `when` must find the vehicle due, or it would spin.
TEST(FlightClock, HasReachedAnInstantWhenItReportsIt) {
    for (const double speed : {0.1, 0.3, 1.0, 7.0, 33.3, 100.0}) {
        FlightClock sut(speed);
        sut.start(MonoTime{1s});
        for (std::int64_t ns = 1; ns < 1'000'000'000'000'000; ns = ns * 3 + 7) {
            const sim::FlightTime flight{ns};
            const MonoTime when = sut.when(flight);
            EXPECT_GE(sut.at(when).flight, flight) << speed << " " << ns;
            EXPECT_LE(sut.at(when).flight - flight,
                      Nanoseconds{static_cast<std::int64_t>(2 * speed) + 2 + ns / 1'000'000'000'000});
        }
    }
}

TEST(FlightClock, NeverReachesTheEndOfTime) {
    FlightClock sut(100);
    sut.start(MonoTime{1s});
    EXPECT_EQ(sut.when(sim::FlightTime::max()), MonoTime::max());
}

TEST(Schedule, IsAsGoodAsALinearSearch) {
    std::mt19937_64 random(1);
    Schedule sut;
    std::vector<sim::FlightTime> model;
    EXPECT_TRUE(sut.empty());
    EXPECT_EQ(sut.due(), sim::FlightTime::max());
    for (int i = 0; i < 100; ++i) {
        model.emplace_back(random() % 50);
        sut.add(model.back());
    }
    for (int i = 0; i < 10'000; ++i) {
        const auto vehicle = static_cast<Schedule::Index>(random() % model.size());
        model[vehicle] = sim::FlightTime{random() % 50};
        sut.update(vehicle, model[vehicle]);
        const auto first = std::ranges::min_element(model);  // of those due at the same time, the one added first
        ASSERT_EQ(sut.due(), *first);
        ASSERT_EQ(sut.first(), static_cast<Schedule::Index>(first - model.begin()));
    }
}

// Three vehicles with the ids 1, 2 and 9, on link 1.
class FleetTest : public testing::Test {
protected:
    FleetTest() {
        for (const unsigned system : {1u, 2u, 9u}) {
            sim::VehicleOptions options;
            options.system = SystemId{static_cast<std::uint8_t>(system)};
            EXPECT_TRUE(sut.add(options, now()));
        }
        sut.open(link, {}, now());
    }

    [[nodiscard]] sim::Moment now() const { return {.flight = flight, .real = MonoTime{flight}}; }

    void run(Nanoseconds time) {
        for (const auto end = flight + time; sut.next_due() <= end;) {
            flight = std::max(flight, sut.next_due());
            sink.now = flight;
            sut.advance(now());
        }
    }

    void send_command(std::uint8_t target, std::uint16_t command = 31'999, float param1 = 0) {  // nobody has 31999
        msg::CommandLong message{};
        message.command = command;
        message.param1 = param1;
        message.target_system = target;
        send(message);
    }
    template <class Message>
    void send(const Message& message) {
        std::array<std::uint8_t, Message::max_length> payload;
        (void)message.encode(payload);
        const auto& info = *dialect::default_dialect().wire_table().find(Message::id);
        wire::FrameBuffer buffer;
        const auto frame = wire::write_frame(buffer, {.sequence = 0, .source = {SystemId{255}, ComponentId{190}}}, info,
                                             payload);
        sut.receive(link, frame, &info, now());
    }

    // The systems that sent this message, in order.
    [[nodiscard]] std::vector<int> senders(MessageId id) const {
        std::vector<int> systems;
        for (const auto& sent : sink.frames)
            if (sent.frame().id() == id) systems.push_back(sent.frame().system().value);
        return systems;
    }

    static constexpr LinkId link{1};
    sim::test::ListSink sink;
    sim::FlightTime flight{};
    Fleet sut{sink};
};

TEST_F(FleetTest, EachVehicleBeatsOnceASecond) {
    run(10s);

    const auto beats = senders(msg::Heartbeat::id);
    for (const int system : {1, 2, 9})
        EXPECT_THAT(std::ranges::count(beats, system), testing::AllOf(testing::Ge(10), testing::Le(12)));
}

TEST_F(FleetTest, ACommandReachesItsTargetOnly) {
    send_command(9);
    EXPECT_THAT(senders(msg::CommandAck::id), ElementsAre(9));
}

TEST_F(FleetTest, ACommandToAllReachesAll) {
    send_command(0);
    EXPECT_THAT(senders(msg::CommandAck::id), UnorderedElementsAre(1, 2, 9));
}

TEST_F(FleetTest, ACommandToAnotherSystemReachesNobody) {
    send_command(3);
    send_command(255);
    EXPECT_THAT(senders(msg::CommandAck::id), ElementsAre());
}

TEST_F(FleetTest, AFrameWithoutDefinitionIsIgnored) {
    wire::FrameBuffer buffer;
    const auto& info = *dialect::default_dialect().wire_table().find(msg::Heartbeat::id);
    std::array<std::uint8_t, msg::Heartbeat::max_length> payload{};
    sut.receive(link, wire::write_frame(buffer, {}, info, payload), nullptr, now());
    EXPECT_TRUE(senders(msg::CommandAck::id).empty());
}

TEST_F(FleetTest, TwoVehiclesCannotShareAnId) {
    sim::VehicleOptions options;
    options.system = SystemId{2};

    const auto added = sut.add(options, now());

    ASSERT_FALSE(added);
    EXPECT_EQ(added.error().code, SetupCode::usage);
    EXPECT_EQ(sut.size(), 3u);
}

TEST_F(FleetTest, AVehicleWithANewIdIsFoundUnderItAfterAReboot) {
    ASSERT_TRUE(sut.find(SystemId{2})->set_parameter("MAV_SYS_ID", 42));
    send_command(2, 246, 1);  // PREFLIGHT_REBOOT_SHUTDOWN
    run(5s);

    ASSERT_EQ(sut.find(SystemId{2}), nullptr);
    ASSERT_NE(sut.find(SystemId{42}), nullptr);
    sink.frames.clear();
    send_command(42);
    EXPECT_THAT(senders(msg::CommandAck::id), ElementsAre(42));
    sut.reschedule(*sut.find(SystemId{42}), now());
    run(3s);
    EXPECT_THAT(senders(msg::Heartbeat::id), testing::Contains(42));
}

TEST_F(FleetTest, AVehicleKeepsItsIdIfTheNewOneIsTaken) {
    ASSERT_TRUE(sut.find(SystemId{2})->set_parameter("MAV_SYS_ID", 9));
    send_command(2, 246, 1);
    run(5s);
    sink.frames.clear();
    run(10s);

    EXPECT_EQ(sut.find(SystemId{2})->parameter("MAV_SYS_ID"), 2);
    EXPECT_THAT(std::ranges::count(senders(msg::Heartbeat::id), 2), testing::Ge(9));
    EXPECT_THAT(std::ranges::count(senders(msg::Heartbeat::id), 9), testing::Le(11));
}

TEST_F(FleetTest, AClosedLinkGetsNothingMore) {
    run(1s);
    sut.close(link);
    sink.frames.clear();

    run(3s);

    EXPECT_TRUE(sink.frames.empty());
}

TEST_F(FleetTest, AllVehiclesTogetherKeepTheLimitOfALink) {
    sut.open(LinkId{2}, {.profile = sim::Profile::px4_normal, .max_bytes_s = 3000}, now());
    run(20s);
    std::size_t bytes = 0;
    for (const auto& sent : sink.frames)
        if (sent.link == LinkId{2}) bytes += sent.bytes.size();

    EXPECT_LT(bytes / 20, 3300u);
    EXPECT_GT(bytes / 20, 1500u);  // trailing zeros of payloads do not leave, but count
}

}  // namespace
}  // namespace mavloom::simserve
