// SPDX-License-Identifier: MIT
#include "sim/control/setpoint_fields.hpp"

#include <cmath>

#include "flight/physics/math.hpp"
#include "mavloom/msg/enums/attitude_target_typemask.hpp"
#include "mavloom/msg/enums/mav_frame.hpp"
#include "sim/command/positions.hpp"

namespace mavloom::sim {

using namespace msg;

OffboardSetpoint attitude_of(const SetAttitudeTarget& m) noexcept {
    const bool has_attitude = (m.type_mask & ATTITUDE_TARGET_TYPEMASK_ATTITUDE_IGNORE) == 0;
    OffboardSetpoint setpoint{.steering = has_attitude ? Steering::attitude : Steering::rates,
                              .thrust = field(m.type_mask, ATTITUDE_TARGET_TYPEMASK_THROTTLE_IGNORE, m.thrust)};
    setpoint.rates = {field(m.type_mask, ATTITUDE_TARGET_TYPEMASK_BODY_ROLL_RATE_IGNORE, m.body_roll_rate),
                      field(m.type_mask, ATTITUDE_TARGET_TYPEMASK_BODY_PITCH_RATE_IGNORE, m.body_pitch_rate),
                      field(m.type_mask, ATTITUDE_TARGET_TYPEMASK_BODY_YAW_RATE_IGNORE, m.body_yaw_rate)};
    setpoint.yaw_rate = setpoint.rates.z();
    const auto& q = m.q;
    if (has_attitude) setpoint.attitude = Quaternion(double{q[0]}, double{q[1]}, double{q[2]}, double{q[3]});
    return setpoint;
}

Vector3 local_position_of(const SetPositionTargetGlobalInt& m, const Flight& flight) {
    const Command place{.x = from_degrees_e7(m.lat_int),
                        .y = from_degrees_e7(m.lon_int),
                        .z = double{m.alt},
                        .frame = m.coordinate_frame};
    const LocalFrame& frame = flight.frame();
    Vector3 local(nan, nan, frame.origin().altitude - altitude_of(place, flight));
    if (std::abs(place.x) <= 90 && std::abs(place.y) <= 180)
        local.head<2>() = frame.to_local({place.x, place.y, 0}).head<2>();
    return local;
}

Vector3 turned(const Vector3& vector, double heading) noexcept {
    const double c = flight::math::cos(heading), s = flight::math::sin(heading);
    const bool is_flat = !std::isnan(vector.x()) && !std::isnan(vector.y());
    if (!is_flat) return {nan, nan, vector.z()};
    return {c * vector.x() - s * vector.y(), s * vector.x() + c * vector.y(), vector.z()};
}

bool is_body_frame(std::uint8_t frame) noexcept {
    return frame == MAV_FRAME_BODY_NED || frame == MAV_FRAME_BODY_OFFSET_NED;
}

bool is_local_frame(std::uint8_t frame) noexcept {
    return frame == MAV_FRAME_LOCAL_NED || frame == MAV_FRAME_LOCAL_OFFSET_NED || is_body_frame(frame);
}

}  // namespace mavloom::sim
