// SPDX-License-Identifier: MIT
#include "flight/pilot/plane/plane_pilot.hpp"

#include <algorithm>
#include <cmath>

#include "flight/physics/math.hpp"

namespace mavloom::flight::wing {

namespace {

constexpr double course_gain = 1.0;       // 1/s
constexpr double look_ahead_time = 3.5;   // s
constexpr double altitude_gain = 0.5;     // 1/s
constexpr double speed_gain = 0.6;        // 1/s
constexpr double climb_acceleration = 3;  // m/s^2: how fast the wanted climb rate changes
constexpr double default_radius = 50;     // m
constexpr double smallest_radius = 10;    // m
constexpr double rate_lag = 0.08;         // s, with which the body's rates follow
constexpr double slowest_flow = 7;        // m/s: below, deflections do not grow any more
constexpr double takeoff_pitch = to_radians(9);
constexpr double steepest_path = to_radians(25);
constexpr double flare_height = 4;     // m
constexpr double cut_height = 1;       // m: below, the flare is without power
constexpr double float_distance = 20;  // m that the flare adds to the glide

// The greatest angle of attack that the pilot asks for: 3 degrees below the stall.
double safe_angle(const PlaneBody& body) noexcept { return to_radians(body.stall_deg - 3); }

// Of the air, N: smaller ones count as this one.
double least_force(const PlaneBody& body) noexcept { return body.mass_kg / 1.5; }

constexpr double approach_speed(const SpeedLimits& limits) noexcept { return 1.1 * limits.air_minimum; }

double throttle_of(double wanted) noexcept { return finite_or(wanted, 0, 0, 1); }

double ground_course(const Situation& now) { return direction_of(now.motion.velocity, now.euler.yaw); }

// --- Sideways

// The course that the set-point asks for; empty: wings level.
std::optional<Course> course_towards(const Setpoint& setpoint, const Situation& now) {
    const Kinematics& motion = now.motion;
    const double look_ahead = std::max(now.air.speed, 5.0) * look_ahead_time;
    const bool has_position = has_horizontal(setpoint.position), has_velocity = has_horizontal(setpoint.velocity);
    if (setpoint.steering == Steering::waypoint && has_position)
        return course_on_line(motion, setpoint.from, setpoint.position, look_ahead);
    if (setpoint.steering == Steering::circle || (has_position && !has_velocity)) {
        if (!has_position) return std::nullopt;
        const double asked = finite_or(setpoint.radius, 0, -1e5, 1e5);
        const double radius = asked == 0 ? default_radius
                                         : std::copysign(std::max(std::abs(asked), smallest_radius), asked);
        return course_on_circle(motion, setpoint.position, radius, look_ahead);
    }
    if (has_velocity) {
        const Vector3 ahead = setpoint.position + 10 * setpoint.velocity;
        if (has_position) return course_on_line(motion, setpoint.position, ahead, look_ahead);
        return Course{.angle = direction_of(setpoint.velocity, ground_course(now))};
    }
    if (std::isfinite(setpoint.yaw)) return Course{.angle = setpoint.yaw};
    return std::nullopt;
}

// How far the plane may bank: less near the ground, and never so far that the wings would have to stall.
double bank_limit(const SpeedLimits& limits, const Situation& now) {
    const double by_height = limits.tilt * std::clamp(0.15 + now.height / 15, 0.15, 1.0);
    const double needed = now.body.mass_kg * gravity /
                          std::max(now.air.pressure * now.body.area_m2, least_force(now.body));
    const double most = now.body.lift_zero + now.body.lift_slope * safe_angle(now.body);
    const double by_stall = math::acos(std::clamp(needed / most, 0.3, 1.0));
    return std::min(by_height, by_stall);
}

// The bank at which the plane turns with this rate over the ground. The wings pull at a right angle to the airspeed,
// the turn needs the share at a right angle to the ground speed.
double bank_for(double turn_rate, const Situation& now) {
    const Vector3& velocity = now.motion.velocity;
    const double speed = math::hypot(velocity.x(), velocity.y());
    const double crab = math::cos(ground_course(now) - now.euler.yaw);
    return math::atan(turn_rate * speed / (gravity * std::max(crab, 0.4)));
}

double roll_towards(const Setpoint& setpoint, const SpeedLimits& limits, const Situation& now, double& course) {
    double turn_rate = finite_or(setpoint.yaw_rate, 0, -limits.yaw_rate, limits.yaw_rate);
    if (const auto path = course_towards(setpoint, now); path && !std::isfinite(setpoint.yaw_rate)) {
        course = wrap_pi(path->angle);
        turn_rate = path->turn_rate + course_gain * wrap_pi(path->angle - ground_course(now));
    }
    const double limit = bank_limit(limits, now);
    return std::clamp(bank_for(turn_rate, now), -limit, limit);
}

// --- Up and forward

double wanted_airspeed(const Setpoint& setpoint, const SpeedLimits& limits, const Situation& now) {
    if (setpoint.touch_down) return std::min(limits.horizontal, approach_speed(limits));
    if (setpoint.steering != Steering::trajectory || !has_horizontal(setpoint.velocity)) return limits.horizontal;
    // The velocity is that over the ground; the wind is the difference between the two present speeds.
    const double ground_speed = math::hypot(now.motion.velocity.x(), now.motion.velocity.y());
    const double wanted = math::hypot(setpoint.velocity.x(), setpoint.velocity.y());
    return std::clamp(wanted + now.air.speed - ground_speed, limits.air_minimum, limits.air_maximum);
}

double drag(const Situation& now) {
    return now.air.pressure * now.body.area_m2 * drag_coefficient(now.body, now.air.attack);
}

// The power that the motor has beyond the drag, as a climb rate.
double greatest_climb(const Situation& now) {
    const double surplus = 0.95 * full_thrust(now.body, now.air.speed) - drag(now);
    return surplus * now.air.speed / (now.body.mass_kg * gravity);
}

// Keeps the airspeed between its limits, before all else.
double protect_speed(double climb, const SpeedLimits& limits, const Situation& now) {
    const double low = 0.85 * limits.air_minimum;
    const double surplus = std::clamp((now.air.speed - low) / (limits.air_minimum - low), -1.0, 1.0);
    climb = std::min(climb, surplus * std::max(greatest_climb(now), 1.0));
    if (now.air.speed > limits.air_maximum)
        climb = std::max(climb, -drag(now) * now.air.speed / (now.body.mass_kg * gravity));
    return climb;
}

double throttle_for(double climb, double airspeed, const Situation& now) {
    const Airflow& air = now.air;
    const double acceleration = std::clamp(speed_gain * (airspeed - air.speed), -2.0, 2.0);
    const double needed = drag(now) + now.body.mass_kg * (acceleration + gravity * climb / std::max(air.speed, 5.0));
    return std::sqrt(std::clamp(needed / std::max(full_thrust(now.body, air.speed), now.body.thrust_n / 12), 0.0, 1.0));
}

// The angle of attack that carries the plane at this bank.
double carrying_attack(double roll, double path, const Situation& now) {
    const double lift = now.body.mass_kg * gravity * math::cos(path) / std::max(math::cos(roll), 0.3);
    const double coefficient = lift / std::max(now.air.pressure * now.body.area_m2, least_force(now.body));
    return std::min((coefficient - now.body.lift_zero) / now.body.lift_slope, safe_angle(now.body));
}

double pitch_for(double climb, double roll, const Situation& now) {
    const double sine = math::sin(steepest_path);
    const double path = math::asin(std::clamp(climb / std::max(now.air.speed, 5.0), -sine, sine));
    return path + carrying_attack(roll, path, now) * math::cos(roll);
}

// --- Attitude

// Body rates that bring roll and pitch to their wanted values in a coordinated turn.
Vector3 rates_for(double roll, double pitch, const Situation& now) {
    constexpr double roll_gain = 4, pitch_gain = 4;  // 1/s
    constexpr double fastest_roll = to_radians(90), fastest_pitch = to_radians(45);
    const double sin_roll = math::sin(now.euler.roll), cos_roll = math::cos(now.euler.roll);
    const double sin_pitch = math::sin(now.euler.pitch), cos_pitch = std::max(math::cos(now.euler.pitch), 0.2);
    const double roll_rate = std::clamp(roll_gain * wrap_pi(roll - now.euler.roll), -fastest_roll, fastest_roll);
    const double pitch_rate = std::clamp(pitch_gain * (pitch - now.euler.pitch), -fastest_pitch, fastest_pitch);
    const double lift = now.air.pressure * now.body.area_m2 * lift_coefficient(now.body, now.air.attack);
    const double turn = std::clamp(lift * sin_roll / (now.body.mass_kg * std::max(now.air.speed, 5.0) * cos_pitch),
                                   -2.0, 2.0);
    return {roll_rate - turn * sin_pitch, pitch_rate * cos_roll + turn * cos_pitch * sin_roll,
            turn * cos_pitch * cos_roll - pitch_rate * sin_roll};
}

Command hold_attitude(double roll, double pitch, double throttle, const Situation& now) {
    return {.roll = roll, .pitch = pitch, .rates = rates_for(roll, pitch, now), .throttle = throttle};
}

Command follow_attitude(const Setpoint& setpoint, const Situation& now) {
    if (!setpoint.attitude.coeffs().allFinite() || setpoint.attitude.norm() < 0.1)
        return hold_attitude(0, 0, throttle_of(setpoint.thrust), now);
    const Euler wanted = to_euler(setpoint.attitude.normalized());
    return hold_attitude(wanted.roll, wanted.pitch, throttle_of(setpoint.thrust), now);
}

Command follow_rates(const Vector3& wanted, double throttle, const Situation& now) {
    constexpr double fastest = to_radians(180);
    Command command{.roll = now.euler.roll, .pitch = now.euler.pitch, .throttle = throttle_of(throttle)};
    for (int axis = 0; axis < 3; ++axis) command.rates[axis] = finite_or(wanted[axis], 0, -fastest, fastest);
    return command;
}

// The deflections whose moments bring the rates to the wanted ones. They do not work against the fin.
Outputs deflections(const Command& command, const Situation& now) {
    Airflow flow = now.air;
    const double stall_angle = to_radians(now.body.stall_deg);
    flow.attack = std::clamp(flow.attack, -stall_angle, stall_angle);
    flow.slip = 0;
    const double least = 0.5 * now.density * slowest_flow * slowest_flow;
    Airflow reckoned = flow;
    reckoned.head_pressure = std::max(flow.head_pressure, least);
    const Vector3 wanted = inertia_of(now.body).cwiseProduct(command.rates - now.motion.rates) / rate_lag;
    const Vector3 moment = wanted - natural_moment(now.body, flow, now.motion.rates);
    const Vector3 needed = moment.cwiseQuotient(control_moment(now.body, reckoned));
    return {servo_output(needed.x()), servo_output(needed.y()), command.throttle, servo_output(needed.z())};
}

// On the ground the rudder steers the nose wheel.
double steering_for(double turn_rate, const Situation& now) {
    return servo_output(turn_rate * now.body.turn_radius_m / std::max(horizontal_length(now.motion.velocity), 0.5));
}

Outputs outputs_of(const std::array<double, 4>& mixer) {
    return {finite_or(mixer[0], 0, -1, 1), finite_or(mixer[1], 0, -1, 1), throttle_of(mixer[3]),
            finite_or(mixer[2], 0, -1, 1)};
}

bool wants_to_fly(const Setpoint& setpoint, const Situation& now) {
    if (setpoint.touch_down) return false;
    const double ground = now.motion.position.z() + now.height;
    if (std::isfinite(setpoint.position.z())) return setpoint.position.z() < ground - 1;
    if (std::isfinite(setpoint.velocity.z())) return setpoint.velocity.z() < 0;
    return false;
}

// The descent along a leg that ends on the ground.
double glide(const Setpoint& setpoint, const SpeedLimits& limits, const Situation& now) {
    const Vector3 leg = setpoint.position - setpoint.from;
    const double length = math::hypot(leg.x(), leg.y());
    if (setpoint.steering != Steering::waypoint || !leg.allFinite() || length < 1) return -limits.down;
    const Vector3 flown = now.motion.position - setpoint.from;
    const double slope = leg.z() / std::max(length - float_distance, length / 2);
    const double along = std::max(0.0, (flown.x() * leg.x() + flown.y() * leg.y()) / length);
    const double speed = (now.motion.velocity.x() * leg.x() + now.motion.velocity.y() * leg.y()) / length;
    const double too_low = now.motion.position.z() - (setpoint.from.z() + slope * along);
    const double climb = altitude_gain * too_low - (along > 0 ? speed * slope : 0);
    return std::clamp(climb, -2 * limits.down, limits.up);
}

}  // namespace

PlanePilot::PlanePilot(const PlaneBody& body)
    : body_(body), speed_scale_(cruise_speed(body) / cruise_speed(PlaneBody{})) {}

// A plane that stalls at a higher speed flies faster, whatever the limits are.
SpeedLimits PlanePilot::bounded(const SpeedLimits& given) const noexcept {
    const double scale = std::max(speed_scale_, 1.0);
    SpeedLimits limits = given;
    limits.air_minimum = finite_or(given.air_minimum, 12 * scale, 9 * scale, 20 * scale);
    limits.air_maximum = finite_or(given.air_maximum, 25 * scale, limits.air_minimum + 1, 30 * scale);
    limits.horizontal = finite_or(given.horizontal, 15 * scale, limits.air_minimum, limits.air_maximum);
    limits.up = finite_or(given.up, 3, 0.5, 10);
    limits.down = finite_or(given.down, 1.5, 0.5, 10);
    limits.tilt = finite_or(given.tilt, to_radians(45), to_radians(5), to_radians(60));
    return limits;
}

void PlanePilot::start(const Kinematics& /*motion*/) { forget(); }

void PlanePilot::forget() noexcept {
    held_altitude_.reset();
    run_heading_.reset();
    climb_ = 0;
}

const Outputs& PlanePilot::step(const Setpoint& setpoint, bool armed, const Plant& plant, const Surroundings& around) {
    const Kinematics& motion = plant.motion();
    const Vector3 air = motion.attitude.conjugate() * (motion.velocity - around.wind);
    const Situation now{.body = body_,
                        .motion = motion,
                        .euler = to_euler(motion.attitude),
                        .air = airflow(air, around.air_density),
                        .height = around.ground - motion.position.z(),
                        .on_ground = plant.touches_ground(),
                        .density = around.air_density};
    const Command command = command_for(setpoint, armed, now);
    report(command, now);
    if (armed && setpoint.steering == Steering::actuators) return outputs_ = outputs_of(setpoint.mixer);
    outputs_ = deflections(command, now);
    if (now.on_ground) outputs_[3] = steering_for(command.rates.z(), now);
    return outputs_;
}

Command PlanePilot::command_for(const Setpoint& setpoint, bool armed, const Situation& now) {
    if (!armed || setpoint.steering == Steering::none) {
        forget();
        return hold_attitude(0, to_radians(-3), 0, now);
    }
    switch (setpoint.steering) {
        case Steering::actuators: return follow_rates(now.motion.rates, setpoint.mixer[3], now);
        case Steering::rates: return follow_rates(setpoint.rates, setpoint.thrust, now);
        case Steering::attitude: return follow_attitude(setpoint, now);
        default: return now.on_ground ? roll_on_ground(setpoint, now) : navigate(setpoint, now);
    }
}

void PlanePilot::report(const Command& command, const Situation& now) {
    const double course = std::isnan(command.course) ? now.euler.yaw : command.course;
    const double speed = horizontal_length(now.motion.velocity);
    targets_ = {
        .attitude = to_quaternion({command.roll, command.pitch, now.euler.yaw}),
        .rates = command.rates,
        .thrust = command.throttle,
        .velocity = {speed * math::cos(course), speed * math::sin(course), -finite_or(command.climb, 0, -50, 50)}};
}

// The take-off run, or the roll-out after a landing.
Command PlanePilot::roll_on_ground(const Setpoint& setpoint, const Situation& now) {
    if (!run_heading_) run_heading_ = now.euler.yaw;
    const SpeedLimits limits = bounded(setpoint.limits);
    const bool runs = wants_to_fly(setpoint, now);
    const bool rotates = runs && now.air.speed > 0.95 * limits.air_minimum;
    Command command = hold_attitude(0, rotates ? takeoff_pitch : 0, runs ? 1 : 0, now);
    command.rates.z() = 1.5 * wrap_pi(*run_heading_ - now.euler.yaw);
    command.course = *run_heading_;
    climb_ = 0;
    return command;
}

Command PlanePilot::navigate(const Setpoint& setpoint, const Situation& now) {
    run_heading_.reset();
    const SpeedLimits limits = bounded(setpoint.limits);
    double course = now.euler.yaw;
    const double roll = roll_towards(setpoint, limits, now, course);
    double climb = protect_speed(climb_towards(setpoint, limits, now), limits, now);
    double throttle = throttle_for(climb, wanted_airspeed(setpoint, limits, now), now);
    if (setpoint.touch_down && now.height < flare_height) {
        climb = std::max(climb, -(0.3 + 0.35 * now.height));
        if (now.height < cut_height) throttle = 0;
    }
    Command command = hold_attitude(roll, pitch_for(climb, roll, now), throttle, now);
    command.course = course;
    command.climb = climb;
    return command;
}

double PlanePilot::climb_towards(const Setpoint& setpoint, const SpeedLimits& limits, const Situation& now) {
    const double altitude = -now.motion.position.z();
    const double feed_forward = finite_or(-setpoint.velocity.z(), 0, -limits.down, limits.up);
    double climb = feed_forward;
    if (setpoint.touch_down) {
        climb = glide(setpoint, limits, now);
    } else if (std::isfinite(setpoint.position.z())) {
        climb = std::clamp(altitude_gain * (-setpoint.position.z() - altitude) + feed_forward, -limits.down, limits.up);
    } else if (!std::isfinite(setpoint.velocity.z())) {
        if (!held_altitude_) held_altitude_ = altitude;
        climb = std::clamp(altitude_gain * (*held_altitude_ - altitude), -limits.down, limits.up);
    }
    if (std::isfinite(setpoint.position.z()) || std::isfinite(setpoint.velocity.z())) held_altitude_.reset();
    const double change = climb_acceleration * step_s;
    return climb_ = std::clamp(climb, climb_ - change, climb_ + change);
}

}  // namespace mavloom::flight::wing
