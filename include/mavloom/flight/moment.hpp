// SPDX-License-Identifier: MIT
// The two times of a simulation. Plain values; the caller of the module reads the clocks.
#pragma once

#include "mavloom/base/clock.hpp"

namespace mavloom::flight {

// Simulated time since the simulation began. Vehicles move and send their telemetry by this time.
using FlightTime = Nanoseconds;

// One instant on both clocks. At speed 1 they run together; at another speed the flight clock runs faster or slower.
struct Moment {
    FlightTime flight{};
    // Protocol time-outs run by this clock, because clients wait in real time.
    MonoTime real{};
};

}  // namespace mavloom::flight
