// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "unit/message/sample_messages.hpp"

namespace mavloom::message {
namespace {

using namespace mavloom::testing;  // NOLINT: the sample definitions
using ::testing::Test;

// The fields of a message as the text form prints them, without the head of the line and its end.
std::string fields_of(const Message& message, const std::vector<std::uint8_t>& payload) {
    const SampleFrame frame(message, payload);
    const auto line = text_of(frame.received());
    const auto start = line.find("  ") + 2;
    return line.substr(start, line.size() - start - 1);
}

std::string sample_with(const std::vector<std::uint8_t>& payload, std::string_view field) {
    const auto text = "  " + fields_of(sample, payload) + "  ";
    const auto start = text.find("  " + std::string(field) + "=") + 2;
    return text.substr(start, text.find("  ", start) - start);
}

TEST(Text, PrintsTimeLinkSourceNameAndFieldsWithUnits) {
    const SampleFrame frame(attitude, bytes_of(std::uint32_t{5}, 0.01f, -0.02f, 1.5f, 0.0f, nan_f, -inf_f));

    EXPECT_EQ(text_of(frame.received()),
              "22:13:20.123456 px4 1/191 ATTITUDE  time_boot_ms=5 ms  roll=0.01 rad  pitch=-0.02 rad  yaw=1.5 rad  "
              "rollspeed=0.0 rad/s  pitchspeed=nan rad/s  yawspeed=-inf rad/s\n");
}

TEST(Text, PrintsUnknownIdsAsHex) {
    const std::vector<std::uint8_t> bytes{0xfd, 3, 0, 0, 9, 1, 2, 0x70, 0x11, 0x01, 0x0a, 0x00, 0xff, 0, 0};
    const Received received{wall_from_us(7), "udp", wire::FrameView::unchecked(bytes), nullptr};

    EXPECT_EQ(text_of(received), "00:00:00.000007 udp 1/2 #70000  payload=0x0a00ff\n");
}

TEST(Text, NamesEnumsAndFlags) {
    const auto with_mode = [](std::uint8_t type, std::uint8_t mode) {
        return fields_of(heartbeat,
                         bytes_of(std::uint32_t{0}, type, std::uint8_t{12}, mode, std::uint8_t{4}, std::uint8_t{3}));
    };
    EXPECT_EQ(with_mode(2, 3),
              "type=MAV_TYPE_QUADROTOR  autopilot=12  base_mode=CUSTOM_MODE|TEST  custom_mode=0  system_status=4  "
              "mavlink_version=3");
    EXPECT_TRUE(with_mode(77, 0).starts_with("type=77  autopilot=12  base_mode=0x0  "));
    EXPECT_NE(with_mode(2, 0x13).find("base_mode=CUSTOM_MODE|TEST|0x10 "), std::string::npos);
    EXPECT_NE(with_mode(2, 0x81).find("base_mode=CUSTOM_MODE|SAFETY_ARMED "), std::string::npos);
    EXPECT_NE(with_mode(2, 0xc0).find("base_mode=MANUAL_AND_ARMED "), std::string::npos);
    EXPECT_NE(with_mode(2, 0xc1).find("base_mode=CUSTOM_MODE|SAFETY_ARMED|MANUAL_AND_ARMED "), std::string::npos);
    EXPECT_NE(with_mode(2, 0x40).find("base_mode=0x40 "), std::string::npos);
}

TEST(Text, ScalesWhatPeopleCannotRead) {
    std::vector<std::uint8_t> payload(61);
    store_le(payload.data() + 24, std::int32_t{-473977418});
    store_le(payload.data() + 28, std::int16_t{2150});
    store_le(payload.data() + 30, std::int16_t{-5});
    store_le(payload.data() + 32, std::int16_t{0x7fff});
    store_le(payload.data() + 34, std::uint16_t{255});
    store_le(payload.data() + 36, std::uint16_t{87});

    EXPECT_EQ(sample_with(payload, "lat"), "lat=-47.3977418 deg");
    EXPECT_EQ(sample_with(payload, "i16s"), "i16s=[21.5,-0.05,-] degC");
    EXPECT_EQ(sample_with(payload, "azimuth"), "azimuth=360.0 deg");
    EXPECT_EQ(sample_with(payload, "eph"), "eph=0.87");
}

TEST(Text, ShowsADashForNoValue) {
    std::vector<std::uint8_t> payload(61);
    store_le(payload.data() + 24, std::int32_t{0x7fffffff});
    for (const std::size_t at : {28u, 30u, 32u}) store_le(payload.data() + at, std::int16_t{0x7fff});
    store_le(payload.data() + 36, std::uint16_t{0xffff});
    store_le(payload.data() + 53, nan_f);
    store_le(payload.data() + 57, 1.0f);

    EXPECT_EQ(sample_with(payload, "lat"), "lat=-");
    EXPECT_EQ(sample_with(payload, "i16s"), "i16s=-");
    EXPECT_EQ(sample_with(payload, "eph"), "eph=-");
    EXPECT_EQ(sample_with(payload, "covariance"), "covariance=-");
    store_le(payload.data() + 53, 2.0f);
    EXPECT_EQ(sample_with(payload, "covariance"), "covariance=[2.0,1.0]");
}

TEST(Text, PrintsLongByteArraysAsHex) {
    std::vector<std::uint8_t> payload(61);
    payload[40] = 1;
    payload[43] = 0xab;
    payload[45] = 0x01;

    EXPECT_EQ(sample_with(payload, "small"), "small=[1,0,0]");
    EXPECT_EQ(sample_with(payload, "blob"), "blob=0xab0001(+7 zeros)");
    payload[52] = 0xff;
    EXPECT_EQ(sample_with(payload, "blob"), "blob=0xab0001000000000000ff");
}

TEST(Text, EscapesWhatATerminalWouldObey) {
    const auto hostile = statustext_payload(6,
                                            "a\"b\\\x1b]0;x\x07\n\xc2\x9b"
                                            "1m\xe2\x80\xae\xff");

    EXPECT_EQ(fields_of(statustext, hostile),
              "severity=MAV_SEVERITY_INFO  text=\"a\\\"b\\\\\\x1b]0;x\\x07\\n\\x9b1m\\u202e\xef\xbf\xbd\"  id=0  "
              "chunk_seq=0");
}

TEST(Text, EscapesTheLinksName) {
    const SampleFrame frame(heartbeat, {});
    EXPECT_NE(text_of(frame.received("a\x1b[2J")).find(" a\\x1b[2J 1/191 "), std::string::npos);
}

std::vector<std::uint8_t> command_int_payload(std::uint16_t command, std::uint8_t frame, std::int32_t x, std::int32_t y) {
    return bytes_of(1.5f, 3.0f, 0.0f, nan_f, x, y, 10.0f, command, std::uint8_t{1}, std::uint8_t{1}, frame,
                    std::uint8_t{0}, std::uint8_t{1});
}

TEST(Text, LabelsTheParametersOfACommand) {
    EXPECT_EQ(fields_of(command_int, command_int_payload(16, 3, 473977418, 85455940)),
              "target_system=1  target_component=1  frame=3  command=MAV_CMD_NAV_WAYPOINT  current=0  autocontinue=1  "
              "param1(Hold)=1.5 s  param2=3.0  param3=0.0  param4(Yaw)=-  x(Latitude)=47.3977418 deg  "
              "y(Longitude)=8.545594 deg  z(Altitude)=10.0 m");
    EXPECT_NE(fields_of(command_int, command_int_payload(207, 3, 0, 0)).find("param2(Action)=FENCE_ACTION_HOLD  "),
              std::string::npos);
}

TEST(Text, LeavesPositionsOfALocalFrameRaw) {
    const auto text = fields_of(command_int, command_int_payload(16, 1, 15000, 0x7fffffff));
    EXPECT_NE(text.find("x(Latitude)=15000  y(Longitude)=2147483647  "), std::string::npos);
}

TEST(Text, LeavesParametersOfAnUnknownCommandUnlabelled) {
    const auto text = fields_of(command_int, command_int_payload(9999, 3, 1, 2));
    EXPECT_NE(text.find("command=9999  "), std::string::npos);
    EXPECT_NE(text.find("param1=1.5  param2=3.0  param3=0.0  param4=nan  x=1  y=2  z=10.0"), std::string::npos);
}

}  // namespace
}  // namespace mavloom::message
