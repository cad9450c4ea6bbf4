// SPDX-License-Identifier: MIT
#include "flight/physics/sensors.hpp"

#include "flight/physics/atmosphere.hpp"

namespace mavloom::flight {

namespace {

constexpr double gyroscope_bias_rate = 1e-5;  // rad/s per square root of a second: 0.03 degrees/s in an hour
constexpr double temperature_step = 0.1;      // K, the sensor's resolution
constexpr double touchdown_vibration = 8;     // m/s^2
constexpr double calm_share = 0.2;            // of the noise, while motors and vehicle rest
constexpr double estimated_rate_sigma = to_radians(0.2);
constexpr double resting_vibration = 0.02, flying_vibration = 2;  // m/s^2
constexpr double self_heating = 3;                                // K, of the board above the air

std::array<SmoothWander, 3> wander(const Vector3& sigma, double tau, double dt) {
    return {SmoothWander(sigma.x(), tau, dt), SmoothWander(sigma.y(), tau, dt), SmoothWander(sigma.z(), tau, dt)};
}
std::array<GaussMarkov, 3> markov(double horizontal, double down, double tau, double dt) {
    return {GaussMarkov(horizontal, tau, dt), GaussMarkov(horizontal, tau, dt), GaussMarkov(down, tau, dt)};
}
// In the first of every `period` steps.
bool is_sampled(std::uint64_t step, double period) noexcept {
    return step == 0 ||
           std::floor(static_cast<double>(step) / period) > std::floor(static_cast<double>(step - 1) / period);
}
double gps_interval(const SensorTiming& timing) { return timing.gps * timing.step_s; }
template <class Noise>
Vector3 values(const std::array<Noise, 3>& noises) {
    return {noises[0].value(), noises[1].value(), noises[2].value()};
}
Vector3 rates_of(const std::array<SmoothWander, 3>& noises) {
    return {noises[0].rate(), noises[1].rate(), noises[2].rate()};
}

// A turn by small angles around the body's axes.
Quaternion small_turn(const Vector3& angles) {
    return Quaternion(1, angles.x() / 2, angles.y() / 2, angles.z() / 2).normalized();
}

}  // namespace

// Estimate: 3 cm, which with 3 s gives 1 cm/s; roll and pitch 0.15 degrees, yaw 0.3 degrees.
Sensors::Sensors(const std::optional<NoiseOptions>& noise, std::uint64_t seed, const Vector3& magnetic_field,
                 const SensorTiming& timing)
    : random_(seed),
      magnetic_field_(magnetic_field),
      timing_(timing),
      has_noise_(noise.has_value()),
      noise_(noise.value_or(NoiseOptions{})),
      position_wander_(wander(Vector3::Constant(0.03), 3, timing.step_s)),
      attitude_wander_(wander({to_radians(0.15), to_radians(0.15), to_radians(0.3)}, 2, timing.step_s)),
      gps_position_(markov(noise_.gps, noise_.gps_down, noise_.gps_time, gps_interval(timing))),
      gps_velocity_(markov(noise_.gps_velocity, noise_.gps_climb, noise_.gps_velocity_time, gps_interval(timing))),
      gyroscope_bias_{RandomWalk(gyroscope_bias_rate), RandomWalk(gyroscope_bias_rate), RandomWalk(gyroscope_bias_rate)},
      impact_(0.3, timing.step_s) {}

void Sensors::step(const Kinematics& truth, const Vector3& air_velocity, bool at_rest, double origin_altitude,
                   double air_density) {
    const double share = has_noise_ ? (at_rest ? calm_share : 1) : 0;
    if (is_deceived_) step_deceptions();
    step_estimate(truth, share);
    step_imu(truth);
    step_vibration(at_rest);
    samples_ = {is_sampled(steps_, timing_.magnetometer), is_sampled(steps_, timing_.barometer),
                is_sampled(steps_, timing_.gps)};
    if (samples_.magnetometer) step_magnetometer(truth.attitude);
    if (samples_.barometer) step_barometer(truth, air_velocity, origin_altitude - truth.position.z(), air_density);
    if (samples_.gps) {
        step_gps(truth);
        step_bias();
    }
    ++steps_;
}

void Sensors::step_estimate(const Kinematics& truth, double share) {
    for (auto* const group : {&position_wander_, &attitude_wander_})
        for (SmoothWander& axis : *group) axis.next(random_, share);
    estimate_.position = truth.position + values(position_wander_);
    estimate_.velocity = truth.velocity + rates_of(position_wander_);
    estimate_.acceleration = truth.acceleration;
    estimate_.attitude = (truth.attitude * small_turn(values(attitude_wander_))).normalized();
    estimate_.euler = to_euler(estimate_.attitude);
    const Vector3 jitter = noise(Vector3::Constant(share * estimated_rate_sigma));
    estimate_.rates = truth.rates + rates_of(attitude_wander_) + jitter;
    estimate_.heading = wrap_2pi(estimate_.euler.yaw);
    if (!is_deceived_) return;
    estimate_.position += estimate_error();
    estimate_.velocity += estimate_error_rate();
}

void Sensors::set_deceptions(const Deceptions& deceptions) {
    deceptions_ = deceptions;
    is_deceived_ |= deceptions.any();
    if (deceptions.gps_drift.isZero(0)) gps_drifted_.setZero();
    if (deceptions.barometer_drift == 0) barometer_drifted_ = 0;
}

void Sensors::step_deceptions() {
    gps_drifted_ += deceptions_.gps_drift * timing_.step_s;
    barometer_drifted_ += deceptions_.barometer_drift * timing_.step_s;
    horizontal_error_.step(gps_error());
    vertical_error_.step({0, 0, -barometer_error()});
    is_deceived_ = deceptions_.any() || horizontal_error_.any() || vertical_error_.any();
}

void Sensors::restart_estimate() {
    horizontal_error_.restart(gps_error());
    vertical_error_.restart({0, 0, -barometer_error()});
}

void Sensors::step_imu(const Kinematics& truth) {
    const Vector3 force = specific_force(truth);
    const Vector3 shaking = noise(Vector3::Constant(noise_.accelerometer));
    if (!is_frozen(failures_.accelerometer)) imu_.acceleration = force + shaking;
    const Vector3 jitter = noise(Vector3::Constant(noise_.gyroscope));
    if (!is_frozen(failures_.gyroscope)) imu_.rates = truth.rates + jitter + values(gyroscope_bias_);
}

// The level follows the motors within a second; a touchdown adds a shake that fades.
void Sensors::step_vibration(bool at_rest) {
    if (at_rest && !rested_) impact_.kick(touchdown_vibration);
    rested_ = at_rest;
    impact_.next();
    vibration_ += ((at_rest ? resting_vibration : flying_vibration) + impact_.value() - vibration_) * timing_.step_s;
}

void Sensors::step_bias() {
    if (!has_noise_) return;
    for (RandomWalk& axis : gyroscope_bias_) axis.next(random_, gps_interval(timing_));
}

void Sensors::step_magnetometer(const Quaternion& attitude) {
    const Vector3 jitter = noise({noise_.magnetometer, noise_.magnetometer, noise_.magnetometer_z});
    if (is_frozen(failures_.magnetometer)) return;
    Vector3 field = magnetic_field_;
    if (deceptions_.compass_turn != 0)
        field = turn_around(Vector3::UnitZ(), -deceptions_.compass_turn) * magnetic_field_;
    imu_.magnetic = attitude.conjugate() * field + jitter;
}

void Sensors::step_barometer(const Kinematics& truth, const Vector3& air_velocity, double altitude, double air_density) {
    const Vector3 jitter = noise({noise_.pressure / 100, noise_.airspeed, 0});
    const double reading = has_noise_ ? random_.uniform(-temperature_step / 2, temperature_step / 2) : 0;
    const double along = (truth.attitude.conjugate() * air_velocity).x() + jitter.y();
    step_airspeed(along, air_density);
    if (is_frozen(failures_.barometer)) return;
    imu_.pressure_hpa = pressure_at(altitude + barometer_error()) + jitter.x();
    imu_.pressure_altitude = altitude_of(imu_.pressure_hpa);
    imu_.temperature_c = temperature_at(altitude) - 273.15 + self_heating + reading;
}

// A blocked pitot tube passes less pressure, 30 % after a second.
void Sensors::step_airspeed(double along, double air_density) {
    constexpr double least = 0.3, blocking_time = 1;  // s
    const double step = (1 - least) * timing_.barometer * timing_.step_s / blocking_time;
    open_pitot_ = failures_.airspeed == Failure::wrong ? std::max(open_pitot_ - step, least) : 1;
    if (is_frozen(failures_.airspeed)) return;
    imu_.differential_hpa = open_pitot_ * std::copysign(0.5 * air_density * along * along, along) / 100;
}

void Sensors::step_gps(const Kinematics& truth) {
    if (has_noise_)
        for (auto* const group : {&gps_position_, &gps_velocity_})
            for (GaussMarkov& axis : *group) axis.next(random_);
    if (failures_.gps == Failure::stuck && gps_.fix_type != 0) return;
    const bool has_fix = gps_acquired_ && failures_.gps != Failure::off && failures_.gps != Failure::stuck;
    gps_ = {.fix_type = static_cast<std::uint8_t>(has_fix ? 3 : failures_.gps == Failure::off ? 0 : 1)};
    if (!has_fix) return;
    if (failures_.gps == Failure::wrong) gps_.fix_type = failures_.wrong_fix;
    gps_.position = truth.position + values(gps_position_) + gps_error();
    gps_.velocity = truth.velocity + values(gps_velocity_) + deceptions_.gps_drift;
    gps_.satellites = 10;
    gps_.hdop = 0.7;
    gps_.vdop = 1.1;
    gps_.horizontal_m = 0.9;
    gps_.vertical_m = 1.78;
    gps_.speed_m_s = 0.4;
}

void Sensors::move_origin(const Vector3& by) {
    estimate_.position += by;
    gps_.position += by;
}

Vector3 Sensors::noise(const Vector3& sigma) {
    if (!has_noise_) return Vector3::Zero();
    const double x = random_.normal(), y = random_.normal(), z = random_.normal();
    return sigma.cwiseProduct(Vector3(x, y, z));
}

bool Sensors::has_position() const noexcept {
    constexpr std::uint8_t three_dimensions = 3;
    return gps_acquired_ && (failures_.gps == Failure::none ||
                             (failures_.gps == Failure::wrong && failures_.wrong_fix >= three_dimensions));
}

double Sensors::position_accuracy() const noexcept { return has_position() ? 0.3 : 50; }

}  // namespace mavloom::flight
