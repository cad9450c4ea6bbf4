// SPDX-License-Identifier: MIT
#include <bit>

#include "flight/physics/math.hpp"
#include "flight/wire_units.hpp"
#include "mavloom/msg/available_modes_monitor.hpp"
#include "mavloom/msg/current_mode.hpp"
#include "mavloom/msg/enums/hl_failure_flag.hpp"
#include "mavloom/msg/enums/mav_sys_status_sensor.hpp"
#include "mavloom/msg/enums/mav_vtol_state.hpp"
#include "mavloom/msg/extended_sys_state.hpp"
#include "mavloom/msg/flight_information.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/high_latency2.hpp"
#include "mavloom/msg/mission_current.hpp"
#include "mavloom/msg/sys_status.hpp"
#include "sim/telemetry/projections.hpp"

namespace mavloom::sim {

namespace {

using namespace msg;

// Bits of SYS_STATUS.
struct SensorBits {
    std::uint32_t present, enabled, health;
};

constexpr std::uint32_t gnss_bit = MAV_SYS_STATUS_SENSOR_GPS;

// A vehicle without remote control and airspeed sensor, as PX4 1.17 reports it: the remote control is enabled but
// absent, and the bit PREARM_CHECK stands in `health` only.
constexpr SensorBits px4_bits{.present = 0x300c02f, .enabled = 0x301c02f, .health = 0x1320c83f};

constexpr std::uint32_t ardupilot_sensors = MAV_SYS_STATUS_SENSOR_3D_GYRO | MAV_SYS_STATUS_SENSOR_3D_ACCEL |
                                            MAV_SYS_STATUS_SENSOR_3D_MAG | MAV_SYS_STATUS_SENSOR_ABSOLUTE_PRESSURE |
                                            gnss_bit | MAV_SYS_STATUS_SENSOR_ANGULAR_RATE_CONTROL |
                                            MAV_SYS_STATUS_SENSOR_ATTITUDE_STABILIZATION |
                                            MAV_SYS_STATUS_SENSOR_YAW_POSITION |
                                            MAV_SYS_STATUS_SENSOR_Z_ALTITUDE_CONTROL |
                                            MAV_SYS_STATUS_SENSOR_XY_POSITION_CONTROL |
                                            MAV_SYS_STATUS_SENSOR_MOTOR_OUTPUTS | MAV_SYS_STATUS_SENSOR_RC_RECEIVER |
                                            MAV_SYS_STATUS_AHRS | MAV_SYS_STATUS_LOGGING |
                                            MAV_SYS_STATUS_SENSOR_BATTERY | MAV_SYS_STATUS_PREARM_CHECK;
// A fence that is not breached is healthy, enabled or not.
constexpr SensorBits ardupilot_bits{ardupilot_sensors, ardupilot_sensors, ardupilot_sensors | MAV_SYS_STATUS_GEOFENCE};

std::uint32_t failed_bits(const View& view) noexcept {
    const Sensors& sensors = view.flight.sensors();
    const Failures& failures = sensors.failures();
    std::uint32_t failed = 0;
    const auto fails = [&](bool is_failed, std::uint32_t bits) { failed |= is_failed ? bits : 0; };
    fails(!sensors.has_position(), gnss_bit);
    fails(is_frozen(failures.gyroscope), MAV_SYS_STATUS_SENSOR_3D_GYRO);
    fails(is_frozen(failures.accelerometer), MAV_SYS_STATUS_SENSOR_3D_ACCEL);
    fails(is_frozen(failures.magnetometer), MAV_SYS_STATUS_SENSOR_3D_MAG);
    fails(is_frozen(failures.barometer), MAV_SYS_STATUS_SENSOR_ABSOLUTE_PRESSURE);
    fails(is_frozen(failures.airspeed), MAV_SYS_STATUS_SENSOR_DIFFERENTIAL_PRESSURE);
    // ArduPilot's checks do not depend on the mode.
    const std::uint32_t ignored = view.firmware.is_px4() ? 0 : std::uint32_t{unready_mode};
    fails((view.flight.unready() & ~ignored) != 0, MAV_SYS_STATUS_PREARM_CHECK);
    return failed;
}

SensorBits sensor_bits(const View& view) noexcept {
    SensorBits bits = view.firmware.is_px4() ? px4_bits : ardupilot_bits;
    const auto has = [&](std::uint32_t bit) { bits = {bits.present | bit, bits.enabled | bit, bits.health | bit}; };
    if (view.options.has_manual_control) has(MAV_SYS_STATUS_SENSOR_RC_RECEIVER);
    if (view.options.kind == Kind::plane) has(MAV_SYS_STATUS_SENSOR_DIFFERENTIAL_PRESSURE);
    bits.health &= ~failed_bits(view);
    return bits;
}

std::uint16_t high_latency_failures(const View& view) noexcept {
    const Failures& failures = view.flight.sensors().failures();
    std::uint16_t flags = 0;
    const auto fails = [&](bool is_failed, std::uint16_t bit) {
        flags = static_cast<std::uint16_t>(flags | (is_failed ? bit : 0));
    };
    fails(!view.flight.sensors().has_position(), HL_FAILURE_FLAG_GPS);
    fails(is_frozen(failures.airspeed), HL_FAILURE_FLAG_DIFFERENTIAL_PRESSURE);
    fails(is_frozen(failures.barometer), HL_FAILURE_FLAG_ABSOLUTE_PRESSURE);
    fails(is_frozen(failures.accelerometer), HL_FAILURE_FLAG_3D_ACCEL);
    fails(is_frozen(failures.gyroscope), HL_FAILURE_FLAG_3D_GYRO);
    fails(is_frozen(failures.magnetometer), HL_FAILURE_FLAG_3D_MAG);
    fails(view.flight.battery().remaining() < view.flight.tuning().battery_critical, HL_FAILURE_FLAG_BATTERY);
    return flags;
}

// Half degrees, as HIGH_LATENCY2 has angles.
std::uint8_t to_half_degrees(double radians) noexcept {
    return static_cast<std::uint8_t>(to_whole_degrees(wrap_2pi(radians)) / 2);
}
std::uint8_t to_fifths(double metres_s) noexcept { return saturated<std::uint8_t>(metres_s * 5); }

void fill_target(const View& view, HighLatency2& message) {
    const auto& target = view.flight.target();
    if (!target) return;
    const Vector3 way = target->position - view.flight.estimate().position;
    message.target_heading = to_half_degrees(flight::math::atan2(way.y(), way.x()));
    message.target_distance = saturated<std::uint16_t>(flight::math::hypot(way.x(), way.y()) / 10);
    message.target_altitude = saturated<std::int16_t>(view.flight.frame().origin().altitude - target->position.z());
}

void fill_position(const View& view, HighLatency2& message) {
    const GeoPoint& position = view.flight.position();
    const GpsFix& fix = view.flight.sensors().gps();
    message.latitude = to_degrees_e7(position.latitude);
    message.longitude = to_degrees_e7(position.longitude);
    message.altitude = message.target_altitude = saturated<std::int16_t>(position.altitude);
    message.eph = saturated<std::uint8_t>(fix.horizontal_m * 10);
    message.epv = saturated<std::uint8_t>(fix.vertical_m * 10);
}

}  // namespace

bool write_heartbeat(const View& view, ByteSpan payload) {
    const Flight& flight = view.flight;
    const std::uint8_t armed = flight.armed() ? base_armed : 0;
    return put(Heartbeat{.type = view.firmware.mav_type_of(view.options.body.copter),
                         .autopilot = view.firmware.mav_autopilot(),
                         .base_mode = static_cast<std::uint8_t>(flight.mode().base_mode | armed),
                         .custom_mode = flight.mode().custom_mode,
                         .system_status = static_cast<std::uint8_t>(flight.system_status()),
                         .mavlink_version = 3},
               payload);
}

bool write_sys_status(const View& view, ByteSpan payload) {
    const SensorBits bits = sensor_bits(view);
    const BatteryOnWire battery = battery_on_wire(view.flight.battery());
    SysStatus message{.onboard_control_sensors_present = bits.present,
                      .onboard_control_sensors_enabled = bits.enabled,
                      .onboard_control_sensors_health = bits.health,
                      .load = 136,  // the mean load that PX4's own simulator reports: 13.6 %
                      .voltage_battery = battery.millivolts,
                      .current_battery = battery.centiamperes,
                      .battery_remaining = battery.percent};
    if (view.firmware.is_px4()) message.onboard_control_sensors_health_extended = 1;  // no recovery system is missing
    return put(message, payload);
}

bool write_extended_sys_state(const View& view, ByteSpan payload) {
    return put(ExtendedSysState{.vtol_state = MAV_VTOL_STATE_UNDEFINED,
                                .landed_state = static_cast<std::uint8_t>(view.flight.landed())},
               payload);
}

bool write_current_mode(const View& view, ByteSpan payload) {
    return put(CurrentMode{.standard_mode = view.flight.mode().standard_mode,
                           .custom_mode = view.flight.mode().custom_mode,
                           .intended_custom_mode = view.flight.intended_mode().custom_mode},
               payload);
}

// The list of modes never changes.
bool write_available_modes_monitor(const View& /*view*/, ByteSpan payload) {
    return put(AvailableModesMonitor{}, payload);
}

bool write_flight_information(const View& view, ByteSpan payload) {
    const auto us = [](FlightTime time) {
        return static_cast<std::uint64_t>(std::max<std::int64_t>(time / std::chrono::microseconds{1}, 0));
    };
    return put(FlightInformation{.time_boot_ms = boot_ms(view),
                                 .arming_time_utc = us(view.flight.armed_at()),
                                 .takeoff_time_utc = us(view.flight.took_off_at()),
                                 .flight_uuid = view.flight.flights()},
               payload);
}

// ArduPilot's first item is home, which does not count.
bool write_mission_current(const View& view, ByteSpan payload) {
    constexpr std::uint16_t no_mission = 0xffff;
    constexpr std::uint8_t in_mission = 1, suspended = 2;
    const Flight& flight = view.flight;
    const Plans& plans = flight.plans();
    const MissionProgress progress = flight.mission();
    const int items = plans.mission().size() - (view.firmware.has_home_in_mission() ? 1 : 0);
    return put(MissionCurrent{.seq = progress.current,
                              .total = items <= 0 ? no_mission : static_cast<std::uint16_t>(items),
                              .mission_state = static_cast<std::uint8_t>(progress.state),
                              .mission_mode = flight.mode().behaviour == Behaviour::mission ? in_mission : suspended,
                              .mission_id = plans.mission().id(),
                              .fence_id = plans.fence().id(),
                              .rally_points_id = plans.rally().id()},
               payload);
}

bool write_high_latency2(const View& view, ByteSpan payload) {
    const Flight& flight = view.flight;
    const Vector3& velocity = flight.estimate().velocity;
    const std::uint32_t mode = flight.mode().custom_mode;
    HighLatency2 message{.timestamp = boot_ms(view),
                         .type = view.firmware.mav_type_of(view.options.body.copter),
                         .autopilot = view.firmware.mav_autopilot(),
                         .custom_mode = static_cast<std::uint16_t>(view.firmware.is_px4() ? mode >> 16 : mode),
                         .heading = to_half_degrees(flight.estimate().heading),
                         .throttle = saturated<std::uint8_t>(flight.armed() ? 100 * flight.plant().thrust() : 0),
                         .airspeed = to_fifths(airspeed_of(view)),
                         .groundspeed = to_fifths(flight::math::hypot(velocity.x(), velocity.y())),
                         .windspeed = to_fifths(flight::math::hypot(flight.wind().x(), flight.wind().y())),
                         .wind_heading = to_half_degrees(flight::math::atan2(flight.wind().y(), flight.wind().x())),
                         .temperature_air = saturated<std::int8_t>(flight.sensors().imu().temperature_c),
                         .climb_rate = saturated<std::int8_t>(-10 * velocity.z()),
                         .battery = battery_on_wire(flight.battery()).percent,
                         .wp_num = flight.mission().current,
                         .failure_flags = high_latency_failures(view)};
    fill_position(view, message);
    fill_target(view, message);
    return put(message, payload);
}

}  // namespace mavloom::sim
