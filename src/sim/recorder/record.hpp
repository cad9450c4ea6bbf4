// SPDX-License-Identifier: MIT
// The records that a vehicle keeps of its flights until a client downloads a log. Private to module sim; plain values.
//
// Values have the units and the rounding of messages, so a log agrees with the telemetry of the same instant.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <variant>
#include <vector>

#include "flight/firmware/parameters.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/sim/flight.hpp"

namespace mavloom::sim {

// The state of the vehicle at one instant.
struct Sample {
    std::array<std::int32_t, 3> position{};       // 1e-7 degrees, 1e-7 degrees, mm above mean sea level
    std::array<float, 3> local{};                 // m north, east, down of the origin of the local frame
    std::array<std::int32_t, 3> gps_position{};   // as `position`
    std::uint16_t gps_speed = 0, gps_course = 0;  // cm/s, 1/100 degrees
    std::array<std::int16_t, 3> velocity{};       // cm/s north, east, down
    std::array<std::int16_t, 4> attitude{};       // quaternion times 32767
    std::array<std::int16_t, 3> rates{};          // mrad/s
    std::uint16_t millivolts = 0, used_mah = 0;   // of the battery
    std::int16_t centiamperes = 0;
    std::uint16_t remaining = 0;             // 1/10,000
    std::uint8_t mode = 0, wanted_mode = 0;  // indices of Firmware::modes
    std::uint8_t fix_type = 0, satellites = 0;
    bool is_armed = false, is_landed = false, has_failsafe = false;
};

// A text that the vehicle announced. Longer texts are cut, as ArduPilot cuts them in its logs.
struct LoggedText {
    std::uint8_t severity = 0, length = 0;
    std::array<char, 64> characters{};
    [[nodiscard]] std::string_view text() const noexcept { return {characters.data(), length}; }
};

// The vehicle is in this mode from now on: an index of Firmware::modes.
struct ModeChange {
    std::uint8_t mode = 0;
};

using LogContent = std::variant<Sample, LoggedText, ModeChange>;

struct LogRecord {
    std::uint32_t time_ms = 0;  // since boot
    std::uint32_t offset = 0;   // of its bytes in the log, once the log is complete
    LogContent content;
};
static_assert(sizeof(LogRecord) <= 88, "Limits::log_records states the size");

// The value of a parameter that differs from the initial one.
struct ChangedParameter {
    ParamIndex index = 0;
    std::uint32_t bits = 0;
};

// The facts that all records of a log share.
struct LogHead {
    SystemId system{};
    std::uint32_t began_ms = 0;      // since boot
    WallTime began{};                // the epoch if UTC is unknown
    std::array<double, 3> origin{};  // of the local frame: degrees, degrees, m above mean sea level
    std::int32_t home_altitude = 0;  // mm above mean sea level
    std::vector<ChangedParameter> changed{};
};

}  // namespace mavloom::sim
