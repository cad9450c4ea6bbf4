// SPDX-License-Identifier: MIT
// The orders of Flight: what is refused, and who carries out the rest.
#include <algorithm>
#include <cmath>
#include <utility>

#include "flight/flight.hpp"
#include "flight/physics/math.hpp"

namespace mavloom::flight {

namespace {

constexpr double highest = 1e5, widest = 1e4;  // m; beyond it, numbers from clients count as this
constexpr double farthest_origin = 100'000;    // m; farther away, the local plane differs too much from the earth
constexpr double widest_orbit = 1000;          // m

// Latitude and longitude that are both given and exist, or both absent.
enum class Given : std::uint8_t { no, yes, wrong };
Given given(double latitude, double longitude) noexcept {
    if (std::isnan(latitude) && std::isnan(longitude)) return Given::no;
    return std::abs(latitude) <= 90 && std::abs(longitude) <= 180 ? Given::yes : Given::wrong;
}
bool is_valid(const GeoPoint& point) noexcept {
    return given(point.latitude, point.longitude) == Given::yes && std::abs(point.altitude) <= highest;
}

// A position by coordinates; what is absent comes from `otherwise`. The altitude is above mean sea level.
Vector3 position_of(const Craft& craft, double latitude, double longitude, double altitude, const Vector3& otherwise) {
    const double height = bounded(altitude, highest);
    const double z = std::isnan(height) ? otherwise.z() : craft.frame().origin().altitude - height;
    if (given(latitude, longitude) != Given::yes) return {otherwise.x(), otherwise.y(), z};
    const Vector3 place = craft.frame().to_local({latitude, longitude, 0});
    return {place.x(), place.y(), z};
}

}  // namespace

Vector3 Flight::present_position(bool keeps_goal) const {
    const Guidance& guidance = navigator_.guidance();
    const Vector3& here = estimate().position;
    const bool is_there = keeps_goal || guidance.is_near_goal(tuning().acceptance_radius);
    if (!guidance.is_staying() || !is_there) return here;
    const Vector3& goal = guidance.goal();
    return {goal.x(), goal.y(), std::isfinite(goal.z()) ? goal.z() : here.z()};
}

Outcome Flight::arm(bool force, OrderedBy by) {
    return carry_out([&] { return commander_.arm(force, by); });
}

Outcome Flight::disarm(bool force, OrderedBy by) {
    if (random_pilot_) return context_.refuse(Result::denied, context_.texts().not_landed);
    return carry_out([&] { return commander_.disarm(force, by); });
}

Outcome Flight::set_mode(const ModeInfo& mode, OrderedBy by) {
    return carry_out([&] { return commander_.set_mode(mode, by); });
}

Outcome Flight::take_off(const TakeoffOrder& order) {
    return carry_out([&] { return begin_takeoff(order); });
}

// PX4 changes to its take-off mode, even while disarmed, and climbs once it is armed. ArduPilot's copter takes off in
// Guided, armed.
Outcome Flight::begin_takeoff(const TakeoffOrder& order) {
    const double now_z = context_.craft.estimate().position.z();
    const double height = bounded(order.altitude, highest);
    double z = std::isnan(height) ? now_z - context_.tuning.takeoff_altitude
                                  : context_.craft.frame().origin().altitude - height;
    const bool in_guided = !is_px4() && context_.kind() == Kind::quad;
    if (in_guided && (!context_.armed || commander_.mode().behaviour != Behaviour::offboard)) return Result::failed;
    if (in_guided && !context_.is_on_ground())
        return navigator_.guidance().is_climbing() ? Result::accepted : Result::failed;
    const bool is_too_low = z > now_z;
    if (is_too_low && in_guided) return context_.refuse(Result::failed, context_.texts().takeoff_too_low);
    if (!in_guided)
        if (Outcome outcome = commander_.enter(Behaviour::takeoff, OrderedBy::client); !outcome.is_accepted())
            return outcome;
    if (is_too_low) context_.say(Severity::critical, context_.texts().takeoff_too_low);
    navigator_.take_off(std::min(z, now_z), bounded(order.yaw, 1e3));
    return Result::accepted;
}

// PX4 and ArduPilot land where the vehicle is, whatever position the command has.
Outcome Flight::land(const LandOrder& /*order*/) {
    return carry_out([&] { return commander_.enter(Behaviour::land, OrderedBy::client); });
}

Outcome Flight::return_home() {
    return carry_out([&] { return begin_return(OrderedBy::client); });
}

Outcome Flight::begin_return(OrderedBy by) {
    if (commander_.can_run(Behaviour::return_home)) context_.say(Severity::info, context_.texts().return_ordered);
    return commander_.enter(Behaviour::return_home, by);
}

Outcome Flight::reposition(const RepositionOrder& order) {
    return carry_out([&] { return begin_reposition(order); });
}

Outcome Flight::begin_reposition(const RepositionOrder& order) {
    const Given place = given(order.latitude, order.longitude);
    if (place == Given::wrong || !context_.craft.sensors().has_position()) return Result::denied;
    const Behaviour wanted = steady_behaviour();
    if (commander_.mode().behaviour != wanted) {
        if (!order.may_change_mode) return Result::denied;
        if (Outcome outcome = commander_.enter(wanted, OrderedBy::client); !outcome.is_accepted()) return outcome;
    }
    inputs_.offboard.forget();
    Guidance& guidance = navigator_.guidance();
    if (order.speed > 0) guidance.set_speed(SpeedKind::ground, order.speed);
    const double yaw = bounded(order.yaw, 1e3);
    if (place == Given::no && std::isnan(order.altitude) && std::isnan(yaw)) {
        guidance.stop();
    } else {
        guidance.stay(position_of(context_.craft, order.latitude, order.longitude, order.altitude, present_position()),
                      yaw, bounded(order.radius, widest));
    }
    return Result::accepted;
}

Outcome Flight::orbit(const OrbitOrder& order) {
    return carry_out([&] { return begin_orbit(order); });
}

// A firmware without an orbit mode has its planes circle in Hold.
Outcome Flight::begin_orbit(const OrbitOrder& order) {
    const double radius = std::isnan(order.radius) ? context_.tuning.loiter_radius : order.radius;
    if (given(order.latitude, order.longitude) == Given::wrong || !(std::abs(radius) <= widest_orbit) || radius == 0)
        return Result::denied;
    if (!context_.craft.sensors().has_position()) return Result::denied;
    const bool has_mode = context_.firmware.mode_for(Behaviour::orbit) != nullptr;
    if (!has_mode && context_.kind() != Kind::plane) return Result::unsupported;
    if (Outcome outcome = commander_.enter(has_mode ? Behaviour::orbit : steady_behaviour(), OrderedBy::client);
        !outcome.is_accepted())
        return outcome;
    if (order.speed > 0) navigator_.guidance().set_speed(SpeedKind::ground, order.speed);
    const Vector3 center = position_of(context_.craft, order.latitude, order.longitude, order.altitude,
                                       context_.craft.estimate().position);
    navigator_.orbit({.center = center, .radius = radius, .yaw = order.yaw},
                     std::isfinite(order.turns) ? std::max(order.turns, 0.0) : 0);
    return Result::accepted;
}

// While the target stands, its course is unknown: the vehicle stays on the side where it is.
void Flight::on_target(const GeoPoint& target, const Vector3& velocity) {
    if (mode().behaviour != Behaviour::follow || !armed() || !is_valid(target)) return;
    constexpr double standing = 0.5;  // m/s
    const Tuning& t = tuning();
    const Vector3 there = frame().to_local(target);
    const Vector3 towards_us = estimate().position - there;
    const double speed = math::hypot(velocity.x(), velocity.y());
    const bool is_moving = std::isfinite(speed) && speed > standing;
    const double side = is_moving ? math::atan2(velocity.y(), velocity.x()) + t.follow_angle
                                  : math::atan2(towards_us.y(), towards_us.x());
    const double ground = home() ? home()->altitude : ground_altitude();
    const Vector3 place(there.x() + t.follow_distance * math::cos(side), there.y() + t.follow_distance * math::sin(side),
                        frame().origin().altitude - ground - t.follow_height);
    navigator_.guidance().stay(place, wrap_pi(side + pi));
}

// ArduPilot pauses within its mode; PX4 changes to Hold.
Outcome Flight::pause() {
    return carry_out([&]() -> Outcome {
        if (is_px4()) return commander_.enter(Behaviour::hold, OrderedBy::client);
        const Behaviour behaviour = mode().behaviour;
        if (behaviour != Behaviour::mission && behaviour != Behaviour::offboard) return Result::failed;
        navigator_.pause();
        return Result::accepted;
    });
}

Outcome Flight::resume() {
    return carry_out([&]() -> Outcome {
        if (is_px4()) return commander_.enter(Behaviour::mission, OrderedBy::client);
        navigator_.resume();
        return Result::accepted;
    });
}

// ArduPilot stays on its way; PX4 stops.
Outcome Flight::change_altitude(double altitude) {
    if (!std::isfinite(altitude)) return Result::denied;
    if (mode().behaviour != steady_behaviour()) return Result::temporarily_rejected;
    return carry_out([&]() -> Outcome {
        const Craft& craft = context_.craft;
        const Vector3 here = present_position(!is_px4());
        inputs_.offboard.forget();
        navigator_.guidance().stay(position_of(craft, nan, nan, altitude, here));
        return Result::accepted;
    });
}

Outcome Flight::change_speed(SpeedKind kind, double speed) {
    navigator_.guidance().set_speed(kind, speed);
    return Result::accepted;
}

Outcome Flight::turn_to(double yaw, double yaw_rate, bool relative) {
    Guidance& guidance = navigator_.guidance();
    guidance.heading().turn_to(bounded(relative ? estimate().euler.yaw + yaw : yaw, 1e3), bounded(yaw_rate, 10));
    return Result::accepted;
}

Outcome Flight::set_roi(const std::optional<GeoPoint>& point) {
    if (point && given(point->latitude, point->longitude) != Given::yes) return Result::denied;
    navigator_.guidance().heading().set_roi(point);
    return Result::accepted;
}

Outcome Flight::start_mission(std::optional<std::uint16_t> first) {
    return carry_out([&] { return begin_mission(first); });
}

// PX4 also arms. ArduPilot only changes its mode.
Outcome Flight::begin_mission(std::optional<std::uint16_t> first) {
    if (is_px4() && context_.plans.mission().empty())
        return context_.refuse(Result::denied, context_.texts().no_mission);
    if (first && !navigator_.mission().set_current(first, false)) return Result::denied;
    if (Outcome outcome = commander_.enter(Behaviour::mission, OrderedBy::client); !outcome.is_accepted())
        return outcome;
    return is_px4() ? commander_.arm(false, OrderedBy::client) : Result::accepted;
}

Outcome Flight::set_current_item(std::optional<std::uint16_t> seq, bool resets) {
    return carry_out(
        [&]() -> Outcome { return navigator_.mission().set_current(seq, resets) ? Result::accepted : Result::failed; });
}

Outcome Flight::set_home(const std::optional<GeoPoint>& point, double yaw) {
    if (point && (!is_valid(*point) || distance_m(*point, position()) > farthest_origin)) return Result::denied;
    return carry_out([&] { return commander_.set_home(point, yaw); });
}

Outcome Flight::set_origin(const GeoPoint& origin) {
    if (!is_valid(origin) || distance_m(origin, position()) > farthest_origin) return Result::denied;
    move_origin(origin);
    context_.observer.on_home_changed();  // its local position did
    return Result::accepted;
}

Outcome Flight::terminate() {
    if (random_pilot_) return Result::denied;
    return carry_out([&] { return commander_.terminate(); });
}

Outcome Flight::enable_fence(bool enabled) {
    fence_.enable(enabled);
    return Result::accepted;
}

Outcome Flight::inject_failures(const Failures& failures) {
    if (!tuning().may_inject_failures) return Result::denied;
    return carry_out([&]() -> Outcome {
        injected_ = failures;
        apply_failures();
        return Result::accepted;
    });
}

Outcome Flight::set_fault(const Fault& fault) {
    if (fault.part == FaultPart::battery && fault.kind == FaultKind::charge) return set_battery(fault.numbers[0] / 100);
    if (auto refusal = motor_refusal(fault, plant().channels()); !refusal.empty())
        return {Result::denied, std::move(refusal)};
    return carry_out([&]() -> Outcome {
        if (fault.kind == FaultKind::ok && (fault.part == FaultPart::battery || fault.part == FaultPart::all))
            context_.craft.battery().restore();
        if (fault.part == FaultPart::all) injected_ = {};
        faults_.set(fault);
        apply_failures();
        return Result::accepted;
    });
}

void Flight::apply_failures() {
    context_.craft.set_failures(merged(injected_, faults_.failures()));
    context_.craft.set_deceptions(faults_.deceptions());
}

Outcome Flight::set_battery(double share) {
    if (!(share >= 0 && share <= 1)) return Result::denied;
    return carry_out([&]() -> Outcome {
        context_.craft.battery().set_remaining(share);
        return Result::accepted;
    });
}

Outcome Flight::restore_battery() {
    return carry_out([&]() -> Outcome {
        context_.craft.battery().restore();
        return Result::accepted;
    });
}

}  // namespace mavloom::flight
