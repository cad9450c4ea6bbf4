// SPDX-License-Identifier: MIT
// What fails in a vehicle on purpose. Private to flight, sim and hil; plain values.
#pragma once

#include <cstdint>

#include "flight/plant/plant.hpp"

namespace mavloom::flight {

// Values of FAILURE_TYPE.
enum class Failure : std::uint8_t { none = 0, off = 1, stuck = 2, wrong = 4 };

// The reading stays as it is.
[[nodiscard]] constexpr bool is_frozen(Failure failure) noexcept {
    return failure == Failure::off || failure == Failure::stuck;
}

struct Failures {
    Failure gyroscope{}, accelerometer{}, magnetometer{}, barometer{}, gps{}, rangefinder{}, airspeed{}, battery{};
    std::uint8_t wrong_fix = 2;  // GPS_FIX_TYPE while the GPS is wrong
    // By number, the first in bit 0.
    std::uint16_t stopped_motors = 0, silent_escs = 0, wrong_escs = 0;

    [[nodiscard]] bool has_all_sensors() const noexcept {
        return !is_frozen(gyroscope) && !is_frozen(accelerometer) && !is_frozen(magnetometer) && !is_frozen(barometer);
    }
};

// Both together; of one part, the failure of `first` counts.
[[nodiscard]] constexpr Failures merged(Failures first, const Failures& second) noexcept {
    const auto merge = [&](Failure Failures::*part) {
        if (first.*part == Failure::none) first.*part = second.*part;
    };
    if (first.gps != Failure::wrong) first.wrong_fix = second.wrong_fix;
    for (const auto part :
         {&Failures::gyroscope, &Failures::accelerometer, &Failures::magnetometer, &Failures::barometer, &Failures::gps,
          &Failures::rangefinder, &Failures::airspeed, &Failures::battery})
        merge(part);
    first.stopped_motors |= second.stopped_motors;
    first.silent_escs |= second.silent_escs;
    first.wrong_escs |= second.wrong_escs;
    return first;
}

inline void stop_failed_motors(Outputs& outputs, const Channels& channels, const Failures& failures) noexcept {
    if (failures.stopped_motors == 0) return;
    for (std::size_t i = 0, number = 0; i < channels.used; ++i)
        if (channels.is_motor[i] && (failures.stopped_motors >> number++ & 1) != 0) outputs[i] = 0;
}

// Measurements that are wrong but look right.
struct Deceptions {
    Vector3 gps_jump = Vector3::Zero();   // m, local frame, horizontal
    Vector3 gps_drift = Vector3::Zero();  // m/s, horizontal
    double barometer_offset = 0;          // m; positive: it shows too great a height
    double barometer_drift = 0;           // m/s
    double compass_turn = 0;              // rad; positive: it shows a heading too far clockwise

    [[nodiscard]] bool any() const noexcept {
        return !gps_jump.isZero(0) || !gps_drift.isZero(0) || barometer_offset != 0 || barometer_drift != 0 ||
               compass_turn != 0;
    }
};

}  // namespace mavloom::flight
