// SPDX-License-Identifier: MIT
#include "flight/supervision/landed_detector.hpp"

namespace mavloom::flight {

namespace {

constexpr double clearance = 0.05;   // m above the ground
constexpr double low_thrust = 0.25;  // of the full thrust: less does not carry the vehicle
constexpr double slow = 1;           // m/s
constexpr double resting_time = 1;   // s at rest on the ground, until the vehicle counts as landed

}  // namespace

void LandedDetector::reset() noexcept {
    took_off_at_ = landed_at_ = resting_since_ = {};
    context_.landed = LandedState::on_ground;
}

void LandedDetector::update(const Phase& phase) {
    const bool was_airborne = !context_.is_on_ground(), is_flying = is_airborne(phase);
    if (is_flying && !was_airborne) take_off();
    if (!is_flying && was_airborne) touch_down();
    if (!is_flying) return;
    context_.landed = phase.climbs ? LandedState::takeoff : phase.lands ? LandedState::landing : LandedState::in_air;
}

// As in PX4, an armed rover counts as flying until it is home again.
bool LandedDetector::is_airborne(const Phase& phase) {
    if (context_.kind() == Kind::rover && context_.options.motion == Motion::flight)
        return context_.armed && !phase.is_home;
    const Craft& craft = context_.craft;
    const Plant& plant = craft.plant();
    const bool rests = plant.touches_ground() && plant.motion().velocity.norm() < slow &&
                       (!context_.armed || plant.thrust() < low_thrust);
    if (!rests) resting_since_ = context_.now();
    if (context_.is_on_ground())
        return !plant.touches_ground() && craft.ground_z() - craft.truth().position.z() > clearance;
    return !rests || (context_.armed && context_.seconds_since(resting_since_) < resting_time);
}

void LandedDetector::take_off() {
    took_off_at_ = context_.now();
    if (context_.kind() != Kind::rover) context_.say(Severity::info, context_.texts().takeoff_detected);
}

void LandedDetector::touch_down() {
    landed_at_ = context_.now();
    took_off_at_ = {};
    context_.landed = LandedState::on_ground;
    if (context_.kind() != Kind::rover) context_.say(Severity::info, context_.texts().landing_detected);
}

}  // namespace mavloom::flight
