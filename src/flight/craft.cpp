// SPDX-License-Identifier: MIT
#include "flight/craft.hpp"

#include "flight/physics/atmosphere.hpp"

namespace mavloom::flight {

namespace {

constexpr std::uint64_t wind_stream = 0x77696e64;  // the wind draws from numbers of its own

GeoPoint geo_of(const Home& home) { return {home.latitude_deg, home.longitude_deg, home.altitude_m}; }

}  // namespace

Craft::Craft(const VehicleOptions& options)
    : kind_(options.kind),
      ground_altitude_(options.home.altitude_m),
      airframe_(make_airframe(options.motion == Motion::random ? Kind::quad : options.kind)),
      battery_(options.battery, options.autopilot == Autopilot::px4),
      sensors_(options.has_noise, options.seed),
      wind_(options.wind, options.seed ^ wind_stream),
      frame_(geo_of(options.home)),
      air_density_(density_at(options.home.altitude_m)) {
    place(Vector3::Zero(), to_radians(options.home.heading_deg));
}

void Craft::place(const Vector3& position, double heading) {
    airframe_->place(position, heading);
    sense();
}

void Craft::reboot() {
    time_ = {};
    sensors_.acquire_gps(false);
    sensors_.set_failures({});
    battery_.replace();
    has_origin_ = false;
    home_.reset();
}

void Craft::step(const Setpoint& setpoint, bool armed) {
    time_ += step_time;
    wind_.step();
    airframe_->step(
        setpoint, armed,
        {.wind = wind_.velocity(), .ground = ground_z(), .air_density = air_density_, .supply = battery_.supply()});
    battery_.step(airframe_->load(), step_s);
    if (!armed) battery_.rest(step_s);
    sense();
}

// A resting vehicle does not move, and its motors do not shake it.
void Craft::sense() {
    const Kinematics& motion = airframe_->motion();
    const bool at_rest = airframe_->touches_ground() && motion.velocity.squaredNorm() < 1e-4 &&
                         airframe_->thrust() < 0.2;
    sensors_.step(motion, airframe_->air_velocity(), at_rest, frame_.origin().altitude, air_density_);
    position_is_old_ = true;
}

Vector3 Craft::set_origin(const GeoPoint& origin) {
    const LocalFrame frame(origin);
    const Vector3 by = frame.to_local(frame_.to_geo(truth().position)) - truth().position;
    frame_ = frame;
    airframe_->move_origin(by);
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
    return std::hypot(velocity.x(), velocity.y());
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
