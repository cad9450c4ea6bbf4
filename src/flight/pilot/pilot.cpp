// SPDX-License-Identifier: MIT
#include "flight/pilot/pilot.hpp"

#include "flight/pilot/copter/copter_pilot.hpp"
#include "flight/pilot/plane/plane_pilot.hpp"
#include "flight/pilot/rover_pilot.hpp"

namespace mavloom::flight {

std::unique_ptr<Pilot> make_pilot(Kind kind, const Body& body) {
    if (kind == Kind::plane) return std::make_unique<wing::PlanePilot>(body.plane);
    if (kind == Kind::rover) return std::make_unique<RoverPilot>(body.rover);
    return std::make_unique<CopterPilot>(body.copter);
}

}  // namespace mavloom::flight
