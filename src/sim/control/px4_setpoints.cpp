// SPDX-License-Identifier: MIT
#include "sim/control/px4_setpoints.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "mavloom/msg/enums/mav_frame.hpp"
#include "mavloom/msg/set_actuator_control_target.hpp"
#include "mavloom/msg/set_position_target_local_ned.hpp"
#include "sim/command/positions.hpp"
#include "sim/control/setpoint_fields.hpp"

namespace mavloom::sim {

namespace {

using namespace msg;

// Asks for something, and for nothing infinite.
bool is_valid_trajectory(const OffboardSetpoint& s) noexcept {
    const bool is_finite = !has_infinity(s.position) && !has_infinity(s.velocity) && !has_infinity(s.acceleration) &&
                           !std::isinf(s.yaw) && !std::isinf(s.yaw_rate);
    return is_finite && (has_any(s.position) || has_any(s.velocity) || has_any(s.acceleration));
}

// Only an acceleration can be a force. In masks that exclude the acceleration, clients set the bit without a meaning.
bool asks_for_force(unsigned mask, const OffboardSetpoint& s) noexcept {
    return (mask & POSITION_TARGET_TYPEMASK_FORCE_SET) != 0 && has_any(s.acceleration);
}

// In BODY_NED, PX4 takes no position, and needs all axes of the rest.
void drop_for_body(OffboardSetpoint& s) noexcept {
    s.position = no_vector;
    for (Vector3* const vector : {&s.velocity, &s.acceleration})
        if (!is_whole(*vector)) *vector = no_vector;
}

}  // namespace

void Px4Setpoints::reject(std::string_view message, Moment now) {
    if (texts_.spend(now.flight)) observer_.on_text(Severity::error, std::string(message) + " invalid");
}

void Px4Setpoints::follow(const OffboardSetpoint& setpoint, std::string_view message, Moment now) {
    if (!is_valid_trajectory(setpoint)) return reject(message, now);
    flight_.on_offboard(setpoint);
}

// Frames with an offset count from where the vehicle is.
void Px4Setpoints::on_local_target(ByteView payload, Moment now) {
    const auto m = SetPositionTargetLocalNed::decode(payload);
    OffboardSetpoint setpoint = motion_of(m);
    setpoint.position = {field(m.type_mask, POSITION_TARGET_TYPEMASK_X_IGNORE, m.x),
                         field(m.type_mask, POSITION_TARGET_TYPEMASK_Y_IGNORE, m.y),
                         field(m.type_mask, POSITION_TARGET_TYPEMASK_Z_IGNORE, m.z)};
    if (!is_local_frame(m.coordinate_frame) || asks_for_force(m.type_mask, setpoint))
        return reject(SetPositionTargetLocalNed::name, now);
    const Estimate& estimate = flight_.estimate();
    if (m.coordinate_frame == MAV_FRAME_BODY_NED) drop_for_body(setpoint);
    if (is_body_frame(m.coordinate_frame))
        for (Vector3* const vector : {&setpoint.position, &setpoint.velocity, &setpoint.acceleration})
            *vector = turned(*vector, estimate.euler.yaw);
    if (m.coordinate_frame != MAV_FRAME_LOCAL_NED) setpoint.position += estimate.position;
    follow(setpoint, SetPositionTargetLocalNed::name, now);
}

void Px4Setpoints::on_global_target(ByteView payload, Moment now) {
    const auto m = SetPositionTargetGlobalInt::decode(payload);
    constexpr unsigned no_place = POSITION_TARGET_TYPEMASK_X_IGNORE | POSITION_TARGET_TYPEMASK_Y_IGNORE;
    OffboardSetpoint setpoint = motion_of(m);
    const bool has_place = (m.type_mask & no_place) == 0;
    const bool has_height = (m.type_mask & POSITION_TARGET_TYPEMASK_Z_IGNORE) == 0 && !std::isnan(m.alt);
    const Vector3 place = local_position_of(m, flight_);
    const bool has_unknown_frame = (has_place || has_height) && !is_global_frame(m.coordinate_frame);
    if (has_unknown_frame || asks_for_force(m.type_mask, setpoint) || (has_place && std::isnan(place.x())) ||
        (has_height && std::isinf(m.alt)))
        return reject(SetPositionTargetGlobalInt::name, now);
    if (has_place && has_height) setpoint.position = place;
    follow(setpoint, SetPositionTargetGlobalInt::name, now);
}

// Without an attitude, rates of roll and pitch must be there. A thrust is always needed.
void Px4Setpoints::on_attitude_target(ByteView payload, Moment now) {
    const OffboardSetpoint setpoint = attitude_of(SetAttitudeTarget::decode(payload));
    bool is_valid = std::isfinite(setpoint.thrust) && !has_infinity(setpoint.rates);
    if (setpoint.steering == Steering::rates) {
        is_valid = is_valid && !setpoint.rates.head<2>().array().isNaN().any();
    } else {
        constexpr double smallest = 0.1;
        const double length = setpoint.attitude.norm();
        is_valid = is_valid && std::isfinite(length) && length > smallest;
    }
    if (!is_valid) return reject(SetAttitudeTarget::name, now);
    flight_.on_offboard(setpoint);
}

// Group 0 holds roll, pitch, yaw and thrust.
void Px4Setpoints::on_actuator_target(ByteView payload, Moment now) {
    const auto m = SetActuatorControlTarget::decode(payload);
    if (m.group_mlx != 0) return;
    OffboardSetpoint setpoint{.steering = Steering::actuators};
    for (std::size_t i = 0; i < setpoint.mixer.size(); ++i) setpoint.mixer[i] = double{m.controls[i]};
    const bool is_finite = std::ranges::all_of(setpoint.mixer, [](double value) { return std::isfinite(value); });
    if (!is_finite) return reject(SetActuatorControlTarget::name, now);
    flight_.on_offboard(setpoint);
}

}  // namespace mavloom::sim
