// SPDX-License-Identifier: MIT
#include "sim/command/failure_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <string_view>

#include "mavloom/msg/enums/failure_type.hpp"
#include "mavloom/msg/enums/failure_unit.hpp"

namespace mavloom::sim {

namespace {

using namespace msg;
using flight::Failure;
using flight::Result;

constexpr unsigned bit(std::uint32_t type) noexcept { return 1u << type; }
constexpr unsigned off_bit = bit(FAILURE_TYPE_OFF), stuck_bit = bit(FAILURE_TYPE_STUCK),
                   wrong_bit = bit(FAILURE_TYPE_WRONG);

// The units that PX4 supports, with their failure types as bits and their names in texts.
struct Unit {
    std::uint32_t id;
    std::string_view name;
    unsigned types;
};
constexpr std::array units{
    Unit{FAILURE_UNIT_SENSOR_GYRO, "gyro", off_bit | stuck_bit},
    Unit{FAILURE_UNIT_SENSOR_ACCEL, "accel", off_bit | stuck_bit},
    Unit{FAILURE_UNIT_SENSOR_MAG, "mag", off_bit | stuck_bit},
    Unit{FAILURE_UNIT_SENSOR_BARO, "baro", off_bit | stuck_bit},
    Unit{FAILURE_UNIT_SENSOR_GPS, "gps", off_bit | stuck_bit | wrong_bit},
    Unit{FAILURE_UNIT_SENSOR_VIO, "vio", off_bit},
    Unit{FAILURE_UNIT_SENSOR_DISTANCE_SENSOR, "distance_sensor", off_bit | stuck_bit},
    Unit{FAILURE_UNIT_SENSOR_AIRSPEED, "airspeed", off_bit | stuck_bit | wrong_bit},
    Unit{FAILURE_UNIT_SYSTEM_BATTERY, "battery", off_bit},
    Unit{FAILURE_UNIT_SYSTEM_MOTOR, "motor", off_bit},
    Unit{FAILURE_UNIT_SYSTEM_ESC, "esc", off_bit | wrong_bit},
};

const Unit* find_unit(std::uint32_t id) noexcept {
    const auto* const unit = std::ranges::find(units, id, &Unit::id);
    return unit == units.end() ? nullptr : unit;
}

bool is_supported(std::uint32_t unit, std::uint32_t type) noexcept {
    const Unit* const row = find_unit(unit);
    return row != nullptr && (type == FAILURE_TYPE_OK || (type < 32 && (row->types & bit(type)) != 0));
}

std::string_view name_of_type(std::uint32_t type) noexcept {
    if (type == FAILURE_TYPE_OFF) return "off";
    return type == FAILURE_TYPE_STUCK ? "stuck" : "wrong";
}

std::string list_of(std::uint16_t instances) {
    if (instances == FailureTable::all_instances) return "all instances";
    std::string text = "instances ";
    for (unsigned i = 0; i < 16; ++i)
        if ((instances >> i & 1) != 0) text += fmt::format("{}{}", text.back() == ' ' ? "" : ",", i + 1);
    return text;
}

std::string_view name_of_unit(std::uint32_t unit) noexcept {
    const Unit* const row = find_unit(unit);
    return row == nullptr ? "unknown" : row->name;
}

std::string described(std::uint32_t unit, std::uint32_t type, std::uint16_t instances) {
    return fmt::format("{} {}, {}", name_of_unit(unit), name_of_type(type), list_of(instances));
}

}  // namespace

Result FailureTable::inject(std::uint32_t unit, std::uint32_t type, std::uint16_t instances) noexcept {
    if (!is_supported(unit, type)) return Result::unsupported;
    if (instances == 0) return Result::accepted;
    const FailureTable before = *this;
    const std::uint16_t already = instances_of(unit, type);
    remove(unit, type == FAILURE_TYPE_OK ? instances : instances | already);
    if (type == FAILURE_TYPE_OK) return Result::accepted;
    if (count_ == most) {
        *this = before;
        return Result::temporarily_rejected;
    }
    entries_[count_++] = {unit, type, static_cast<std::uint16_t>(instances | already)};
    return Result::accepted;
}

void FailureTable::remove(std::uint32_t unit, std::uint16_t instances) noexcept {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        Entry entry = entries_[i];
        if (entry.unit == unit) entry.instances = static_cast<std::uint16_t>(entry.instances & ~instances);
        if (entry.instances != 0) entries_[kept++] = entry;
    }
    count_ = kept;
}

std::string FailureTable::text(std::uint32_t unit, std::uint32_t type, std::uint16_t instances) {
    if (type == FAILURE_TYPE_OK) return fmt::format("Cleared: {}, {}", name_of_unit(unit), list_of(instances));
    return "Injected: " + described(unit, type, instances);
}

std::vector<std::string> FailureTable::texts() const {
    std::vector<std::string> all;
    for (const Entry& entry : std::span(entries_).first(count_))
        all.push_back(described(entry.unit, entry.type, entry.instances));
    return all;
}

Failure FailureTable::first_of(std::uint32_t unit) const noexcept {
    for (std::size_t i = 0; i < count_; ++i)
        if (entries_[i].unit == unit && (entries_[i].instances & 1) != 0) return static_cast<Failure>(entries_[i].type);
    return Failure::none;
}

std::uint16_t FailureTable::instances_of(std::uint32_t unit, std::uint32_t type) const noexcept {
    for (std::size_t i = 0; i < count_; ++i)
        if (entries_[i].unit == unit && entries_[i].type == type) return entries_[i].instances;
    return 0;
}

flight::Failures FailureTable::failures() const noexcept {
    return {.gyroscope = first_of(FAILURE_UNIT_SENSOR_GYRO),
            .accelerometer = first_of(FAILURE_UNIT_SENSOR_ACCEL),
            .magnetometer = first_of(FAILURE_UNIT_SENSOR_MAG),
            .barometer = first_of(FAILURE_UNIT_SENSOR_BARO),
            .gps = first_of(FAILURE_UNIT_SENSOR_GPS),
            .rangefinder = first_of(FAILURE_UNIT_SENSOR_DISTANCE_SENSOR),
            .airspeed = first_of(FAILURE_UNIT_SENSOR_AIRSPEED),
            .battery = first_of(FAILURE_UNIT_SYSTEM_BATTERY),
            .stopped_motors = instances_of(FAILURE_UNIT_SYSTEM_MOTOR, FAILURE_TYPE_OFF),
            .silent_escs = instances_of(FAILURE_UNIT_SYSTEM_ESC, FAILURE_TYPE_OFF),
            .wrong_escs = instances_of(FAILURE_UNIT_SYSTEM_ESC, FAILURE_TYPE_WRONG)};
}

}  // namespace mavloom::sim
