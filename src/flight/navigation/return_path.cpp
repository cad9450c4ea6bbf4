// SPDX-License-Identifier: MIT
#include "flight/navigation/return_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "flight/physics/math.hpp"

namespace mavloom::flight {

// The return altitude, or above it, where the vehicle is now. Near home a cone allows a lower one.
double ReturnPath::return_z() const {
    if (context_.kind() == Kind::rover) return home().z();
    const Tuning& tuning = context_.tuning;
    const Vector3 way = home() - context_.craft.estimate().position;
    const double distance = math::hypot(way.x(), way.y());
    double height = tuning.return_altitude;
    if (distance < tuning.return_min_distance) {
        height = std::min(height, tuning.return_descend_altitude);
    } else if (tuning.return_cone > 0.01 && tuning.return_cone < to_radians(89)) {
        height = std::clamp(distance / math::tan(tuning.return_cone), std::min(tuning.return_descend_altitude, height),
                            height);
    }
    return std::min(home().z() - height, context_.craft.estimate().position.z());
}

void ReturnPath::begin() {
    if (context_.is_on_ground() && context_.kind() != Kind::rover) return guidance_.rest();
    const double z = return_z();
    const double altitude = context_.craft.frame().origin().altitude - z;
    const std::string text = filled(context_.texts().return_begins, fmt::format("{:.0f}", altitude));
    if (context_.kind() != Kind::rover)
        context_.say(Severity::info, filled(text, fmt::format("{:.0f}", home().z() - z)));
    guidance_.stop(z);
    phase_ = Phase::climb;
    if (context_.kind() == Kind::quad) return;
    // Others climb on the way.
    guidance_.go({home().x(), home().y(), z});
    phase_ = Phase::fly;
}

void ReturnPath::enter(Phase phase) {
    phase_ = phase;
    since_ = context_.now();
    const double yaw = context_.craft.home() ? context_.craft.home_yaw() : nan;
    const double z = guidance_.goal().z(), low = home().z() - context_.tuning.return_descend_altitude;
    switch (phase) {
        case Phase::fly: return guidance_.go({home().x(), home().y(), z});
        case Phase::descend: return guidance_.stay({home().x(), home().y(), low}, yaw);
        case Phase::land:
            context_.say(Severity::info, context_.texts().return_lands);
            return guidance_.land(home(), yaw);
        default: return;
    }
}

void ReturnPath::update() {
    const Tuning& tuning = context_.tuning;
    const bool is_plane = context_.kind() == Kind::plane;
    const double near = is_plane ? 1.5 * std::abs(tuning.loiter_radius) : tuning.acceptance_radius;
    switch (phase_) {
        case Phase::climb:
            if (guidance_.has_goal_altitude()) enter(Phase::fly);
            return;
        case Phase::fly:
            if (!guidance_.is_near_goal(near)) return;
            if (context_.kind() == Kind::rover) return enter(Phase::wait);
            return enter(tuning.return_land_delay == 0 && !is_plane ? Phase::land : Phase::descend);
        case Phase::descend:
            if (guidance_.is_near_goal(near) && guidance_.has_goal_altitude()) enter(Phase::wait);
            return;
        case Phase::wait:
            if (context_.kind() == Kind::rover || tuning.return_land_delay < 0) return;
            if (context_.seconds_since(since_) >= tuning.return_land_delay) enter(Phase::land);
            return;
        default: return;
    }
}

bool ReturnPath::is_done() const noexcept {
    if (context_.kind() == Kind::rover) return phase_ == Phase::wait;
    return phase_ == Phase::land && context_.is_on_ground();
}

}  // namespace mavloom::flight
