// SPDX-License-Identifier: MIT
#include "flight/physics/math.hpp"
#include "flight/wire_units.hpp"
#include "mavloom/msg/altitude.hpp"
#include "mavloom/msg/global_position_int.hpp"
#include "mavloom/msg/gps_global_origin.hpp"
#include "mavloom/msg/home_position.hpp"
#include "mavloom/msg/local_position_ned.hpp"
#include "mavloom/msg/vfr_hud.hpp"
#include "sim/telemetry/projections.hpp"

namespace mavloom::sim {

// A multicopter or rover has no airspeed sensor; it reports its ground speed, so that displays show a number.
double airspeed_of(const View& view) noexcept {
    const Vector3& velocity = view.flight.estimate().velocity;
    if (view.options.kind == Kind::plane) return view.flight.plant().air_velocity().norm();
    return flight::math::hypot(velocity.x(), velocity.y());
}

double height_of(const View& view) {
    return std::max(view.flight.position().altitude - view.flight.ground_altitude(), 0.0);
}

double relative_altitude_of(const View& view) { return view.flight.position().altitude - view.flight.home_altitude(); }

bool write_local_position_ned(const View& view, ByteSpan payload) {
    if (!view.flight.has_origin()) return false;
    const Estimate& estimate = view.flight.estimate();
    return put(msg::LocalPositionNed{.time_boot_ms = boot_ms(view),
                                     .x = as_float(estimate.position.x()),
                                     .y = as_float(estimate.position.y()),
                                     .z = as_float(estimate.position.z()),
                                     .vx = as_float(estimate.velocity.x()),
                                     .vy = as_float(estimate.velocity.y()),
                                     .vz = as_float(estimate.velocity.z())},
               payload);
}

bool write_global_position_int(const View& view, ByteSpan payload) {
    if (!view.flight.has_origin()) return false;
    const Estimate& estimate = view.flight.estimate();
    const GeoPoint& position = view.flight.position();
    const std::int32_t altitude = to_mm(position.altitude);
    return put(msg::GlobalPositionInt{.time_boot_ms = boot_ms(view),
                                      .lat = to_degrees_e7(position.latitude),
                                      .lon = to_degrees_e7(position.longitude),
                                      .alt = altitude,
                                      .relative_alt = altitude - to_mm(view.flight.home_altitude()),
                                      .vx = to_cm_s(estimate.velocity.x()),
                                      .vy = to_cm_s(estimate.velocity.y()),
                                      .vz = to_cm_s(estimate.velocity.z()),
                                      .hdg = to_centidegrees(estimate.heading)},
               payload);
}

bool write_gps_global_origin(const View& view, ByteSpan payload) {
    if (!view.flight.has_origin()) return false;
    const GeoPoint& origin = view.flight.frame().origin();
    return put(msg::GpsGlobalOrigin{.latitude = to_degrees_e7(origin.latitude),
                                    .longitude = to_degrees_e7(origin.longitude),
                                    .altitude = to_mm(origin.altitude),
                                    .time_usec = boot_us(view)},
               payload);
}

bool write_home_position(const View& view, ByteSpan payload) {
    const auto& home = view.flight.home();
    if (!home) return false;
    const Vector3 local = view.flight.frame().to_local(*home);
    const double half_yaw = wrap_pi(view.flight.home_yaw()) / 2;
    return put(
        msg::HomePosition{.latitude = to_degrees_e7(home->latitude),
                          .longitude = to_degrees_e7(home->longitude),
                          .altitude = to_mm(home->altitude),
                          .x = as_float(local.x()),
                          .y = as_float(local.y()),
                          .z = as_float(local.z()),
                          .q = {as_float(flight::math::cos(half_yaw)), 0, 0, as_float(flight::math::sin(half_yaw))},
                          .time_usec = boot_us(view)},
        payload);
}

bool write_vfr_hud(const View& view, ByteSpan payload) {
    const Flight& flight = view.flight;
    const Vector3& velocity = flight.estimate().velocity;
    return put(msg::VfrHud{.airspeed = as_float(airspeed_of(view)),
                           .groundspeed = as_float(flight::math::hypot(velocity.x(), velocity.y())),
                           .heading = static_cast<std::int16_t>(to_whole_degrees(flight.estimate().heading)),
                           .throttle = saturated<std::uint16_t>(flight.armed() ? 100 * flight.plant().thrust() : 0),
                           .alt = as_float(flight.position().altitude),
                           .climb = as_float(-velocity.z())},
               payload);
}

bool write_altitude(const View& view, ByteSpan payload) {
    const Flight& flight = view.flight;
    const double ground = flight.ground_altitude() - flight.frame().origin().altitude;
    return put(msg::Altitude{.time_usec = boot_us(view),
                             .altitude_monotonic = as_float(flight.sensors().imu().pressure_altitude),
                             .altitude_amsl = as_float(flight.position().altitude),
                             .altitude_local = as_float(-flight.estimate().position.z()),
                             .altitude_relative = as_float(relative_altitude_of(view)),
                             .altitude_terrain = as_float(ground),
                             .bottom_clearance = as_float(height_of(view))},
               payload);
}

}  // namespace mavloom::sim
