// SPDX-License-Identifier: MIT
// Calibration, signing and the shell. Sources: MAVLink guide, "Message Signing"; texts of calibrations as ground
// stations and MAVSDK parse them.
#include <gmock/gmock.h>

#include <cstring>
#include <string>

#include "mavloom/msg/command_ack.hpp"
#include "mavloom/msg/command_int.hpp"
#include "mavloom/msg/command_long.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/param_value.hpp"
#include "mavloom/msg/serial_control.hpp"
#include "mavloom/msg/setup_signing.hpp"
#include "mavloom/msg/statustext.hpp"
#include "mavloom/msg/timesync.hpp"
#include "mavloom/wire/signing.hpp"
#include "unit/sim/rig.hpp"

namespace mavloom::sim {
namespace {

using namespace std::chrono_literals;
using test::Peer;
using test::Rig;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;

constexpr std::uint16_t calibration_command = 241, arm_command = 400, position_command = 42429;
constexpr VehicleOptions ready_px4{.ready_after = 0ms};
constexpr VehicleOptions ready_ardupilot{.autopilot = Autopilot::ardupilot, .ready_after = 0ms};

std::vector<std::string> texts(const Rig& rig) {
    std::vector<std::string> found;
    for (const auto& message : rig.all<msg::Statustext>())
        found.emplace_back(message.text.data(), strnlen(message.text.data(), message.text.size()));
    return found;
}

int send_command(Rig& rig, std::uint16_t id, std::array<float, 7> p, const Peer& peer = {}) {
    rig.send(msg::CommandLong{.target_system = 1,
                              .target_component = 1,
                              .command = id,
                              .param1 = p[0],
                              .param2 = p[1],
                              .param3 = p[2],
                              .param4 = p[3],
                              .param5 = p[4],
                              .param6 = p[5],
                              .param7 = p[6]},
             peer);
    const auto answer = rig.last<msg::CommandAck>(peer.link);
    return answer && answer->command == id ? answer->result : -1;
}
int calibrate(Rig& rig, std::array<float, 7> p) { return send_command(rig, calibration_command, p); }

TEST(Calibration, GyroscopeReportsProgressUntilItIsDone) {
    Rig rig(ready_px4);
    rig.run(1.0);
    rig.forget();

    EXPECT_EQ(calibrate(rig, {1, 0, 0, 0, 0, 0, 0}), 0);
    rig.run(10.0);

    const auto said = texts(rig);
    ASSERT_EQ(said.size(), 13u);
    EXPECT_EQ(said.front(), "[cal] calibration started: 2 gyro");
    EXPECT_EQ(said[1], "[cal] progress <0>");
    EXPECT_EQ(said[11], "[cal] progress <100>");
    EXPECT_EQ(said.back(), "[cal] calibration done: gyro");
    for (const auto& message : rig.all<msg::Statustext>()) EXPECT_EQ(message.severity, 6);
    const auto values = rig.all<msg::ParamValue>();
    EXPECT_TRUE(std::ranges::any_of(
        values, [](const msg::ParamValue& value) { return std::string_view(value.param_id.data()) == "CAL_GYRO0_ID"; }));
}

TEST(Calibration, AccelerometerGoesThroughSixSides) {
    Rig rig(ready_px4);

    EXPECT_EQ(calibrate(rig, {0, 0, 0, 0, 1, 0, 0}), 0);
    rig.run(10.0);

    const auto said = texts(rig);
    EXPECT_THAT(said, Contains("[cal] calibration started: 2 accel"));
    for (const std::string side : {"down", "up", "left", "right", "front", "back"}) {
        EXPECT_THAT(said, Contains("[cal] " + side + " orientation detected"));
        EXPECT_THAT(said, Contains("[cal] " + side + " side done, rotate to a different side"));
    }
    EXPECT_EQ(said.back(), "[cal] calibration done: accel");
}

TEST(Calibration, HeartbeatShowsItAndArmingIsRefused) {
    Rig rig(ready_px4);
    rig.run(1.0);
    (void)calibrate(rig, {0, 1, 0, 0, 0, 0, 0});
    rig.forget();
    rig.run(1.0);

    EXPECT_EQ(rig.last<msg::Heartbeat>()->system_status, 2);
    EXPECT_EQ(send_command(rig, arm_command, {1, 0, 0, 0, 0, 0, 0}), 1);
    EXPECT_EQ(calibrate(rig, {1, 0, 0, 0, 0, 0, 0}), 1) << "one runs already";
    rig.run(10.0);
    EXPECT_NE(rig.last<msg::Heartbeat>()->system_status, 2);
}

TEST(Calibration, AllZeroCancels) {
    Rig rig(ready_px4);
    EXPECT_EQ(calibrate(rig, {0, 0, 0, 0, 0, 0, 0}), 0) << "nothing runs";
    EXPECT_THAT(texts(rig), IsEmpty());
    (void)calibrate(rig, {1, 0, 0, 0, 0, 0, 0});
    rig.run(1.0);

    const float nan = std::nanf("");
    EXPECT_EQ(calibrate(rig, {0, nan, nan, nan, nan, nan, 0}), 0);
    rig.run(10.0);

    EXPECT_EQ(texts(rig).back(), "[cal] calibration cancelled");
}

TEST(Calibration, RefusesWhatItDoesNotKnowAndWhatFlies) {
    Rig rig(ready_px4);
    rig.run(1.0);
    EXPECT_EQ(calibrate(rig, {7, 0, 0, 0, 0, 0, 0}), 2);
    EXPECT_EQ(calibrate(rig, {0, 0, 0, 0, 9, 0, 0}), 2);
    (void)send_command(rig, arm_command, {1, 21196, 0, 0, 0, 0, 0});
    EXPECT_EQ(calibrate(rig, {1, 0, 0, 0, 0, 0, 0}), 1);
}

TEST(Calibration, ArduPilotAsksForSixPositions) {
    Rig rig(ready_ardupilot);
    EXPECT_EQ(calibrate(rig, {1, 0, 0, 0, 0, 0, 0}), 0) << "gyroscopes are done at once";
    EXPECT_EQ(calibrate(rig, {0, 0, 0, 0, 1, 0, 0}), 0);

    for (int position = 1; position <= 6; ++position) {
        ASSERT_TRUE(rig.last<msg::CommandLong>());
        EXPECT_EQ(rig.last<msg::CommandLong>()->command, position_command);
        EXPECT_EQ(rig.last<msg::CommandLong>()->param1, static_cast<float>(position));
        EXPECT_EQ(rig.last<msg::CommandLong>()->target_component, 190);
        EXPECT_EQ(send_command(rig, position_command, {static_cast<float>(position), 0, 0, 0, 0, 0, 0}), 0);
    }

    EXPECT_EQ(rig.last<msg::CommandLong>()->param1, 16777215.f) << "success";
    EXPECT_EQ(send_command(rig, position_command, {1, 0, 0, 0, 0, 0, 0}), 2) << "nothing is asked";
}

TEST(Calibration, ArduPilotGivesUpWhenNobodyTurnsTheVehicle) {
    Rig rig(ready_ardupilot);
    (void)calibrate(rig, {0, 0, 0, 0, 1, 0, 0});
    rig.run(61.0);

    EXPECT_EQ(rig.last<msg::CommandLong>()->param1, 16777216.f) << "failed";
    EXPECT_EQ(calibrate(rig, {0, 0, 0, 0, 1, 0, 0}), 0);
}

// --- Signing

// A client that signs its frames.
struct SigningClient {
    explicit SigningClient(Rig& r) : rig(r) {}
    Rig& rig;
    wire::SigningKey key{std::array<std::uint8_t, 32>{1, 2, 3, 4}};
    wire::Signer signer{key, 7, wire::SigningTime{1000}};
    std::uint8_t sequence = 0;

    template <class Message>
    std::vector<std::uint8_t> frame_of(const Message& message, bool is_signed = true) {
        std::array<std::uint8_t, Message::max_length> payload;
        (void)message.encode(payload);
        const auto& info = *dialect::default_dialect().wire_table().find(Message::id);
        wire::Signing signing;
        if (is_signed) signing = {&signer, wire::SigningTime{}};
        wire::FrameBuffer buffer;
        const auto frame = wire::write_frame(buffer, {.sequence = sequence++, .source = Peer{}.id}, info, payload,
                                             signing);
        return {frame.bytes().begin(), frame.bytes().end()};
    }
    void send(const std::vector<std::uint8_t>& bytes) {
        const auto frame = wire::FrameView::unchecked(bytes);
        rig.vehicle.receive(LinkId{1}, frame, dialect::default_dialect().wire_table().find(frame.id()), rig.now());
    }
    void set_key(const std::array<std::uint8_t, 32>& bytes, bool is_signed) {
        send(frame_of(
            msg::SetupSigning{.target_system = 1, .target_component = 1, .secret_key = bytes, .initial_timestamp = 900},
            is_signed));
    }
    // True if the vehicle answers.
    bool is_heard(const std::vector<std::uint8_t>& bytes) {
        rig.forget();
        send(bytes);
        return !rig.all<msg::Timesync>().empty();
    }
};
constexpr msg::Timesync question{.tc1 = 0, .ts1 = 5};

TEST(Signing, AllFramesAreSignedOnceTheVehicleHasAKey) {
    Rig rig;
    SigningClient client(rig);
    client.set_key(client.key.bytes(), false);
    rig.forget();
    rig.run(3.0);

    wire::Verifier verifier(client.key);
    ASSERT_FALSE(rig.sink.frames.empty());
    for (const auto& sent : rig.sink.frames)
        EXPECT_EQ(verifier.verify(sent.frame(), {}), wire::Verifier::Verdict::good);
}

TEST(Signing, UnsignedAndRepeatedFramesAreDropped) {
    Rig rig;
    SigningClient client(rig);
    client.set_key(client.key.bytes(), false);
    const auto frame = client.frame_of(question);

    EXPECT_FALSE(client.is_heard(client.frame_of(question, false)));
    EXPECT_TRUE(client.is_heard(frame));
    EXPECT_FALSE(client.is_heard(frame)) << "a replay";
    auto forged = client.frame_of(question);
    forged.back() ^= 1;
    EXPECT_FALSE(client.is_heard(forged));
    EXPECT_TRUE(client.is_heard(client.frame_of(question)));
}

// A vehicle that heard no ground station would think it lost the connection.
TEST(Signing, UnsignedHeartbeatsAreHeard) {
    Rig rig(VehicleOptions{.ready_after = 0ms});
    SigningClient client(rig);
    client.set_key(client.key.bytes(), false);
    rig.forget();

    client.send(client.frame_of(msg::Heartbeat{.type = 6, .autopilot = 8}, false));

    EXPECT_THAT(texts(rig), Contains("Message signing is on")) << "the announcer greets the ground station";
}

TEST(Signing, OnlyAClientThatHasTheKeyMayTurnItOff) {
    Rig rig;
    SigningClient client(rig);
    client.set_key({}, false);
    EXPECT_TRUE(client.is_heard(client.frame_of(question, false))) << "no key yet";
    client.set_key(client.key.bytes(), false);

    client.set_key({}, false);
    EXPECT_FALSE(client.is_heard(client.frame_of(question, false)));
    client.set_key({}, true);
    EXPECT_TRUE(client.is_heard(client.frame_of(question, false)));
    rig.forget();
    rig.run(1.0);
    EXPECT_FALSE(rig.sink.frames.front().frame().is_signed());
}

// Ground stations send the message twice. The second one must not make old signatures valid again.
TEST(Signing, TheSameKeyAgainChangesNothing) {
    Rig rig;
    SigningClient client(rig);
    client.set_key(client.key.bytes(), false);
    const auto frame = client.frame_of(question);
    EXPECT_TRUE(client.is_heard(frame));

    client.set_key(client.key.bytes(), true);

    EXPECT_FALSE(client.is_heard(frame));
}

TEST(Signing, ItsTimeIsRealTimeWhateverTheSpeed) {
    Rig rig;
    SigningClient client(rig);
    client.set_key(client.key.bytes(), false);
    // A client that connects after 6 s, on a vehicle whose clock has run for 10 minutes.
    const Moment later{.flight = std::chrono::minutes{10}, .real = MonoTime{std::chrono::seconds{6}}};
    rig.vehicle.advance(later);
    rig.forget();
    const auto bytes = client.frame_of(question);
    const auto frame = wire::FrameView::unchecked(bytes);
    rig.vehicle.receive(LinkId{1}, frame, dialect::default_dialect().wire_table().find(frame.id()), later);

    EXPECT_FALSE(rig.all<msg::Timesync>().empty());
}

TEST(Signing, RefusesAKeyWhileArmed) {
    Rig rig(ready_px4);
    rig.run(1.0);
    EXPECT_EQ(send_command(rig, arm_command, {1, 21196, 0, 0, 0, 0, 0}), 0);
    SigningClient client(rig);
    client.set_key(client.key.bytes(), false);

    EXPECT_TRUE(client.is_heard(client.frame_of(question, false)));
    rig.run(1.0);
    EXPECT_FALSE(rig.sink.frames.front().frame().is_signed());
}

// --- Shell

std::string typed(Rig& rig, std::string_view line, std::uint8_t device = 10, std::uint8_t flags = 2) {
    rig.forget();
    msg::SerialControl message{.device = device, .flags = flags, .count = static_cast<std::uint8_t>(line.size())};
    std::ranges::copy(line.substr(0, message.data.size()), message.data.begin());
    rig.send(message);
    std::string answer;
    for (const auto& reply : rig.all<msg::SerialControl>()) {
        EXPECT_EQ(reply.flags & 1, 1);
        EXPECT_LE(reply.count, 70);
        answer.append(reinterpret_cast<const char*>(reply.data.data()), reply.count);
    }
    return answer;
}

TEST(Shell, AnswersLinesWithAPrompt) {
    Rig rig;
    EXPECT_EQ(typed(rig, "\n"), "\nnsh> ");
    EXPECT_EQ(typed(rig, "frobnicate 3\n"), "frobnicate 3\nnsh: frobnicate: command not found\nnsh> ");
    const std::string version = typed(rig, "ver all\n");
    EXPECT_THAT(version, testing::HasSubstr("1.17.0"));
    EXPECT_TRUE(version.ends_with("nsh> "));
}

TEST(Shell, PutsPiecesOfALineTogether) {
    Rig rig;
    EXPECT_EQ(typed(rig, "he"), "he");
    EXPECT_THAT(typed(rig, "lp\n"), testing::HasSubstr("help usage"));
}

TEST(Shell, IgnoresOtherDevicesAndReplies) {
    Rig rig;
    EXPECT_EQ(typed(rig, "help\n", 0), "");
    EXPECT_EQ(typed(rig, "help\n", 10, 1), "");
    EXPECT_EQ(typed(rig, std::string(200, 'x')), std::string(70, 'x')) << "the count is a lie";
    Rig other(ready_ardupilot);
    EXPECT_EQ(typed(other, "help\n"), "");
}

}  // namespace
}  // namespace mavloom::sim
