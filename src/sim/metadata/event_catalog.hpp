// SPDX-License-Identifier: MIT
// The events that a simulated PX4 sends: ids, arguments and texts, both for EVENT and for the metadata that explains
// it. Private to module sim; immutable tables.
//
// Ids, levels and arguments are those of a recorded PX4 1.17. Source of the formats: MAVLink guide, "Events Interface".
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace mavloom::sim {

struct EventArgument {
    std::string_view name, type;
};

struct EventInfo {
    std::uint32_t id = 0;         // component id in the high byte
    std::uint8_t log_levels = 0;  // internal level in the high four bits, external in the low ones
    std::string_view group, name;
    std::string_view message;  // {1} is the first argument
    std::span<const EventArgument> arguments{};
    std::string_view type{}, description{};
};

[[nodiscard]] std::span<const EventInfo> event_infos() noexcept;
// Null if the catalog has no such event.
[[nodiscard]] const EventInfo* find_event(std::uint32_t id) noexcept;
// The id without the component.
[[nodiscard]] constexpr std::uint32_t event_sub_id(const EventInfo& info) noexcept { return info.id & 0xffffff; }

// A STATUSTEXT and the event with the same meaning. PX4 ends such a text with a tab, and clients that know events then
// show only the event.
struct EventText {
    std::string_view text;  // `{}` stands for a number, which is an argument of the event
    std::uint32_t id = 0;
    std::uint8_t constant = 0;  // without a number: the value of the event's only argument
};
[[nodiscard]] std::span<const EventText> event_texts() noexcept;

// Ids of the events of the protocol "health_and_arming_check", and of the log.
namespace event_id {
inline constexpr std::uint32_t arming_check_summary = 27825120, health_summary = 18691879;
inline constexpr std::uint32_t no_heading = 30203637, no_attitude = 27227279, no_local_position = 30612409,
                               no_global_position = 26788467, no_offboard_signal = 28241790, no_mission = 17154777,
                               no_manual_control = 17231145, no_ground_station = 23579003, battery_low = 21826980,
                               battery_critical = 19404811, battery_emergency = 28121863, terminated = 29532170,
                               no_arming_in_mode = 18648929;
inline constexpr std::uint32_t gps_offline = 20873969, gyro_missing = 20345936, accelerometer_missing = 25005055,
                               magnetometer_missing = 32165976, barometer_missing = 21872809;
inline constexpr std::uint32_t log_opened = 17980399;
}  // namespace event_id

// Bits of health_component_t; the indices of problem events count them.
enum HealthComponent : std::uint32_t {
    health_absolute_pressure = 1u << 1,
    health_gps = 1u << 3,
    health_remote_control = 1u << 7,
    health_motors = 1u << 8,
    health_logging = 1u << 10,
    health_battery = 1u << 11,
    health_communication = 1u << 12,
    health_attitude = 1u << 16,
    health_local_position = 1u << 17,
    health_system = 1u << 20,
    health_global_position = 1u << 24,
    health_magnetometer = 1u << 27,
    health_accelerometer = 1u << 28,
    health_gyro = 1u << 29,
};

// A bit of navigation_mode_group_t, and the mode that it stands for.
struct NavigationGroup {
    std::uint8_t index;
    std::uint32_t custom_mode;
    std::string_view name, description;
};
[[nodiscard]] std::span<const NavigationGroup> navigation_groups() noexcept;

struct EventEnumEntry {
    std::uint32_t value;
    std::string_view name, description;
};
struct EventEnum {
    std::string_view name, type;
    bool is_bitfield = false;
    std::span<const EventEnumEntry> entries{};
};
[[nodiscard]] std::span<const EventEnum> event_enums() noexcept;

}  // namespace mavloom::sim
