// SPDX-License-Identifier: MIT
#include "flight/craft.hpp"

#include <algorithm>

#include "flight/physics/atmosphere.hpp"
#include "flight/physics/magnetic_field.hpp"
#include "flight/physics/math.hpp"

namespace mavloom::flight {

namespace {

constexpr std::uint64_t wind_stream = 0x77696e64;  // the wind draws from numbers of its own

// Only a multicopter can fly at random.
Kind kind_of(const VehicleOptions& options) noexcept {
    return options.motion == Motion::random ? Kind::quad : options.kind;
}

// The set-point for the true motion with which an estimate of this error meets the given one.
Setpoint corrected(Setpoint setpoint, const Vector3& error, const Vector3& rate) {
    setpoint.position -= error;
    setpoint.from -= error;
    setpoint.velocity -= rate;
    return setpoint;
}

GeoPoint geo_of(const Home& home) { return {home.latitude_deg, home.longitude_deg, home.altitude_m}; }

}  // namespace

Craft::Craft(const VehicleOptions& options)
    : kind_(options.kind),
      ground_altitude_(options.home.altitude_m),
      plant_(make_plant(kind_of(options), options.body)),
      pilot_(make_pilot(kind_of(options), options.body)),
      battery_(options.battery, options.autopilot == Autopilot::px4),
      sensors_(options.has_noise ? std::optional(options.noise) : std::nullopt, options.seed,
               magnetic_field(geo_of(options.home))),
      wind_(options.wind, options.seed ^ wind_stream),
      frame_(geo_of(options.home)),
      air_density_(density_at(options.home.altitude_m)) {
    place(Vector3::Zero(), to_radians(options.home.heading_deg));
}

void Craft::place(const Vector3& position, double heading) {
    plant_->place(position, heading);
    pilot_->start(truth());
    sense();
}

void Craft::reboot() {
    time_ = {};
    sensors_.acquire_gps(false);
    sensors_.restart_estimate();
    battery_.replace();
    has_origin_ = false;
    home_.reset();
}

// The pilot knows the true motion, and the autopilot only its estimate.
void Craft::step(const Setpoint& setpoint, bool armed) {
    wind_.step();
    if (sensors_.is_deceived()) {
        const Setpoint wanted = corrected(setpoint, sensors_.estimate_error(), sensors_.estimate_error_rate());
        return move(pilot_->step(wanted, armed, *plant_, surroundings()), armed);
    }
    move(pilot_->step(setpoint, armed, *plant_, surroundings()), armed);
}

void Craft::step(const Outputs& outputs, bool armed) {
    wind_.step();
    move(outputs, armed);
}

void Craft::move(const Outputs& outputs, bool armed) {
    time_ += step_time;
    outputs_ = outputs;
    stop_failed_motors(outputs_, plant_->channels(), sensors_.failures());
    plant_->step(outputs_, surroundings(), step_s);
    if (!plant_->is_finite()) put_back();
    battery_.step(plant_->load(), step_s);
    if (!armed) battery_.rest(step_s);
    sense();
}

void Craft::put_back() {
    plant_->place({home_place_.x(), home_place_.y(), ground_z()}, home_yaw_);
    pilot_->start(truth());
    ++not_finite_;
}

void Craft::set_failures(const Failures& failures) {
    if (sensors_.failures().rangefinder == Failure::none)
        last_range_ = std::max(position().altitude - ground_altitude_, 0.0);
    sensors_.set_failures(failures);
    battery_.report_empty(failures.battery == Failure::off);
}

InnerTargets Craft::targets() const {
    InnerTargets targets = pilot_->targets();
    if (!sensors_.is_deceived()) return targets;
    targets.position += sensors_.estimate_error();
    targets.velocity += sensors_.estimate_error_rate();
    return targets;
}

Surroundings Craft::surroundings() const {
    return {.wind = wind_.velocity(), .ground = ground_z(), .air_density = air_density_, .supply = battery_.supply()};
}

// A resting vehicle does not move, and its motors do not shake it.
void Craft::sense() {
    const Kinematics& motion = truth();
    const bool at_rest = plant_->touches_ground() && motion.velocity.squaredNorm() < 1e-4 && plant_->thrust() < 0.2;
    sensors_.step(motion, plant_->air_velocity(), at_rest, frame_.origin().altitude, air_density_);
    position_is_old_ = true;
}

Vector3 Craft::set_origin(const GeoPoint& origin) {
    const LocalFrame frame(origin);
    const Vector3 by = frame.to_local(frame_.to_geo(truth().position)) - truth().position;
    frame_ = frame;
    plant_->move_origin(by);
    pilot_->move_origin(by);
    sensors_.move_origin(by);
    home_place_ = home_ ? frame_.to_local(*home_) : Vector3(home_place_ + by);
    position_is_old_ = has_origin_ = true;
    return by;
}

const GeoPoint& Craft::position() const {
    if (position_is_old_) position_ = frame_.to_geo(estimate().position);
    position_is_old_ = false;
    return position_;
}

double Craft::speed() const noexcept {
    const Vector3& velocity = estimate().velocity;
    return math::hypot(velocity.x(), velocity.y());
}

void Craft::acquire_gps() noexcept {
    sensors_.acquire_gps(true);
    has_origin_ = true;
}

void Craft::set_home(const GeoPoint& point, double yaw) {
    home_ = point;
    home_place_ = frame_.to_local(point);
    home_yaw_ = yaw;
}

}  // namespace mavloom::flight
