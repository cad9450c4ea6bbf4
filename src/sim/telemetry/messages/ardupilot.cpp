// SPDX-License-Identifier: MIT
// Messages that only ArduPilot sends. Source: MAVLink ardupilotmega.xml.
#include "flight/physics/math.hpp"
#include "flight/wire_units.hpp"
#include "mavloom/msg/ahrs.hpp"
#include "mavloom/msg/ahrs2.hpp"
#include "mavloom/msg/fence_status.hpp"
#include "mavloom/msg/hwstatus.hpp"
#include "mavloom/msg/mcu_status.hpp"
#include "mavloom/msg/meminfo.hpp"
#include "mavloom/msg/power_status.hpp"
#include "mavloom/msg/rangefinder.hpp"
#include "mavloom/msg/simstate.hpp"
#include "mavloom/msg/terrain_report.hpp"
#include "mavloom/msg/wind.hpp"
#include "sim/telemetry/projections.hpp"

namespace mavloom::sim {

namespace {

constexpr std::uint16_t board_millivolts = 5000;

}  // namespace

bool write_ahrs(const View& /*view*/, ByteSpan payload) {
    return put(msg::Ahrs{.error_rp = 0.002f, .error_yaw = 0.001f}, payload);
}

// The second estimate of attitude and position.
bool write_ahrs2(const View& view, ByteSpan payload) {
    const Euler& euler = view.flight.estimate().euler;
    const GeoPoint& position = view.flight.position();
    return put(msg::Ahrs2{.roll = as_float(euler.roll),
                          .pitch = as_float(euler.pitch),
                          .yaw = as_float(euler.yaw),
                          .altitude = as_float(position.altitude),
                          .lat = to_degrees_e7(position.latitude),
                          .lng = to_degrees_e7(position.longitude)},
               payload);
}

// The true motion.
bool write_simstate(const View& view, ByteSpan payload) {
    const Kinematics& truth = view.flight.truth();
    const Euler euler = to_euler(truth.attitude);
    const Vector3 force = truth.attitude.conjugate() * (truth.acceleration - Vector3(0, 0, gravity));
    const GeoPoint position = view.flight.frame().to_geo(truth.position);
    return put(msg::Simstate{.roll = as_float(euler.roll),
                             .pitch = as_float(euler.pitch),
                             .yaw = as_float(euler.yaw),
                             .xacc = as_float(force.x()),
                             .yacc = as_float(force.y()),
                             .zacc = as_float(force.z()),
                             .xgyro = as_float(truth.rates.x()),
                             .ygyro = as_float(truth.rates.y()),
                             .zgyro = as_float(truth.rates.z()),
                             .lat = to_degrees_e7(position.latitude),
                             .lng = to_degrees_e7(position.longitude)},
               payload);
}

bool write_meminfo(const View& /*view*/, ByteSpan payload) {
    return put(msg::Meminfo{.freemem = 0xffff, .freemem32 = 131'072}, payload);
}

bool write_power_status(const View& /*view*/, ByteSpan payload) {
    return put(msg::PowerStatus{.Vcc = board_millivolts}, payload);
}

bool write_hwstatus(const View& /*view*/, ByteSpan payload) {
    return put(msg::Hwstatus{.Vcc = board_millivolts}, payload);
}

// `direction` is the one that the wind comes from.
bool write_wind(const View& view, ByteSpan payload) {
    const Vector3& wind = view.flight.wind();
    const double from = wrap_2pi(flight::math::atan2(-wind.y(), -wind.x()));
    const double speed = flight::math::hypot(wind.x(), wind.y());
    return put(msg::Wind{.direction = as_float(speed > 0 ? to_degrees(from) : 0),
                         .speed = as_float(speed),
                         .speed_z = as_float(wind.z())},
               payload);
}

bool write_fence_status(const View& /*view*/, ByteSpan payload) { return put(msg::FenceStatus{}, payload); }

// Flat ground; all of its grid is loaded.
bool write_terrain_report(const View& view, ByteSpan payload) {
    if (!view.flight.has_origin()) return false;
    const GeoPoint& position = view.flight.position();
    return put(msg::TerrainReport{.lat = to_degrees_e7(position.latitude),
                                  .lon = to_degrees_e7(position.longitude),
                                  .spacing = 100,
                                  .terrain_height = as_float(view.flight.ground_altitude()),
                                  .current_height = as_float(position.altitude - view.flight.ground_altitude()),
                                  .loaded = 504},
               payload);
}

bool write_rangefinder(const View& view, ByteSpan payload) {
    return put(msg::Rangefinder{.distance = as_float(height_of(view))}, payload);
}

bool write_mcu_status(const View& /*view*/, ByteSpan payload) {
    return put(msg::McuStatus{.MCU_temperature = 4500,
                              .MCU_voltage = board_millivolts,
                              .MCU_voltage_min = board_millivolts,
                              .MCU_voltage_max = board_millivolts},
               payload);
}

}  // namespace mavloom::sim
