// SPDX-License-Identifier: MIT
// Bytes are those of the writer of mcap-ros2-support 0.6.0 for the same values and our schema; names follow the ROS 2
// interface definition. tests/system/test_cdr_readers.py has other libraries read every message.
#include "mavloom/message/cdr.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "message/cdr/names.hpp"
#include "support/bytes.hpp"
#include "unit/message/sample_messages.hpp"

namespace mavloom::message {
namespace {

using namespace mavloom::testing;  // NOLINT: the sample definitions
using test::Bytes;
using test::hex;

// ---- definitions of a user's own; members that they leave out are left out on purpose

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"

constexpr Field unsorted_fields[] = {
    {.name = "a", .type = FieldType::u16, .offset = 0},
    {.name = "b", .type = FieldType::u8, .offset = 2},
    {.name = "c", .type = FieldType::u64, .offset = 3, .extension = true},
    {.name = "d", .type = FieldType::u8, .offset = 11, .extension = true},
    {.name = "e", .type = FieldType::char8, .array_length = 4, .offset = 12, .extension = true},
    {.name = "f", .type = FieldType::f64, .offset = 16, .extension = true},
    {.name = "g", .type = FieldType::u8, .offset = 24, .extension = true},
    {.name = "h", .type = FieldType::u16, .array_length = 2, .offset = 25, .extension = true}};
constexpr Message unsorted{
    .name = "UNSORTED", .wire = {MessageId{70001}, 0, 3, 29}, .fields = unsorted_fields, .origin = "here"};

constexpr EnumEntry frame_entries[] = {{.name = "FRAME_a", .value = 1}, {.name = "FRAME_B", .value = 128}};
constexpr Enum frame_enum{.name = "FRAME", .entries = frame_entries};
constexpr Field move_fields[] = {
    {.name = "from", .type = FieldType::u8, .offset = 0, .enumeration = &frame_enum},
    {.name = "To", .type = FieldType::i8, .offset = 1, .enumeration = &frame_enum},
    {.name = "to", .type = FieldType::u8, .offset = 2},
    {.name = "share", .type = FieldType::f32, .offset = 3, .extension = true, .enumeration = &frame_enum}};
constexpr Message move_message{
    .name = "MOVE", .wire = {MessageId{70002}, 0, 3, 7}, .fields = move_fields, .origin = "here"};

#pragma GCC diagnostic pop

Bytes cdr_of(const Message& definition, ByteView payload) {
    const CdrEncoder encoder(definition);
    Bytes out(encoder.max_size(), 0xaa);
    out.resize(encoder.encode(payload, out));
    return out;
}

// ---- bytes

TEST(CdrEncoder, CopiesAPayloadThatNeedsNoPadding) {
    const auto payload = bytes_of(std::uint32_t{123456}, 0.1f, -0.2f, 3.0f, 0.0f, 0.0f, 0.0f);
    EXPECT_EQ(cdr_of(attitude, payload), hex("0001000040e20100cdcccc3dcdcc4cbe00004040000000000000000000000000"));
}

TEST(CdrEncoder, ExtendsATruncatedPayloadWithZeros) {
    const auto payload = bytes_of(std::uint32_t{123456}, 0.1f, -0.2f, 3.0f);
    EXPECT_EQ(cdr_of(attitude, payload), hex("0001000040e20100cdcccc3dcdcc4cbe00004040000000000000000000000000"));
}

TEST(CdrEncoder, DropsBytesBeyondTheDefinition) {
    const Bytes exact(28, 1), longer(255, 1);
    EXPECT_EQ(cdr_of(attitude, longer), cdr_of(attitude, exact));
}

TEST(CdrEncoder, WritesTextUpToItsFirstNulAndAlignsWhatFollows) {
    auto payload = statustext_payload(6, std::string_view("abcd\0ef", 7));
    payload.insert(payload.end(), {0x02, 0x01, 0x03});
    EXPECT_EQ(cdr_of(statustext, payload), hex("000100000600000005000000616263640000020103"));
}

TEST(CdrEncoder, WritesEmptyTextAndAbsentExtensionsOfMavlink1) {
    EXPECT_EQ(cdr_of(statustext, statustext_payload(6, "")), hex("0001000006000000010000000000000000"));
}

TEST(CdrEncoder, ReplacesBytesThatAreNotUtf8) {
    EXPECT_EQ(cdr_of(statustext, statustext_payload(6,
                                                    "A\xff\xfe"
                                                    "B")),
              hex("00010000060000000900000041efbfbdefbfbd420000000000"));
}

TEST(CdrEncoder, KeepsCharactersBeyondAscii) {
    const auto payload = statustext_payload(6,
                                            "Height \xc2\xb5m over \xe2\x82\xac"
                                            "12, 10 \xff m");
    EXPECT_EQ(cdr_of(statustext, payload),
              hex("00010000060000002000000048656967687420c2b56d206f76657220e282ac31322c20313020efbfbd206d00000000"));
}

TEST(CdrEncoder, PadsFieldsThatAreNotSortedBySize) {
    Bytes payload = bytes_of(std::uint16_t{0x0102}, std::uint8_t{3}, std::uint64_t{0x0807060504030201}, std::uint8_t{9});
    payload.insert(payload.end(), {'x', 0, 0, 0});
    const auto rest = bytes_of(1.5, std::uint8_t{7}, std::uint16_t{1}, std::uint16_t{2});
    payload.insert(payload.end(), rest.begin(), rest.end());
    EXPECT_EQ(
        cdr_of(unsorted, payload),
        hex("000100000201030000000000010203040506070809000000020000007800000000000000000000000000f83f070001000200"));
}

// ---- schemas

TEST(Ros2msg, HasFieldsInTheOrderOfThePayloadWithConstantsBeforeTheirField) {
    EXPECT_EQ(ros2_type(heartbeat), "mavlink/msg/Heartbeat");
    EXPECT_EQ(ros2msg(heartbeat),
              "# MAVLink HEARTBEAT (0)\n"
              "uint32 custom_mode\n"
              "uint8 MAV_TYPE_GENERIC=0\n"
              "uint8 MAV_TYPE_FIXED_WING=1\n"
              "uint8 MAV_TYPE_QUADROTOR=2\n"
              "uint8 type\n"
              "uint8 autopilot\n"
              "uint8 CUSTOM_MODE=1\n"
              "uint8 TEST=2\n"
              "uint8 MANUAL_AND_ARMED=192\n"
              "uint8 SAFETY_ARMED=128\n"
              "uint8 base_mode\n"
              "uint8 system_status\n"
              "uint8 mavlink_version\n");
}

TEST(Ros2msg, HasTypesAndUnits) {
    EXPECT_EQ(ros2msg(sample),
              "# MAVLink SAMPLE (70000)\n"
              "uint64 u64\n"
              "int64 i64\n"
              "float64 f64\n"
              "int32 lat  # [degE7] invalid: INT32_MAX\n"
              "int16[3] i16s  # [cdegC] invalid: (INT16_MAX)\n"
              "uint16 azimuth  # [deg]\n"
              "uint16 eph  # invalid: UINT16_MAX\n"
              "int8 i8\n"
              "uint8 c\n"
              "uint8[3] small\n"
              "uint8[10] blob\n"
              "float32[2] covariance  # invalid: (NaN:)\n");
    EXPECT_THAT(ros2msg(statustext), ::testing::HasSubstr("\nstring text\nuint16 id\n"));
}

TEST(Ros2msg, GivesASecondFieldOfAnEnumConstantsOfItsOwnAndLeavesOutWhatDoesNotFit) {
    EXPECT_EQ(ros2msg(move_message),
              "# MAVLink MOVE (70002)\n"
              "uint8 FRAME_A=1\n"
              "uint8 FRAME_B=128\n"
              "uint8 from\n"
              "int8 TO_FRAME_A=1\n"
              "int8 to\n"
              "uint8 to2\n"
              "float32 share\n");
}

// The patterns of the ROS 2 interface definition: no two underscores in a row, none at the end, a letter first.
TEST(Ros2Names, AreThoseThatRosAccepts) {
    EXPECT_EQ(ros2_message_name("ESC_TELEMETRY_1_TO_4"), "EscTelemetry1To4");
    EXPECT_EQ(ros2_message_name("__odd__Name_"), "OddName");
    EXPECT_EQ(ros2_message_name("3D_POSE"), "M3dPose");
    EXPECT_EQ(ros2_field_name("OAT_temp"), "oat_temp");
    EXPECT_EQ(ros2_field_name("_a__b_"), "a_b");
    EXPECT_EQ(ros2_field_name("3d"), "f3d");
    EXPECT_EQ(ros2_field_name("_"), "f");
    EXPECT_EQ(ros2_constant_name("GOPRO_RESOLUTION_2_7k_17_9"), "GOPRO_RESOLUTION_2_7K_17_9");
    EXPECT_EQ(ros2_constant_name("3D_FIX"), "F3D_FIX");
}

}  // namespace
}  // namespace mavloom::message
