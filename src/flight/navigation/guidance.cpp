// SPDX-License-Identifier: MIT
#include "flight/navigation/guidance.hpp"

#include <algorithm>
#include <cmath>

#include "flight/physics/math.hpp"
#include "flight/pilot/path.hpp"

namespace mavloom::flight {

namespace {

constexpr double stopped_speed = 0.15;                   // m/s; slower than this, a vehicle has stopped
constexpr double crawl_height = 0.6, crawl_speed = 0.3;  // m, m/s; the last part of a landing
// A plane lands on a final of this length from this height, and lines up behind its beginning.
constexpr double final_length = 350, final_height = 30, line_up = 250;  // m
// Or it lands along its last leg, if that is long and flat enough.
constexpr double shortest_final = 100, steepest_final = 0.2;  // m; metres down for each metre ahead
constexpr double glide_ratio = 12;   // metres ahead for each metre of height, when a plane lands straight ahead
constexpr double far_away = 10'000;  // m, the end of a plane's climb-out

Vector3 along(double bearing, double distance) {
    return {math::cos(bearing) * distance, math::sin(bearing) * distance, 0};
}

}  // namespace

void Guidance::begin(Manoeuvre manoeuvre, const Vector3& goal, double yaw) {
    prepare(manoeuvre, goal, yaw);
    update();
}

void Guidance::prepare(Manoeuvre manoeuvre, const Vector3& goal, double yaw) {
    from_ = manoeuvre_ == Manoeuvre::leg && manoeuvre == Manoeuvre::leg ? goal_ : context_.craft.estimate().position;
    manoeuvre_ = manoeuvre;
    goal_ = goal;
    yaw_ = yaw;
    radius_ = last_bearing_ = nan;
    turned_ = 0;
    circle_.reset();
    heading_.keep();
}

void Guidance::rest() { begin(Manoeuvre::rest, context_.craft.estimate().position); }

void Guidance::stop(double z) {
    Vector3 goal = context_.craft.estimate().position;
    if (std::isfinite(z)) goal.z() = z;
    if (context_.kind() == Kind::plane) return begin(Manoeuvre::stay, goal);
    begin(Manoeuvre::stop, std::isfinite(z) ? goal : Vector3(goal.x(), goal.y(), nan));
}

void Guidance::stay(const Vector3& place, double yaw, double radius) {
    prepare(Manoeuvre::stay, place, yaw);
    radius_ = radius;
    update();
}

void Guidance::go(const Vector3& to, double yaw) { begin(Manoeuvre::leg, to, yaw); }

void Guidance::circle(const Circle& circle) {
    prepare(Manoeuvre::circle, circle.center);
    circle_ = circle;
    update();
}

void Guidance::climb(double z, double yaw) {
    const Vector3& here = context_.craft.estimate().position;
    const Vector3 ahead = along(context_.craft.estimate().euler.yaw, far_away);
    const Vector3 above = context_.kind() == Kind::plane ? Vector3(here + ahead) : here;
    begin(Manoeuvre::climb, {above.x(), above.y(), z}, yaw);
}

void Guidance::land(const Vector3& spot, double yaw) {
    spot_ = {spot.x(), spot.y(), context_.craft.ground_z()};
    if (context_.kind() != Kind::plane) return begin(Manoeuvre::final, spot_, yaw);
    if (begins_final()) return;
    const Vector3& wind = context_.craft.wind();
    const Vector3 way = spot_ - context_.craft.estimate().position;
    const bool has_wind = horizontal_length(wind) > 2;
    const double course = has_wind ? math::atan2(-wind.y(), -wind.x()) : math::atan2(way.y(), way.x());
    begin(Manoeuvre::approach, spot_ - along(course, final_length) - Vector3(0, 0, final_height), course);
}

// The last leg or circle may lead to the spot already, as ground stations plan it. Steeper ways need an approach.
bool Guidance::begins_final() {
    const Estimate& now = context_.craft.estimate();
    const bool is_leg = manoeuvre_ == Manoeuvre::leg;
    const Vector3 entry = is_leg ? goal_ : now.position, way = spot_ - entry;
    const double length = horizontal_length(way), turn = math::atan2(way.y(), way.x()) - direction_of(now.velocity, nan);
    const double greatest_turn = is_leg ? pi / 2 : pi / 6;
    if (length < shortest_final || way.z() > steepest_final * length || !(std::abs(wrap_pi(turn)) < greatest_turn))
        return false;
    prepare(Manoeuvre::final, spot_);
    from_ = entry;
    update();
    return true;
}

void Guidance::land_ahead() {
    const Estimate& now = context_.craft.estimate();
    if (context_.kind() != Kind::plane) return land(now.position);
    const double distance = std::max(200.0, glide_ratio * context_.craft.height());
    spot_ = now.position + along(math::atan2(now.velocity.y(), now.velocity.x()), distance);
    spot_.z() = context_.craft.ground_z();
    begin(Manoeuvre::final, spot_);
}

void Guidance::sink() { begin(Manoeuvre::sink, context_.craft.estimate().position); }

void Guidance::follow(const Setpoint& setpoint) {
    manoeuvre_ = Manoeuvre::follow;
    goal_ = context_.craft.estimate().position;
    setpoint_ = setpoint;
    circle_.reset();
    if (stays_on_ground()) setpoint_.steering = Steering::none;
    target_.reset();
}

void Guidance::move_origin(const Vector3& by) {
    for (Vector3* const place : {&goal_, &from_, &spot_, &setpoint_.position, &setpoint_.from}) *place += by;
    if (circle_) circle_->center += by;
    heading_.on_origin_moved();
    update();
}

void Guidance::set_speed(SpeedKind kind, double speed) noexcept {
    const double value = std::isfinite(speed) && speed > 0 ? speed : nan;
    switch (kind) {
        case SpeedKind::climb: speeds_.up = value; break;
        case SpeedKind::descent: speeds_.down = value; break;
        default: speeds_.horizontal = value;
    }
}

bool Guidance::is_landing() const noexcept {
    return manoeuvre_ == Manoeuvre::approach || manoeuvre_ == Manoeuvre::final || manoeuvre_ == Manoeuvre::sink;
}

bool Guidance::is_staying() const noexcept {
    return manoeuvre_ == Manoeuvre::stay || manoeuvre_ == Manoeuvre::stop || manoeuvre_ == Manoeuvre::circle;
}

bool Guidance::is_near_goal(double radius) const noexcept {
    const Vector3 rest = way(), leg = goal_ - from_;
    if (horizontal_length(rest) <= radius) return true;
    const bool has_passed = rest.x() * leg.x() + rest.y() * leg.y() < 0;
    return context_.kind() == Kind::plane && manoeuvre_ == Manoeuvre::leg && has_passed;
}

bool Guidance::has_goal_altitude() const noexcept {
    return context_.kind() == Kind::rover || !(std::abs(way().z()) > context_.tuning.altitude_acceptance);
}

SpeedLimits Guidance::limits() const noexcept {
    const Tuning& tuning = context_.tuning;
    const auto either = [](double wish, double usual) { return std::isnan(wish) ? usual : wish; };
    return {.horizontal = std::min(either(speeds_.horizontal, tuning.cruise_speed), tuning.max_speed),
            .up = either(speeds_.up, tuning.climb_speed),
            .down = either(speeds_.down, tuning.descent_speed),
            .acceleration = tuning.acceleration,
            .tilt = tuning.max_tilt,
            .yaw_rate = heading_.fastest(),
            .air_minimum = tuning.min_airspeed,
            .air_maximum = std::max(tuning.max_speed, tuning.cruise_speed + 1),
            .turn_radius = tuning.rover_turn_radius};
}

// A vehicle on the ground stays there until its motors have spun up, and unless a manoeuvre leads off the ground.
bool Guidance::stays_on_ground() const noexcept {
    if (!context_.armed) return true;
    if (context_.kind() == Kind::rover) return manoeuvre_ == Manoeuvre::rest;
    if (!context_.is_on_ground()) return false;
    if (context_.seconds_since(context_.armed_at) < context_.tuning.spool_up) return true;
    return manoeuvre_ == Manoeuvre::rest || is_staying() || is_landing();
}

// PX4 slows down below one height, and lands slowly below another.
double Guidance::landing_speed() const noexcept {
    const Tuning& tuning = context_.tuning;
    const double height = context_.craft.height(), fast = limits().down, slow = std::min(tuning.land_speed, fast);
    if (height < crawl_height) return std::min(slow, crawl_speed);
    const double band = std::max(tuning.land_ramp_height - tuning.land_slow_height, 0.1);
    const double share = std::clamp((height - tuning.land_slow_height) / band, 0.0, 1.0);
    return slow + share * (fast - slow);
}

void Guidance::update() {
    if (manoeuvre_ == Manoeuvre::follow && context_.armed) return;
    setpoint_ = {};
    setpoint_.limits = limits();
    target_.reset();
    if (stays_on_ground()) return;
    steer();
    if (manoeuvre_ != Manoeuvre::sink && manoeuvre_ != Manoeuvre::rest) report_target();
}

void Guidance::steer() {
    setpoint_.steering = Steering::trajectory;
    setpoint_.position = goal_;
    const bool travels = manoeuvre_ == Manoeuvre::stay || manoeuvre_ == Manoeuvre::leg;
    const bool steers_nose = context_.kind() == Kind::quad && manoeuvre_ != Manoeuvre::circle;
    if (steers_nose) setpoint_.yaw = heading_.yaw_for(travels ? way() : Vector3(Vector3::Zero()), yaw_);
    switch (manoeuvre_) {
        case Manoeuvre::stop: return steer_stop();
        case Manoeuvre::stay: return steer_stay();
        case Manoeuvre::circle: return steer_circle();
        case Manoeuvre::climb: return steer_climb();
        case Manoeuvre::approach: return steer_approach();
        case Manoeuvre::final: return steer_down();
        case Manoeuvre::sink: return steer_sink();
        case Manoeuvre::leg:
            if (context_.kind() != Kind::quad) setpoint_.steering = Steering::waypoint;
            setpoint_.from = from_;
            return;
        default: setpoint_.steering = Steering::none;
    }
}

// It brakes at once; where it then stands is where it stays.
void Guidance::steer_stop() {
    const Vector3& velocity = context_.craft.estimate().velocity;
    if (horizontal_length(velocity) < stopped_speed &&
        (std::isfinite(goal_.z()) || std::abs(velocity.z()) < stopped_speed)) {
        const Vector3& here = context_.craft.estimate().position;
        goal_ = {here.x(), here.y(), std::isfinite(goal_.z()) ? goal_.z() : here.z()};
        setpoint_.position = goal_;
        manoeuvre_ = Manoeuvre::stay;
        return;
    }
    setpoint_.position = {nan, nan, goal_.z()};
    setpoint_.velocity = {0, 0, std::isfinite(goal_.z()) ? nan : 0};
}

void Guidance::steer_stay() {
    if (context_.kind() != Kind::plane) return;
    setpoint_.radius = std::isfinite(radius_) && radius_ != 0 ? radius_ : context_.tuning.loiter_radius;
}

void Guidance::steer_circle() {
    const Circle& circle = *circle_;
    setpoint_.steering = Steering::circle;
    setpoint_.radius = circle.radius;
    const Vector3 inwards = way(), velocity = context_.craft.estimate().velocity;
    const double bearing = math::atan2(inwards.y(), inwards.x()), side = circle.radius < 0 ? -1 : 1;
    const double distance = std::max(horizontal_length(inwards), 1.0);
    const bool is_on_circle = std::abs(distance - std::abs(circle.radius)) < 2 + 0.3 * std::abs(circle.radius);
    if (is_on_circle && std::isfinite(last_bearing_)) turned_ += side * wrap_pi(bearing - last_bearing_);
    last_bearing_ = is_on_circle ? bearing : nan;
    const double rate = is_on_circle ? (inwards.y() * velocity.x() - inwards.x() * velocity.y()) / (distance * distance)
                                     : 0;
    switch (circle.yaw) {
        case OrbitYaw::to_center: setpoint_.yaw = bearing; break;
        case OrbitYaw::along_path: setpoint_.yaw = wrap_pi(bearing - side * pi / 2); break;
        default: setpoint_.yaw = heading_.yaw_for(Vector3::Zero(), nan); return;
    }
    setpoint_.yaw_rate = rate;
}

void Guidance::steer_climb() {
    setpoint_.limits.up = context_.tuning.takeoff_speed;
    if (context_.kind() != Kind::plane) return;
    setpoint_.steering = Steering::waypoint;
    setpoint_.from = from_;
}

// A plane descends in circles behind the beginning of its final, then turns in.
void Guidance::steer_approach() {
    const Vector3 gate = goal_ - along(yaw_, line_up);
    setpoint_.position = gate;
    setpoint_.radius = context_.tuning.loiter_radius;
    const Vector3 rest = gate - context_.craft.estimate().position;
    const bool is_there = horizontal_length(rest) < 1.3 * std::abs(setpoint_.radius) && std::abs(rest.z()) < 8;
    const double course_error = wrap_pi(context_.craft.estimate().euler.yaw - yaw_);
    if (!is_there || std::abs(course_error) > 0.7) return;
    from_ = goal_;
    goal_ = spot_;
    manoeuvre_ = Manoeuvre::final;
    steer_down();
}

void Guidance::steer_down() {
    setpoint_.position = goal_;
    setpoint_.touch_down = true;
    if (context_.kind() == Kind::plane) {
        setpoint_.steering = Steering::waypoint;
        setpoint_.from = from_;
        return;
    }
    setpoint_.position.z() = nan;
    setpoint_.velocity.z() = landing_speed();
}

void Guidance::steer_sink() {
    if (context_.kind() == Kind::rover) setpoint_.steering = Steering::none;
    setpoint_.touch_down = true;
    setpoint_.position = no_vector;
    setpoint_.velocity.z() = context_.kind() == Kind::quad ? landing_speed() : limits().down;
    if (context_.kind() == Kind::quad) setpoint_.acceleration = {0, 0, nan};
}

void Guidance::report_target() {
    Vector3 place = manoeuvre_ == Manoeuvre::stop ? context_.craft.estimate().position : goal_;
    if (manoeuvre_ == Manoeuvre::stop && std::isfinite(goal_.z())) place.z() = goal_.z();
    double cross_track = 0;
    const Vector3 leg = goal_ - from_, done = context_.craft.estimate().position - from_;
    if (manoeuvre_ == Manoeuvre::leg && horizontal_length(leg) > 1)
        cross_track = (leg.x() * done.y() - leg.y() * done.x()) / horizontal_length(leg);
    target_ = NavigationTarget{place, cross_track};
}

}  // namespace mavloom::flight
