// SPDX-License-Identifier: MIT
// Source: MAVLink guide, "Open Drone ID". Values that a field leaves open are those of PX4 1.17.
#include "flight/physics/math.hpp"
#include "flight/wire_units.hpp"
#include "mavloom/msg/enums/mav_odid_hor_acc.hpp"
#include "mavloom/msg/enums/mav_odid_speed_acc.hpp"
#include "mavloom/msg/enums/mav_odid_status.hpp"
#include "mavloom/msg/enums/mav_odid_ver_acc.hpp"
#include "mavloom/msg/open_drone_id_location.hpp"
#include "mavloom/msg/open_drone_id_system.hpp"
#include "sim/telemetry/projections.hpp"

namespace mavloom::sim {

namespace {

using namespace msg;

// Seconds after the full hour in UTC, with tenths; 0xffff is unknown.
float seconds_of_hour(const View& view) noexcept {
    if (!view.has_utc) return 65535;
    const auto tenths = view.utc.time_since_epoch() / std::chrono::milliseconds{100};
    return static_cast<float>(tenths % 36000) / 10;
}

void fill_fix_motion(const View& view, OpenDroneIdLocation& message) {
    const GpsFix& fix = view.flight.sensors().gps();
    const GeoPoint position = view.flight.frame().to_geo(fix.position);
    const double course = wrap_2pi(flight::math::atan2(fix.velocity.y(), fix.velocity.x()));
    message.direction = static_cast<std::uint16_t>(100 * to_whole_degrees(course));
    message.speed_horizontal = saturated<std::uint16_t>(100 * flight::math::hypot(fix.velocity.x(), fix.velocity.y()));
    message.speed_vertical = to_cm_s(-fix.velocity.z());
    message.latitude = to_degrees_e7(position.latitude);
    message.longitude = to_degrees_e7(position.longitude);
    message.altitude_geodetic = as_float(std::round(position.altitude));
}

}  // namespace

bool write_open_drone_id_location(const View& view, ByteSpan payload) {
    if (!view.flight.sensors().has_position()) return false;
    const bool is_grounded = view.flight.landed() == LandedState::on_ground;
    OpenDroneIdLocation message{.status = is_grounded ? MAV_ODID_STATUS_GROUND : MAV_ODID_STATUS_AIRBORNE,
                                .altitude_barometric = as_float(view.flight.sensors().imu().pressure_altitude),
                                .height = as_float(relative_altitude_of(view)),
                                .horizontal_accuracy = MAV_ODID_HOR_ACC_1_METER,
                                .vertical_accuracy = MAV_ODID_VER_ACC_3_METER,
                                .speed_accuracy = MAV_ODID_SPEED_ACC_1_METERS_PER_SECOND,
                                .timestamp = seconds_of_hour(view)};
    fill_fix_motion(view, message);
    return put(message, payload);
}

// The operator stands at home.
bool write_open_drone_id_system(const View& view, ByteSpan payload) {
    constexpr float unknown_altitude = -1000;
    const auto& home = view.flight.home();
    if (!home) return false;
    return put(OpenDroneIdSystem{.operator_latitude = to_degrees_e7(home->latitude),
                                 .operator_longitude = to_degrees_e7(home->longitude),
                                 .area_count = 1,
                                 .area_ceiling = unknown_altitude,
                                 .area_floor = unknown_altitude,
                                 .operator_altitude_geo = as_float(home->altitude)},
               payload);
}

}  // namespace mavloom::sim
