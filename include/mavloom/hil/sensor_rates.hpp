// SPDX-License-Identifier: MIT
// How often a simulated vehicle's sensors take samples, for an autopilot outside. A plain value; nothing here checks
// it.
#pragma once

#include <cstdint>

#include "mavloom/base/clock.hpp"

namespace mavloom::hil {

struct SensorRates {
    double imu_hz = 250;  // the rate of the steps: 100 to 1000, with a period of whole microseconds
    double magnetometer_hz = 50, barometer_hz = 50, gps_hz = 10;
    double distance_hz = 0;   // of a sensor that looks down; 0: there is none
    Nanoseconds gps_delay{};  // from a sample to its message
    unsigned imus = 1;        // up to 3; the first one sets the autopilot's clock

    [[nodiscard]] Nanoseconds step() const noexcept {
        return std::chrono::microseconds{static_cast<std::int64_t>(1e6 / imu_hz + 0.5)};
    }
};

}  // namespace mavloom::hil
