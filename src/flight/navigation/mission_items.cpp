// SPDX-License-Identifier: MIT
// What each item of a mission does.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "flight/navigation/mission_report.hpp"
#include "flight/navigation/mission_runner.hpp"
#include "flight/physics/math.hpp"
#include "mavloom/msg/enums/mav_cmd.hpp"
#include "mavloom/msg/enums/mav_frame.hpp"

namespace mavloom::flight {

namespace {

using namespace msg;

constexpr double max_height = 1e5;  // m; higher or lower places are at this height

// Parameters may be NaN or infinite; a wait then lasts no time, or a day.
double seconds_of(double value) noexcept { return std::isnan(value) ? 0 : std::clamp(value, 0.0, 86'400.0); }

}  // namespace

bool MissionRunner::fly() {
    switch (item().command) {
        case MAV_CMD_NAV_WAYPOINT:
        case MAV_CMD_NAV_SPLINE_WAYPOINT:
        case MAV_CMD_NAV_LOITER_UNLIM:
        case MAV_CMD_NAV_LOITER_TURNS:
        case MAV_CMD_NAV_LOITER_TIME:
        case MAV_CMD_NAV_LOITER_TO_ALT:
        case MAV_CMD_CONDITION_GATE: return fly_place();
        case MAV_CMD_NAV_TAKEOFF:
        case MAV_CMD_NAV_VTOL_TAKEOFF: return fly_takeoff();
        case MAV_CMD_NAV_LAND:
        case MAV_CMD_NAV_VTOL_LAND: return fly_landing();
        case MAV_CMD_NAV_RETURN_TO_LAUNCH: return fly_return();
        case MAV_CMD_NAV_DELAY:
        case MAV_CMD_CONDITION_DELAY: return wait(seconds_of(param(1)));
        default: act_at_once(); return true;
    }
}

// --- Items with a place

// A vehicle on the ground takes off first.
bool MissionRunner::fly_place() {
    if (stage_ == Stage::fresh) {
        if (context_.kind() != Kind::rover && context_.is_on_ground()) {
            lift_off(std::min(place().z(), context_.craft.ground_z() - context_.tuning.takeoff_altitude));
        } else {
            set_out();
        }
    }
    if (stage_ == Stage::lift && !context_.is_on_ground() && guidance_.has_goal_altitude()) set_out();
    if (stage_ == Stage::travel && has_arrived()) begin_act();
    return stage_ == Stage::act && has_acted();
}

void MissionRunner::lift_off(double z) {
    const std::string height = fmt::format("{:.1f}", context_.craft.home_place().z() - z);
    context_.say(Severity::info, filled(context_.texts().climb_to, height));
    guidance_.climb(z);
    enter(Stage::lift);
}

// A plane joins the circle of a loiter item from outside. PX4 changes to the altitude of LOITER_TO_ALT on the circle
// only.
void MissionRunner::set_out() {
    enter(Stage::travel);
    if (!circles()) return guidance_.go(place(), yaw());
    Vector3 center = place();
    const double z = guidance_.goal().z();
    if (item().command == MAV_CMD_NAV_LOITER_TO_ALT && std::isfinite(z)) center.z() = z;
    guidance_.stay(center, nan, radius());
}

bool MissionRunner::circles() const noexcept {
    const std::uint16_t command = item().command;
    return context_.kind() == Kind::plane &&
           (command == MAV_CMD_NAV_LOITER_TO_ALT || command == MAV_CMD_NAV_LOITER_TIME ||
            command == MAV_CMD_NAV_LOITER_TURNS || command == MAV_CMD_NAV_LOITER_UNLIM);
}

double MissionRunner::radius() const noexcept {
    const double given = param(item().command == MAV_CMD_NAV_LOITER_TO_ALT ? 2 : 3);
    return std::isfinite(given) && given != 0 ? std::clamp(given, -1e4, 1e4) : context_.tuning.loiter_radius;
}

double MissionRunner::arrival_radius() const noexcept {
    constexpr double turning = 25;  // m; a plane cannot meet a point more closely
    const double least = context_.kind() == Kind::plane ? turning : 0;
    if (circles()) return std::abs(radius()) + turning;
    const bool has_radius = item().command == MAV_CMD_NAV_WAYPOINT && param(2) > 0;
    return std::max(has_radius ? std::min(param(2), 1e4) : context_.tuning.acceptance_radius, least);
}

bool MissionRunner::has_arrived() const {
    const std::uint16_t command = item().command;
    if (!guidance_.is_near_goal(arrival_radius())) return false;
    const bool needs_altitude = circles() ? command == MAV_CMD_NAV_LOITER_TIME || command == MAV_CMD_NAV_LOITER_UNLIM
                                          : context_.kind() != Kind::plane && command != MAV_CMD_NAV_LOITER_TO_ALT;
    return !needs_altitude || guidance_.has_goal_altitude();
}

void MissionRunner::begin_act() {
    const std::uint16_t command = item().command;
    const double distance = (guidance_.goal() - context_.craft.estimate().position).head<2>().norm();
    report_arrival(context_, index_, item(), distance, distance > arrival_radius());
    if (command == MAV_CMD_NAV_LOITER_TURNS) {
        guidance_.circle({.center = guidance_.goal(), .radius = radius()});
    } else if (command == MAV_CMD_NAV_LOITER_TO_ALT) {
        guidance_.stay(place(), nan, radius());
    } else if (command == MAV_CMD_NAV_LOITER_UNLIM || command == MAV_CMD_NAV_LOITER_TIME || seconds_of(param(1)) > 0) {
        guidance_.stay(guidance_.goal(), yaw(), radius());
    }
    enter(Stage::act);
}

bool MissionRunner::has_acted() const {
    const double passed = context_.seconds_since(since_);
    switch (item().command) {
        case MAV_CMD_NAV_LOITER_UNLIM: return false;
        case MAV_CMD_NAV_LOITER_TO_ALT: return guidance_.has_goal_altitude() && leaves_circle();
        case MAV_CMD_NAV_LOITER_TURNS: return guidance_.turned() >= 2 * pi * seconds_of(param(1)) && leaves_circle();
        case MAV_CMD_NAV_LOITER_TIME: return passed >= seconds_of(param(1)) && leaves_circle();
        case MAV_CMD_CONDITION_GATE: return true;
        default: return passed >= seconds_of(param(1));
    }
}

// A plane leaves its circle where the way to the next place is a tangent. It begins to roll out a little earlier.
bool MissionRunner::leaves_circle() const {
    const auto next = next_place();
    if (!circles() || !next) return true;
    const double across = std::abs(radius());
    if ((*next - guidance_.goal()).head<2>().norm() < 1.05 * across) return true;  // there is no tangent
    const Estimate& now = context_.craft.estimate();
    const Vector3 way = *next - now.position;
    const double course = math::atan2(now.velocity.y(), now.velocity.x());
    const double to_turn = std::copysign(1, radius()) * wrap_pi(math::atan2(way.y(), way.x()) - course);
    constexpr double roll_out = 0.6, tolerance = 0.03;  // s, rad
    return std::abs(to_turn) < tolerance + roll_out * now.velocity.head<2>().norm() / across;
}

// The place of the next item that moves the vehicle; empty if it has none.
std::optional<Vector3> MissionRunner::next_place() const {
    const auto items = context_.plans.mission().items();
    const auto moves = [](const PlanItem& item) { return item.command < MAV_CMD_NAV_LAST; };
    const auto at = std::find_if(items.begin() + std::min<std::ptrdiff_t>(next_, size()), items.end(), moves);
    const auto point = at == items.end() ? std::nullopt : position_of(*at);
    return point ? std::optional(context_.craft.frame().to_local(*point)) : std::nullopt;
}

// --- Take-off, landing, return, waiting

bool MissionRunner::fly_takeoff() {
    if (context_.kind() == Kind::rover) return true;
    if (stage_ == Stage::fresh) lift_off(std::min(place().z(), context_.craft.estimate().position.z()));
    const bool is_up = !context_.is_on_ground() && guidance_.has_goal_altitude();
    if (stage_ == Stage::lift && is_up) {
        if (context_.kind() == Kind::plane || !position_of(item())) return true;
        set_out();
    }
    return stage_ == Stage::travel && has_arrived();
}

// A rover only drives to the place. A plane lands along its way there; others fly to a point above it first.
bool MissionRunner::fly_landing() {
    const Kind kind = context_.kind();
    if (kind == Kind::rover) return fly_place();
    if (stage_ == Stage::fresh) {
        if (context_.is_on_ground()) return true;
        const Vector3 spot = place();
        if (kind == Kind::plane) {
            enter(Stage::act);
            guidance_.land(spot);
        } else {
            enter(Stage::travel);
            guidance_.go({spot.x(), spot.y(), context_.craft.estimate().position.z()}, yaw());
        }
    }
    if (stage_ == Stage::travel && guidance_.is_near_goal(context_.tuning.acceptance_radius)) {
        guidance_.land(guidance_.goal(), yaw());
        enter(Stage::act);
    }
    return stage_ == Stage::act && context_.is_on_ground();
}

bool MissionRunner::fly_return() {
    if (returns_by_mode()) return wants_return_ = true;
    if (stage_ == Stage::fresh) {
        return_path_.begin();
        enter(Stage::act);
    }
    return_path_.update();
    return return_path_.is_done();
}

bool MissionRunner::wait(double seconds) {
    if (stage_ == Stage::fresh) {
        if (context_.kind() == Kind::plane && !context_.is_on_ground()) guidance_.stay(guidance_.goal());
        enter(Stage::act);
    }
    return context_.seconds_since(since_) >= seconds;
}

// --- Items that act at once

void MissionRunner::act_at_once() {
    switch (item().command) {
        case MAV_CMD_DO_JUMP: return jump();
        case MAV_CMD_DO_CHANGE_SPEED:
            if (param(1) >= 0 && param(1) <= 3) guidance_.set_speed(static_cast<SpeedKind>(param(1)), param(2));
            return;
        case MAV_CMD_DO_SET_HOME: return set_home();
        case MAV_CMD_CONDITION_YAW: return turn();
        case MAV_CMD_DO_SET_ROI:
        case MAV_CMD_NAV_ROI:
        case MAV_CMD_DO_SET_ROI_LOCATION: return set_roi();
        case MAV_CMD_DO_SET_ROI_NONE: return guidance_.heading().set_roi({});
        default: context_.observer.on_payload_item(item());
    }
}

// Negative repeats: for ever. ArduPilot does not announce those.
void MissionRunner::jump() {
    const double repeats = param(2);
    if (!(param(1) >= 0 && param(1) < size())) return;
    std::uint16_t& done = jumps_[index_];
    if (repeats >= 0 && done >= repeats) return;
    if (done < std::numeric_limits<std::uint16_t>::max()) ++done;
    if (repeats >= 0) report_jump(context_, index_, done, repeats);
    next_ = std::max(static_cast<std::uint16_t>(param(1)), first());
}

void MissionRunner::set_roi() {
    auto point = position_of(item());
    if (point) point->altitude = context_.craft.frame().origin().altitude - altitude_z();
    guidance_.heading().set_roi(point);
}

void MissionRunner::turn() {
    const double now = context_.craft.estimate().euler.yaw;
    const double angle = to_radians(param(1)) * (param(4) != 0 && param(3) < 0 ? -1 : 1);
    guidance_.heading().turn_to(param(4) != 0 ? now + angle : angle, to_radians(param(2)));
}

void MissionRunner::set_home() {
    Craft& craft = context_.craft;
    const auto point = position_of(item());
    if (param(1) == 1 || !point) {
        craft.set_home(craft.position(), craft.estimate().euler.yaw);
    } else {
        craft.set_home({point->latitude, point->longitude, craft.frame().origin().altitude - altitude_z()}, 0);
    }
    context_.observer.on_home_changed();
}

// --- Places

Vector3 MissionRunner::place() const {
    const double z = altitude_z();
    const auto point = position_of(item());
    if (!point) {
        const bool is_here = item().command != MAV_CMD_NAV_WAYPOINT || context_.is_on_ground();
        const Vector3& base = is_here ? context_.craft.estimate().position : guidance_.goal();
        return {base.x(), base.y(), z};
    }
    const Vector3 local = context_.craft.frame().to_local(*point);
    return {local.x(), local.y(), z};
}

double MissionRunner::altitude_z() const noexcept {
    const Craft& craft = context_.craft;
    const double height = double{item().z};
    if (!std::isfinite(height)) return guidance_.goal().z();
    const double bounded = std::clamp(height, -max_height, max_height);
    switch (item().frame) {
        case MAV_FRAME_GLOBAL:
        case MAV_FRAME_GLOBAL_INT: return craft.frame().origin().altitude - bounded;
        case MAV_FRAME_GLOBAL_TERRAIN_ALT:
        case MAV_FRAME_GLOBAL_TERRAIN_ALT_INT: return craft.ground_z() - bounded;
        default: return craft.home_place().z() - bounded;
    }
}

}  // namespace mavloom::flight
