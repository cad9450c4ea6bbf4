// SPDX-License-Identifier: MIT
// Makes the types of module flight available as names of sim: sim::Kind, sim::Home, sim::Moment.
#pragma once

#include "mavloom/flight/fault.hpp"    // IWYU pragma: export
#include "mavloom/flight/moment.hpp"   // IWYU pragma: export
#include "mavloom/flight/options.hpp"  // IWYU pragma: export
#include "mavloom/flight/status.hpp"   // IWYU pragma: export

namespace mavloom::sim {

using namespace flight;

}  // namespace mavloom::sim
