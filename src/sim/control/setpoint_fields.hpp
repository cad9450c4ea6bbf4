// SPDX-License-Identifier: MIT
// The fields of set-points, as both firmwares read them from messages. Private to module sim; functions.
#pragma once

#include "flight/flight.hpp"
#include "flight/orders.hpp"
#include "mavloom/msg/enums/position_target_typemask.hpp"
#include "mavloom/msg/set_attitude_target.hpp"
#include "mavloom/msg/set_position_target_global_int.hpp"
#include "mavloom/sim/flight.hpp"

namespace mavloom::sim {

[[nodiscard]] inline double field(unsigned mask, unsigned bit, float value) noexcept {
    return (mask & bit) != 0 ? nan : double{value};
}

// Velocity, acceleration and yaw. Both messages with position targets have these fields and this mask. Excluded
// fields are `nan`.
template <class Message>
[[nodiscard]] OffboardSetpoint motion_of(const Message& m) noexcept {
    OffboardSetpoint setpoint;
    setpoint.velocity = {field(m.type_mask, msg::POSITION_TARGET_TYPEMASK_VX_IGNORE, m.vx),
                         field(m.type_mask, msg::POSITION_TARGET_TYPEMASK_VY_IGNORE, m.vy),
                         field(m.type_mask, msg::POSITION_TARGET_TYPEMASK_VZ_IGNORE, m.vz)};
    setpoint.acceleration = {field(m.type_mask, msg::POSITION_TARGET_TYPEMASK_AX_IGNORE, m.afx),
                             field(m.type_mask, msg::POSITION_TARGET_TYPEMASK_AY_IGNORE, m.afy),
                             field(m.type_mask, msg::POSITION_TARGET_TYPEMASK_AZ_IGNORE, m.afz)};
    setpoint.yaw = field(m.type_mask, msg::POSITION_TARGET_TYPEMASK_YAW_IGNORE, m.yaw);
    setpoint.yaw_rate = field(m.type_mask, msg::POSITION_TARGET_TYPEMASK_YAW_RATE_IGNORE, m.yaw_rate);
    return setpoint;
}
// Attitude, rates and thrust. Without an attitude, the set-point steers by the rates.
[[nodiscard]] OffboardSetpoint attitude_of(const msg::SetAttitudeTarget& m) noexcept;
// The place in the vehicle's local frame, whether the mask excludes it or not. `nan`: there is no such place.
[[nodiscard]] Vector3 local_position_of(const msg::SetPositionTargetGlobalInt& m, const Flight& flight);

[[nodiscard]] inline bool is_whole(const Vector3& vector) noexcept { return !vector.array().isNaN().any(); }
[[nodiscard]] inline bool has_infinity(const Vector3& vector) noexcept { return vector.array().isInf().any(); }

// Turns a vector by the heading, from the body into the local frame. Clients of body frames mean a level body.
[[nodiscard]] Vector3 turned(const Vector3& vector, double heading) noexcept;
// Frames of SET_POSITION_TARGET_LOCAL_NED.
[[nodiscard]] bool is_body_frame(std::uint8_t frame) noexcept;
[[nodiscard]] bool is_local_frame(std::uint8_t frame) noexcept;

}  // namespace mavloom::sim
