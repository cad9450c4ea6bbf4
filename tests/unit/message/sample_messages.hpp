// SPDX-License-Identifier: MIT
// Hand-written definitions for the tests of module message, laid out by hand from the public XML, so that these tests
// need neither the XML reader nor the built-in tables.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/bytes.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/message/format.hpp"
#include "mavloom/wire/frame_writer.hpp"

namespace mavloom::testing {

using dialect::CommandParam;
using dialect::Enum;
using dialect::EnumEntry;
using dialect::Field;
using dialect::FieldType;
using dialect::Message;

constexpr float nan_f = std::numeric_limits<float>::quiet_NaN();
constexpr float inf_f = std::numeric_limits<float>::infinity();

// Members that a definition leaves out are left out on purpose.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"

// ---- enums

inline constexpr EnumEntry mav_type_entries[] = {{.name = "MAV_TYPE_GENERIC", .value = 0},
                                                 {.name = "MAV_TYPE_FIXED_WING", .value = 1},
                                                 {.name = "MAV_TYPE_QUADROTOR", .value = 2}};
inline constexpr EnumEntry mode_flag_entries[] = {{.name = "CUSTOM_MODE", .value = 1},
                                                  {.name = "TEST", .value = 2},
                                                  {.name = "MANUAL_AND_ARMED", .value = 0xc0},
                                                  {.name = "SAFETY_ARMED", .value = 0x80}};
inline constexpr EnumEntry severity_entries[] = {{.name = "MAV_SEVERITY_EMERGENCY", .value = 0},
                                                 {.name = "MAV_SEVERITY_INFO", .value = 6}};
inline constexpr EnumEntry fence_action_entries[] = {{.name = "FENCE_ACTION_NONE", .value = 0},
                                                     {.name = "FENCE_ACTION_HOLD", .value = 3}};
inline constexpr CommandParam waypoint_params[] = {{.index = 1, .label = "Hold", .units = "s"},
                                                   {.index = 4, .label = "Yaw", .units = "deg"},
                                                   {.index = 5, .label = "Latitude"},
                                                   {.index = 6, .label = "Longitude"},
                                                   {.index = 7, .label = "Altitude", .units = "m"}};
inline constexpr CommandParam fence_params[] = {{.index = 2, .label = "Action", .enum_name = "FENCE_ACTION"}};
inline constexpr EnumEntry mav_cmd_entries[] = {{.name = "MAV_CMD_NAV_WAYPOINT", .value = 16, .params = waypoint_params},
                                                {.name = "MAV_CMD_DO_FENCE", .value = 207, .params = fence_params}};

inline constexpr Enum enums[] = {{.name = "FENCE_ACTION", .entries = fence_action_entries},
                                 {.name = "MAV_CMD", .entries = mav_cmd_entries},
                                 {.name = "MAV_SEVERITY", .entries = severity_entries},
                                 {.name = "MAV_TYPE", .entries = mav_type_entries},
                                 {.name = "MODE_FLAG", .bitmask = true, .entries = mode_flag_entries}};
inline constexpr const Enum& mav_cmd = enums[1];
inline constexpr const Enum& mav_severity = enums[2];
inline constexpr const Enum& mav_type = enums[3];
inline constexpr const Enum& mode_flag = enums[4];

// ---- messages

inline constexpr Field heartbeat_fields[] = {
    {.name = "type", .type = FieldType::u8, .offset = 4, .enumeration = &mav_type},
    {.name = "autopilot", .type = FieldType::u8, .offset = 5},
    {.name = "base_mode", .type = FieldType::u8, .offset = 6, .bitmask = true, .enumeration = &mode_flag},
    {.name = "custom_mode", .type = FieldType::u32, .offset = 0},
    {.name = "system_status", .type = FieldType::u8, .offset = 7},
    {.name = "mavlink_version", .type = FieldType::u8, .offset = 8}};

inline constexpr Field attitude_fields[] = {
    {.name = "time_boot_ms", .type = FieldType::u32, .offset = 0, .units = "ms"},
    {.name = "roll", .type = FieldType::f32, .offset = 4, .units = "rad"},
    {.name = "pitch", .type = FieldType::f32, .offset = 8, .units = "rad"},
    {.name = "yaw", .type = FieldType::f32, .offset = 12, .units = "rad"},
    {.name = "rollspeed", .type = FieldType::f32, .offset = 16, .units = "rad/s"},
    {.name = "pitchspeed", .type = FieldType::f32, .offset = 20, .units = "rad/s"},
    {.name = "yawspeed", .type = FieldType::f32, .offset = 24, .units = "rad/s"}};

inline constexpr Field command_int_fields[] = {
    {.name = "target_system", .type = FieldType::u8, .offset = 30},
    {.name = "target_component", .type = FieldType::u8, .offset = 31},
    {.name = "frame", .type = FieldType::u8, .offset = 32},
    {.name = "command", .type = FieldType::u16, .offset = 28, .enumeration = &mav_cmd},
    {.name = "current", .type = FieldType::u8, .offset = 33},
    {.name = "autocontinue", .type = FieldType::u8, .offset = 34},
    {.name = "param1", .type = FieldType::f32, .offset = 0},
    {.name = "param2", .type = FieldType::f32, .offset = 4},
    {.name = "param3", .type = FieldType::f32, .offset = 8},
    {.name = "param4", .type = FieldType::f32, .offset = 12},
    {.name = "x", .type = FieldType::i32, .offset = 16},
    {.name = "y", .type = FieldType::i32, .offset = 20},
    {.name = "z", .type = FieldType::f32, .offset = 24}};

inline constexpr Field statustext_fields[] = {
    {.name = "severity", .type = FieldType::u8, .offset = 0, .enumeration = &mav_severity},
    {.name = "text", .type = FieldType::char8, .array_length = 50, .offset = 1},
    {.name = "id", .type = FieldType::u16, .offset = 51, .extension = true},
    {.name = "chunk_seq", .type = FieldType::u8, .offset = 53, .extension = true}};

// Not a public message: one field of each kind that the others lack.
inline constexpr Field sample_fields[] = {
    {.name = "u64", .type = FieldType::u64, .offset = 0},
    {.name = "i64", .type = FieldType::i64, .offset = 8},
    {.name = "f64", .type = FieldType::f64, .offset = 16},
    {.name = "lat", .type = FieldType::i32, .offset = 24, .units = "degE7", .invalid = "INT32_MAX"},
    {.name = "i16s", .type = FieldType::i16, .array_length = 3, .offset = 28, .units = "cdegC", .invalid = "[INT16_MAX]"},
    {.name = "azimuth", .type = FieldType::u16, .offset = 34, .units = "deg", .multiplier = 360.0 / 255.0},
    {.name = "eph", .type = FieldType::u16, .offset = 36, .invalid = "UINT16_MAX", .multiplier = 1e-2},
    {.name = "i8", .type = FieldType::i8, .offset = 38},
    {.name = "c", .type = FieldType::char8, .offset = 39},
    {.name = "small", .type = FieldType::u8, .array_length = 3, .offset = 40},
    {.name = "blob", .type = FieldType::u8, .array_length = 10, .offset = 43},
    {.name = "covariance", .type = FieldType::f32, .array_length = 2, .offset = 53, .extension = true, .invalid = "[NaN:]"}};

inline constexpr Message messages[] = {
    {.name = "HEARTBEAT", .wire = {MessageId{0}, 50, 9, 9}, .fields = heartbeat_fields, .origin = "minimal.xml"},
    {.name = "ATTITUDE", .wire = {MessageId{30}, 39, 28, 28}, .fields = attitude_fields, .origin = "common.xml"},
    {.name = "COMMAND_INT",
     .wire = {MessageId{75}, 158, 35, 35, 30, 31},
     .fields = command_int_fields,
     .origin = "common.xml"},
    {.name = "STATUSTEXT", .wire = {MessageId{253}, 83, 51, 54}, .fields = statustext_fields, .origin = "common.xml"},
    {.name = "SAMPLE", .wire = {MessageId{70000}, 7, 53, 61}, .fields = sample_fields, .origin = "here"}};
inline constexpr const Message& heartbeat = messages[0];
inline constexpr const Message& attitude = messages[1];
inline constexpr const Message& command_int = messages[2];
inline constexpr const Message& statustext = messages[3];
inline constexpr const Message& sample = messages[4];

#pragma GCC diagnostic pop

inline const dialect::Dialect& sample_dialect() {
    static const dialect::Dialect dialect("sample", messages, enums);
    return dialect;
}

// ---- frames

// Little-endian bytes of the values, one behind the other.
template <class... T>
std::vector<std::uint8_t> bytes_of(T... values) {
    std::vector<std::uint8_t> bytes;
    const auto append = [&](auto value) {
        const auto at = bytes.size();
        bytes.resize(at + sizeof value);
        store_le(bytes.data() + at, value);
    };
    (append(values), ...);
    return bytes;
}

// Severity and text, cut or filled with `size` bytes in all.
inline std::vector<std::uint8_t> statustext_payload(std::uint8_t severity, std::string_view text, std::size_t size = 51) {
    std::vector<std::uint8_t> payload{severity};
    payload.insert(payload.end(), text.begin(), text.end());
    payload.resize(size);
    return payload;
}

class SampleFrame {
public:
    SampleFrame(const Message& message, ByteView payload, wire::Version version = wire::Version::v2)
        : message_(&message),
          view_(wire::write_frame(buffer_, {version, 7, {SystemId{1}, ComponentId{191}}}, message.wire, payload)) {}
    SampleFrame(const SampleFrame&) = delete;
    SampleFrame& operator=(const SampleFrame&) = delete;

    [[nodiscard]] message::Received received(std::string_view link = "px4") const {
        return {wall_from_us(1'700'000'000'123'456), link, view_, message_};
    }

private:
    wire::FrameBuffer buffer_{};
    const Message* message_;
    wire::FrameView view_;
};

inline std::string json_of(const message::Received& received) {
    message::TextBuffer out;
    message::append_json(out, received);
    return fmt::to_string(out);
}

inline std::string json_fields_of(const Message& message, ByteView payload) {
    message::TextBuffer out;
    message::append_json_fields(out, message, payload);
    return fmt::to_string(out);
}

inline std::string text_of(const message::Received& received) {
    message::TextBuffer out;
    message::append_text(out, received, sample_dialect());
    return fmt::to_string(out);
}

}  // namespace mavloom::testing
