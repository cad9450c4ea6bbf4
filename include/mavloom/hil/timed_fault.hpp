// SPDX-License-Identifier: MIT
// A fault on purpose, at a time of a vehicle's flight. A plain value.
#pragma once

#include "mavloom/flight/fault.hpp"
#include "mavloom/flight/moment.hpp"

namespace mavloom::hil {

struct TimedFault {
    flight::FlightTime at{};
    flight::Fault fault;
};

}  // namespace mavloom::hil
