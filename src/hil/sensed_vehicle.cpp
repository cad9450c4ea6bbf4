// SPDX-License-Identifier: MIT
#include "hil/sensed_vehicle.hpp"

#include <algorithm>

#include "flight/physics/atmosphere.hpp"
#include "flight/physics/magnetic_field.hpp"

namespace mavloom::hil {

namespace {

constexpr std::uint64_t wind_stream = 0x77696e64;  // the wind draws from numbers of its own

flight::GeoPoint place_of(const flight::Home& home) { return {home.latitude_deg, home.longitude_deg, home.altitude_m}; }

double steps_between(double imu_hz, double hz) { return std::max(1.0, imu_hz / hz); }

flight::SensorTiming timing_of(const SensorRates& rates) {
    return {.step_s = std::chrono::duration<double>(rates.step()).count(),
            .magnetometer = steps_between(rates.imu_hz, rates.magnetometer_hz),
            .barometer = steps_between(rates.imu_hz, rates.barometer_hz),
            .gps = steps_between(rates.imu_hz, rates.gps_hz)};
}

}  // namespace

SensedVehicle::SensedVehicle(const flight::VehicleOptions& options, const SensorRates& rates)
    : options_(options),
      step_s_(timing_of(rates).step_s),
      plant_(flight::make_plant(options.kind, options.body)),
      sensors_(options.has_noise ? std::optional(options.noise) : std::nullopt, options.seed,
               flight::magnetic_field(place_of(options.home)), timing_of(rates)),
      further_imus_(options, rates.imus),
      wind_(options.wind, options.seed ^ wind_stream, step_s_),
      frame_(place_of(options.home)) {
    sensors_.acquire_gps(true);
    place_at_start();
}

void SensedVehicle::place_at_start() {
    plant_->place(Vector3::Zero(), flight::to_radians(options_.home.heading_deg));
    around_.push = around_.turn = Vector3::Zero();
    push_left_ = 0;
}

bool SensedVehicle::step(const flight::Outputs& outputs) {
    wind_.step();
    around_.wind = wind_.velocity();
    around_.air_density = flight::density_at(frame_.origin().altitude - truth().position.z());
    if (push_left_ == 0) around_.push = around_.turn = Vector3::Zero();
    else --push_left_;
    flight::Outputs working = outputs;
    flight::stop_failed_motors(working, plant_->channels(), sensors_.failures());
    plant_->step(working, around_, step_s_);
    const bool is_finite = plant_->is_finite();
    if (!is_finite) place_at_start();
    sense();
    return is_finite;
}

// A resting vehicle does not move, and its motors do not shake it.
void SensedVehicle::sense() {
    const bool at_rest = plant_->touches_ground() && truth().velocity.squaredNorm() < 1e-4 && plant_->thrust() < 0.2;
    sensors_.step(truth(), plant_->air_velocity(), at_rest, frame_.origin().altitude, air_density());
    further_imus_.step(truth());
}

void SensedVehicle::fail(const flight::Fault& fault) {
    faults_.set(fault);
    sensors_.set_failures(faults_.failures());
    sensors_.set_deceptions(faults_.deceptions());
}

// The rest of an earlier push is spread anew.
void SensedVehicle::push(const Vector3& velocity, const Vector3& rates) {
    const double left_s = push_left_ * step_s_;
    push_left_ = static_cast<unsigned>(push_time / step_s_);
    const double time_s = push_left_ * step_s_;
    around_.push = (around_.push * left_s + velocity) / time_s;
    around_.turn = (around_.turn * left_s + rates) / time_s;
}

void SensedVehicle::set_wind(const flight::Wind& wind) {
    wind_ = flight::WindField(wind, options_.seed ^ wind_stream, step_s_);
}

}  // namespace mavloom::hil
