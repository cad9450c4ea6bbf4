// SPDX-License-Identifier: MIT
#include "flight/navigation/navigator.hpp"

#include <algorithm>

#include "flight/physics/math.hpp"

namespace mavloom::flight {

namespace {

constexpr double usual_orbit = 15;  // m, at most, for an orbit of a multicopter without a radius

}  // namespace

Navigator::Navigator(FlightContext& context, const Inputs& inputs)
    : context_(context),
      inputs_(inputs),
      guidance_(context),
      return_path_(context, guidance_),
      mission_(context, guidance_, return_path_),
      manual_(context),
      offboard_(context, inputs, guidance_) {}

void Navigator::enter(Behaviour behaviour) {
    if (behaviour == behaviour_) return;
    const Behaviour before = std::exchange(behaviour_, behaviour);
    is_paused_ = false;
    guidance_.reset_speeds();
    if (before == Behaviour::mission) mission_.leave();
    switch (behaviour) {
        case Behaviour::hold: return enter_hold(before);
        case Behaviour::mission: return mission_.begin();
        case Behaviour::return_home: return return_path_.begin();
        case Behaviour::takeoff:
            return take_off(context_.craft.estimate().position.z() - context_.tuning.takeoff_altitude, nan);
        case Behaviour::land: return guidance_.land_ahead();
        case Behaviour::orbit: return enter_orbit();
        case Behaviour::offboard: return offboard_.begin();
        case Behaviour::descend: return guidance_.sink();
        case Behaviour::brake:
        case Behaviour::follow: return guidance_.stop();
        case Behaviour::terminated:
        case Behaviour::unavailable: return guidance_.rest();
        default: return manual_.begin();
    }
}

// After a take-off or a mission, the vehicle stays at their goal.
void Navigator::enter_hold(Behaviour before) {
    const bool keeps_goal = before == Behaviour::takeoff || (before == Behaviour::mission && mission_.is_complete());
    if (!keeps_goal || context_.is_on_ground()) return guidance_.stop();
    Vector3 place = guidance_.goal();
    if (context_.kind() == Kind::plane && before == Behaviour::takeoff)
        place.head<2>() = context_.craft.estimate().position.head<2>();
    guidance_.stay(place);
}

// Without an order, the centre lies ahead.
void Navigator::enter_orbit() {
    const Estimate& now = context_.craft.estimate();
    const double usual = context_.tuning.loiter_radius;
    const double radius = context_.kind() == Kind::quad ? std::clamp(usual, -usual_orbit, usual_orbit) : usual;
    const double distance = std::abs(radius);
    const Vector3 ahead(math::cos(now.euler.yaw) * distance, math::sin(now.euler.yaw) * distance, 0);
    orbit({.center = now.position + ahead, .radius = radius, .yaw = OrbitYaw::to_center}, 0);
}

void Navigator::take_off(double z, double yaw) { guidance_.climb(z, yaw); }

void Navigator::orbit(const Circle& circle, double turns) {
    turns_ = turns;
    guidance_.circle(circle);
}

void Navigator::pause() {
    is_paused_ = true;
    guidance_.stop();
}

void Navigator::resume() {
    if (!std::exchange(is_paused_, false)) return;
    if (behaviour_ == Behaviour::mission) mission_.begin();
}

std::optional<Behaviour> Navigator::update() {
    std::optional<Behaviour> next;
    if (context_.armed && !is_paused_) {
        switch (behaviour_) {
            case Behaviour::mission: next = update_mission(); break;
            case Behaviour::return_home: return_path_.update(); break;
            case Behaviour::offboard: offboard_.update(); break;
            case Behaviour::orbit:
                if (turns_ > 0 && guidance_.turned() >= 2 * pi * turns_) next = Behaviour::hold;
                break;
            default:
                if (needs_sticks(behaviour_)) update_manual();
        }
    }
    guidance_.update();
    return next ? next : update_climb();
}

// Only PX4 leaves its modes when their tasks are done.
std::optional<Behaviour> Navigator::update_climb() {
    const bool climbs = behaviour_ == Behaviour::takeoff || behaviour_ == Behaviour::offboard;
    if (!climbs || !guidance_.is_climbing() || context_.is_on_ground() || !guidance_.has_goal_altitude())
        return std::nullopt;
    if (behaviour_ == Behaviour::takeoff && context_.firmware.is_px4()) return Behaviour::hold;
    Vector3 place = guidance_.goal();
    if (context_.kind() == Kind::plane) place.head<2>() = context_.craft.estimate().position.head<2>();
    guidance_.stay(place);
    return std::nullopt;
}

std::optional<Behaviour> Navigator::update_mission() {
    mission_.update();
    if (mission_.takes_return()) return Behaviour::return_home;
    if (!mission_.is_complete() || context_.is_on_ground()) return std::nullopt;
    if (context_.firmware.is_px4()) return Behaviour::hold;
    return context_.kind() == Kind::plane ? std::optional(Behaviour::return_home) : std::nullopt;
}

// Without sticks, they stand in their middle.
void Navigator::update_manual() {
    Sticks sticks{.throttle = context_.is_on_ground() && context_.kind() != Kind::rover ? 0 : 0.5};
    if (inputs_.sticks.is_fresh(context_.input_time(), context_.tuning.manual_loss)) sticks = *inputs_.sticks.value();
    guidance_.follow(manual_.steer(behaviour_, sticks));
}

}  // namespace mavloom::flight
