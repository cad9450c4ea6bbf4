// SPDX-License-Identifier: MIT
#include "hil/sensor_messages.hpp"

#include <algorithm>
#include <cmath>

#include "flight/physics/math.hpp"
#include "flight/wire_units.hpp"
#include "mavloom/hil/lock_step.hpp"
#include "mavloom/msg/distance_sensor.hpp"
#include "mavloom/msg/enums/hil_sensor_updated_flags.hpp"
#include "mavloom/msg/enums/mav_autopilot.hpp"
#include "mavloom/msg/enums/mav_sensor_orientation.hpp"
#include "mavloom/msg/enums/mav_state.hpp"
#include "mavloom/msg/enums/mav_type.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/hil_gps.hpp"
#include "mavloom/msg/hil_sensor.hpp"
#include "mavloom/msg/hil_state_quaternion.hpp"
#include "mavloom/wire/struct_frame.hpp"

namespace mavloom::hil {

using namespace std::chrono_literals;
using flight::as_float;
using flight::Failure;
using flight::FlightTime;
using flight::saturated;
using flight::to_cm_s;

namespace {

constexpr std::uint32_t force_fields = msg::HIL_SENSOR_UPDATED_XACC | msg::HIL_SENSOR_UPDATED_YACC |
                                       msg::HIL_SENSOR_UPDATED_ZACC;
constexpr std::uint32_t rate_fields = msg::HIL_SENSOR_UPDATED_XGYRO | msg::HIL_SENSOR_UPDATED_YGYRO |
                                      msg::HIL_SENSOR_UPDATED_ZGYRO;
constexpr std::uint32_t magnetic_fields = msg::HIL_SENSOR_UPDATED_XMAG | msg::HIL_SENSOR_UPDATED_YMAG |
                                          msg::HIL_SENSOR_UPDATED_ZMAG;
constexpr std::uint32_t pressure_fields = msg::HIL_SENSOR_UPDATED_ABS_PRESSURE | msg::HIL_SENSOR_UPDATED_PRESSURE_ALT |
                                          msg::HIL_SENSOR_UPDATED_TEMPERATURE;
constexpr std::uint32_t airspeed_fields = msg::HIL_SENSOR_UPDATED_DIFF_PRESSURE;

constexpr double magnetic_digit = 1e-4, pressure_digit = 1e-3;  // gauss, hPa
constexpr double nearest_m = 0.1, farthest_m = 50;              // of the distance sensor

std::uint16_t centimetres_of(double metres) noexcept { return saturated<std::uint16_t>(metres * 100); }
// PX4 takes a sensor with a hundred equal samples for a broken one. So the last digit changes with each sample.
double dither(unsigned sample, double digit) noexcept { return sample % 2 == 0 ? 0 : digit; }

// In cm/s. A pitot tube measures the air from ahead, and its instrument assumes the density at sea level.
std::uint16_t indicated_airspeed(double ahead, double air_density) noexcept {
    return saturated<std::uint16_t>(std::max(ahead, 0.0) * std::sqrt(air_density / flight::sea_level_density) * 100);
}

std::uint32_t fields_if(bool sampled, Failure failure, std::uint32_t fields) noexcept {
    return sampled && failure != Failure::off ? fields : 0;
}

// Of what the vehicle's own sensors sampled in the step. A sensor that is stuck still sends.
std::uint32_t updated_fields(const flight::Sensors& sensors) noexcept {
    const auto& [magnetometer, barometer, gps] = sensors.samples();
    const flight::Failures& failures = sensors.failures();
    return fields_if(true, failures.accelerometer, force_fields) | fields_if(true, failures.gyroscope, rate_fields) |
           fields_if(magnetometer, failures.magnetometer, magnetic_fields) |
           fields_if(barometer, failures.barometer, pressure_fields) |
           fields_if(barometer, failures.airspeed, airspeed_fields);
}

// Along the body's z axis onto flat ground.
double distance_to_ground(const SensedVehicle& vehicle) {
    const double down = (vehicle.truth().attitude * Vector3::UnitZ()).z();
    const double height = std::max(-vehicle.truth().position.z(), 0.0);
    return down > 0.1 ? std::clamp(height / down, nearest_m, farthest_m + 1) : farthest_m + 1;
}

std::uint16_t course_of(const Vector3& velocity) noexcept {
    constexpr double slowest = 0.1;  // m/s
    if (flight::horizontal_length(velocity) < slowest) return UINT16_MAX;
    return flight::to_centidegrees(flight::wrap_2pi(flight::math::atan2(velocity.y(), velocity.x())));
}

}  // namespace

SensorMessages::SensorMessages(const SensorRates& rates, WallTime utc_at_start)
    : utc_at_start_(utc_at_start), gps_delay_(rates.gps_delay) {
    if (rates.distance_hz > 0)
        distance_.set(std::chrono::duration_cast<Nanoseconds>(std::chrono::duration<double>(1 / rates.distance_hz)), {});
}

std::span<const wire::FrameView> SensorMessages::write(const SensedVehicle& vehicle, FlightTime now) {
    used_ = 0;
    add_sensors(vehicle, now);
    add_further_imus(vehicle, now);
    add_fixes(vehicle, now);
    if (truth_.is_due(now)) add_truth(vehicle, now);
    if (distance_.is_due(now)) add_distance(vehicle, now);
    if (heartbeat_.is_due(now)) add_heartbeat();
    return std::span(frames_).first(used_);
}

template <class Message>
void SensorMessages::add(const Message& message) {
    frames_[used_] = wire::write_frame(buffers_[used_], {.sequence = sequence_++, .source = source_}, message);
    ++used_;
}

void SensorMessages::add_sensors(const SensedVehicle& vehicle, FlightTime now) {
    const flight::ImuSample& imu = vehicle.sensors().imu();
    const auto& samples = vehicle.sensors().samples();
    const auto& failures = vehicle.sensors().failures();
    if (samples.magnetometer && !is_frozen(failures.magnetometer)) ++magnetic_samples_;
    if (samples.barometer && !is_frozen(failures.barometer)) ++pressure_samples_;
    const double magnetic = dither(magnetic_samples_, magnetic_digit);
    const double pressure = dither(pressure_samples_, pressure_digit);
    add(msg::HilSensor{.time_usec = wire_time(now),
                       .xacc = as_float(imu.acceleration.x()),
                       .yacc = as_float(imu.acceleration.y()),
                       .zacc = as_float(imu.acceleration.z()),
                       .xgyro = as_float(imu.rates.x()),
                       .ygyro = as_float(imu.rates.y()),
                       .zgyro = as_float(imu.rates.z()),
                       .xmag = as_float(imu.magnetic.x() + magnetic),
                       .ymag = as_float(imu.magnetic.y() + magnetic),
                       .zmag = as_float(imu.magnetic.z() + magnetic),
                       .abs_pressure = as_float(imu.pressure_hpa + pressure),
                       .diff_pressure = as_float(imu.differential_hpa),
                       .pressure_alt = as_float(imu.pressure_altitude),
                       .temperature = as_float(imu.temperature_c),
                       .fields_updated = updated_fields(vehicle.sensors())});
}

void SensorMessages::add_further_imus(const SensedVehicle& vehicle, FlightTime now) {
    std::uint8_t number = 0;
    for (const auto& [acceleration, rates] : vehicle.further_imus().samples())
        add(msg::HilSensor{.time_usec = wire_time(now),
                           .xacc = as_float(acceleration.x()),
                           .yacc = as_float(acceleration.y()),
                           .zacc = as_float(acceleration.z()),
                           .xgyro = as_float(rates.x()),
                           .ygyro = as_float(rates.y()),
                           .zgyro = as_float(rates.z()),
                           .fields_updated = force_fields | rate_fields,
                           .id_ = ++number});
}

// PX4 stamps a fix when it arrives, so a late fix is one that is held back here.
void SensorMessages::add_fixes(const SensedVehicle& vehicle, FlightTime now) {
    const auto& sensors = vehicle.sensors();
    const bool has_fix = sensors.samples().gps && sensors.failures().gps != Failure::off;
    if (has_fix && waiting_ < max_waiting) fixes_[waiting_++] = {now, sensors.gps()};
    if (waiting_ == 0 || fixes_[0].measured + gps_delay_ > now) return;
    add_fix(vehicle, fixes_[0]);
    std::move(fixes_.begin() + 1, fixes_.begin() + static_cast<std::ptrdiff_t>(waiting_--), fixes_.begin());
}

void SensorMessages::add_fix(const SensedVehicle& vehicle, const Fix& fix) {
    const flight::GpsFix& gps = fix.gps;
    const flight::GeoPoint place = vehicle.geo(gps.position);
    const double speed = flight::horizontal_length(gps.velocity);
    add(msg::HilGps{.time_usec = static_cast<std::uint64_t>(unix_us(utc_at_start_ + fix.measured)),
                    .fix_type = gps.fix_type,
                    .lat = flight::to_degrees_e7(place.latitude),
                    .lon = flight::to_degrees_e7(place.longitude),
                    .alt = flight::to_mm(place.altitude),
                    .eph = centimetres_of(gps.horizontal_m),
                    .epv = centimetres_of(gps.vertical_m),
                    .vel = saturated<std::uint16_t>(speed * 100),
                    .vn = to_cm_s(gps.velocity.x()),
                    .ve = to_cm_s(gps.velocity.y()),
                    .vd = to_cm_s(gps.velocity.z()),
                    .cog = course_of(gps.velocity),
                    .satellites_visible = gps.satellites});
}

// The accelerations are in mm/s^2, as PX4 reads them. By the definition of the message they are in mG.
void SensorMessages::add_truth(const SensedVehicle& vehicle, FlightTime now) {
    const flight::Kinematics& truth = vehicle.truth();
    const flight::GeoPoint place = vehicle.geo(truth.position);
    const Vector3 force = flight::specific_force(truth) * 1000;
    const Vector3 air = vehicle.air_velocity();
    add(msg::HilStateQuaternion{.time_usec = wire_time(now),
                                .attitude_quaternion = {as_float(truth.attitude.w()), as_float(truth.attitude.x()),
                                                        as_float(truth.attitude.y()), as_float(truth.attitude.z())},
                                .rollspeed = as_float(truth.rates.x()),
                                .pitchspeed = as_float(truth.rates.y()),
                                .yawspeed = as_float(truth.rates.z()),
                                .lat = flight::to_degrees_e7(place.latitude),
                                .lon = flight::to_degrees_e7(place.longitude),
                                .alt = flight::to_mm(place.altitude),
                                .vx = to_cm_s(truth.velocity.x()),
                                .vy = to_cm_s(truth.velocity.y()),
                                .vz = to_cm_s(truth.velocity.z()),
                                .ind_airspeed = indicated_airspeed(air.x(), vehicle.air_density()),
                                .true_airspeed = saturated<std::uint16_t>(air.norm() * 100),
                                .xacc = saturated<std::int16_t>(force.x()),
                                .yacc = saturated<std::int16_t>(force.y()),
                                .zacc = saturated<std::int16_t>(force.z())});
}

void SensorMessages::add_distance(const SensedVehicle& vehicle, FlightTime now) {
    const Failure failure = vehicle.sensors().failures().rangefinder;
    if (failure == Failure::off) return;
    if (failure != Failure::stuck) distance_m_ = distance_to_ground(vehicle);
    add(msg::DistanceSensor{.time_boot_ms = static_cast<std::uint32_t>(now / 1ms),
                            .min_distance = centimetres_of(nearest_m),
                            .max_distance = centimetres_of(farthest_m),
                            .current_distance = centimetres_of(distance_m_),
                            .orientation = msg::MAV_SENSOR_ROTATION_PITCH_270,
                            .covariance = 1});
}

void SensorMessages::add_heartbeat() {
    constexpr std::uint8_t mavlink_version = 3;
    add(msg::Heartbeat{.type = msg::MAV_TYPE_GENERIC,
                       .autopilot = msg::MAV_AUTOPILOT_INVALID,
                       .system_status = msg::MAV_STATE_ACTIVE,
                       .mavlink_version = mavlink_version});
}

}  // namespace mavloom::hil
