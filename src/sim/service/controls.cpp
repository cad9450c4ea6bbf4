// SPDX-License-Identifier: MIT
#include "sim/service/controls.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "mavloom/msg/enums/attitude_target_typemask.hpp"
#include "mavloom/msg/enums/mav_frame.hpp"
#include "mavloom/msg/enums/position_target_typemask.hpp"
#include "mavloom/msg/follow_target.hpp"
#include "mavloom/msg/manual_control.hpp"
#include "mavloom/msg/rc_channels_override.hpp"
#include "mavloom/msg/set_actuator_control_target.hpp"
#include "mavloom/msg/set_attitude_target.hpp"
#include "mavloom/msg/set_gps_global_origin.hpp"
#include "mavloom/msg/set_home_position.hpp"
#include "mavloom/msg/set_position_target_global_int.hpp"
#include "mavloom/msg/set_position_target_local_ned.hpp"
#include "sim/command/placement.hpp"
#include "sim/parts.hpp"

namespace mavloom::sim {

namespace {

using namespace msg;

constexpr std::array control_messages{msg::ManualControl::id,
                                      RcChannelsOverride::id,
                                      SetPositionTargetLocalNed::id,
                                      SetPositionTargetGlobalInt::id,
                                      SetAttitudeTarget::id,
                                      SetActuatorControlTarget::id,
                                      FollowTarget::id,
                                      SetGpsGlobalOrigin::id,
                                      SetHomePosition::id};

// --- Set-points

// Both messages with position targets have these fields and this mask.
template <class Message>
OffboardSetpoint motion_of(const Message& m) noexcept {
    const auto field = [&](unsigned bit, float value) { return (m.type_mask & bit) != 0 ? nan : double{value}; };
    OffboardSetpoint setpoint;
    setpoint.velocity = {field(POSITION_TARGET_TYPEMASK_VX_IGNORE, m.vx),
                         field(POSITION_TARGET_TYPEMASK_VY_IGNORE, m.vy),
                         field(POSITION_TARGET_TYPEMASK_VZ_IGNORE, m.vz)};
    setpoint.acceleration = {field(POSITION_TARGET_TYPEMASK_AX_IGNORE, m.afx),
                             field(POSITION_TARGET_TYPEMASK_AY_IGNORE, m.afy),
                             field(POSITION_TARGET_TYPEMASK_AZ_IGNORE, m.afz)};
    setpoint.yaw = field(POSITION_TARGET_TYPEMASK_YAW_IGNORE, m.yaw);
    setpoint.yaw_rate = field(POSITION_TARGET_TYPEMASK_YAW_RATE_IGNORE, m.yaw_rate);
    return setpoint;
}

bool is_given(const Vector3& vector) noexcept { return !vector.array().isNaN().all(); }
bool is_whole(const Vector3& vector) noexcept { return !vector.array().isNaN().any(); }
bool has_infinity(const Vector3& vector) noexcept { return vector.array().isInf().any(); }

// Asks for something, and for nothing infinite.
bool is_valid_trajectory(const OffboardSetpoint& s) noexcept {
    const bool is_finite = !has_infinity(s.position) && !has_infinity(s.velocity) && !has_infinity(s.acceleration) &&
                           !std::isinf(s.yaw) && !std::isinf(s.yaw_rate);
    return is_finite && (is_given(s.position) || is_given(s.velocity) || is_given(s.acceleration));
}

// Only an acceleration can be a force. In masks that exclude the acceleration, clients set the bit without a meaning.
bool asks_for_force(unsigned mask, const OffboardSetpoint& s) noexcept {
    return (mask & POSITION_TARGET_TYPEMASK_FORCE_SET) != 0 && is_given(s.acceleration);
}

// Leaves out vectors of which the client excluded an axis.
void drop_incomplete(OffboardSetpoint& s) noexcept {
    for (Vector3* const vector : {&s.position, &s.velocity, &s.acceleration})
        if (!is_whole(*vector)) *vector = Vector3::Constant(nan);
}

// Turns a vector by the heading, from the body into the local frame. Clients of body frames mean a level body.
Vector3 turned(const Vector3& vector, double heading) noexcept {
    const double c = std::cos(heading), s = std::sin(heading);
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

// INT16_MAX marks an axis that the client does not have.
double axis(std::int16_t value) noexcept {
    return value == std::numeric_limits<std::int16_t>::max() ? nan : value / 1000.0;
}

}  // namespace

Controls::Controls(Parts& parts) noexcept : parts_(parts), rejected_(FlightTime::min() / 2) {}

std::span<const MessageId> Controls::handled() const noexcept { return control_messages; }

void Controls::receive(const Client& from, MessageId id, ByteView payload, Moment now) {
    if (id == msg::ManualControl::id) return on_manual_control(from, payload);
    if (id == RcChannelsOverride::id) return on_channels(from, payload);
    if (id == SetPositionTargetLocalNed::id) return on_local_target(payload, now);
    if (id == SetPositionTargetGlobalInt::id) return on_global_target(payload, now);
    if (id == SetAttitudeTarget::id) return on_attitude_target(payload, now);
    if (id == SetActuatorControlTarget::id) return on_actuator_target(payload, now);
    if (id == FollowTarget::id) return on_follow_target(payload);
    if (id == SetGpsGlobalOrigin::id) return on_origin(payload);
    on_home(payload);
}

// --- Sticks

bool Controls::may_steer(const Client& from) const noexcept {
    const Parameters& parameters = parts_.parameters;
    if (parts_.firmware.is_px4()) {
        const double source = parameters.get("COM_RC_IN_MODE", 1);
        constexpr double radio_only = 0, off = 4;
        return source != radio_only && source != off;
    }
    return parameters.get("SYSID_ENFORCE") == 0 || parameters.get("SYSID_MYGCS") == from.id.system.value;
}

void Controls::on_manual_control(const Client& from, ByteView payload) {
    const auto m = msg::ManualControl::decode(payload);
    if ((m.target != 0 && m.target != parts_.radio.system().value) || !may_steer(from)) return;
    const Sticks sticks{.pitch = axis(m.x), .roll = axis(m.y), .yaw = axis(m.r), .throttle = axis(m.z)};
    const bool has_no_axis = std::isnan(sticks.pitch) && std::isnan(sticks.roll) && std::isnan(sticks.yaw) &&
                             std::isnan(sticks.throttle);
    if (!has_no_axis) parts_.flight.on_sticks(sticks);
}

// UINT16_MAX keeps a channel. 0 gives it back to the remote control; for channels 9 and more, 0 keeps it, too, and
// UINT16_MAX - 1 gives it back. The simulated remote control stands in its middle.
void Controls::on_channels(const Client& from, ByteView payload) {
    if (parts_.firmware.is_px4() || !may_steer(from)) return;
    const auto m = RcChannelsOverride::decode(payload);
    const std::array given{m.chan1_raw,  m.chan2_raw,  m.chan3_raw,  m.chan4_raw,  m.chan5_raw,  m.chan6_raw,
                           m.chan7_raw,  m.chan8_raw,  m.chan9_raw,  m.chan10_raw, m.chan11_raw, m.chan12_raw,
                           m.chan13_raw, m.chan14_raw, m.chan15_raw, m.chan16_raw, m.chan17_raw, m.chan18_raw};
    constexpr std::uint16_t keep = 0xffff, give_back = 0xfffe;
    constexpr std::size_t first_extended = 8;
    for (std::size_t i = 0; i < channel_count; ++i) {
        const bool is_extended = i >= first_extended;
        if (given[i] == keep || (is_extended && given[i] == 0)) continue;
        channels_[i] = is_extended && given[i] == give_back ? std::uint16_t{0} : given[i];
    }
    parts_.flight.on_sticks(sticks_of_channels());
}

// -1 to 1; nan: the channel is not overridden. The parameter `map` holds the channel's number.
double Controls::channel(std::string_view map) const noexcept {
    const double number = parts_.parameters.get(map, 1);
    const std::uint16_t pulse = channels_[static_cast<std::size_t>(std::clamp(number, 1.0, double{channel_count})) - 1];
    return pulse == 0 ? nan : (pulse - 1500.0) / 500;
}

// A long pulse on the pitch channel lifts the nose, so that the stick is back.
Sticks Controls::sticks_of_channels() const noexcept {
    return {.pitch = -channel("RCMAP_PITCH"),
            .roll = channel("RCMAP_ROLL"),
            .yaw = channel("RCMAP_YAW"),
            .throttle = (channel("RCMAP_THROTTLE") + 1) / 2};
}

// --- Set-points

void Controls::reject(std::string_view message, Moment now) {
    if (now.flight - rejected_ < std::chrono::seconds{1}) return;
    rejected_ = now.flight;
    parts_.on_text(Severity::error, std::string(message) + " invalid");
}

// ArduPilot's copters obey a vector only if all its axes are there.
bool Controls::needs_all_axes() const noexcept {
    return !parts_.firmware.is_px4() && parts_.options.kind == Kind::quad;
}

// ArduPilot's rovers turn on the spot by a heading or a rate alone.
void Controls::complete(OffboardSetpoint& setpoint) const noexcept {
    if (needs_all_axes()) drop_incomplete(setpoint);
    const bool turns = !std::isnan(setpoint.yaw) || !std::isnan(setpoint.yaw_rate);
    const bool is_turn = turns && !is_given(setpoint.position) && !is_given(setpoint.velocity);
    if (is_turn && !parts_.firmware.is_px4() && parts_.options.kind == Kind::rover) setpoint.velocity.setZero();
}

// ArduPilot flies to a position that it got once. All else must be repeated.
void Controls::steer(OffboardSetpoint setpoint, std::string_view message, Moment now) {
    complete(setpoint);
    if (!is_valid_trajectory(setpoint)) return reject(message, now);
    const bool is_goal = is_whole(setpoint.position) && !is_given(setpoint.velocity) && !is_given(setpoint.acceleration);
    if (parts_.firmware.is_px4() || !is_goal) return parts_.flight.on_offboard(setpoint);
    constexpr double farthest = 1e6;  // m; farther away, the frame has no meaning
    if (!(setpoint.position.norm() < farthest)) return reject(message, now);
    const GeoPoint goal = parts_.flight.frame().to_geo(setpoint.position);
    (void)parts_.flight.reposition({.latitude = goal.latitude,
                                    .longitude = goal.longitude,
                                    .altitude = goal.altitude,
                                    .yaw = setpoint.yaw,
                                    .may_change_mode = false});
}

// Frames with an offset count from where the vehicle is. In BODY_NED, PX4 takes no position, and needs all axes of the
// rest; for ArduPilot it is BODY_OFFSET_NED. A yaw in ArduPilot's body frames is relative.
void Controls::on_local_target(ByteView payload, Moment now) {
    const auto m = SetPositionTargetLocalNed::decode(payload);
    const auto field = [&](unsigned bit, float value) { return (m.type_mask & bit) != 0 ? nan : double{value}; };
    OffboardSetpoint setpoint = motion_of(m);
    if (needs_all_axes()) drop_incomplete(setpoint);
    setpoint.position = {field(POSITION_TARGET_TYPEMASK_X_IGNORE, m.x), field(POSITION_TARGET_TYPEMASK_Y_IGNORE, m.y),
                         field(POSITION_TARGET_TYPEMASK_Z_IGNORE, m.z)};
    const bool is_px4 = parts_.firmware.is_px4();
    if (!is_local_frame(m.coordinate_frame) || asks_for_force(m.type_mask, setpoint))
        return reject(SetPositionTargetLocalNed::name, now);
    const Estimate& estimate = parts_.flight.estimate();
    if (is_px4 && m.coordinate_frame == MAV_FRAME_BODY_NED) {
        setpoint.position.setConstant(nan);
        drop_incomplete(setpoint);
    }
    if (is_body_frame(m.coordinate_frame)) {
        for (Vector3* const vector : {&setpoint.position, &setpoint.velocity, &setpoint.acceleration})
            *vector = turned(*vector, estimate.euler.yaw);
        if (!is_px4) setpoint.yaw += estimate.euler.yaw;
    }
    if (m.coordinate_frame != MAV_FRAME_LOCAL_NED) setpoint.position += estimate.position;
    steer(setpoint, SetPositionTargetLocalNed::name, now);
}

void Controls::on_global_target(ByteView payload, Moment now) {
    const auto m = SetPositionTargetGlobalInt::decode(payload);
    constexpr unsigned no_place = POSITION_TARGET_TYPEMASK_X_IGNORE | POSITION_TARGET_TYPEMASK_Y_IGNORE;
    OffboardSetpoint setpoint = motion_of(m);
    if (needs_all_axes()) drop_incomplete(setpoint);
    const bool has_place = (m.type_mask & no_place) == 0;
    const bool has_height = (m.type_mask & POSITION_TARGET_TYPEMASK_Z_IGNORE) == 0 && !std::isnan(m.alt);
    const Command place{.x = from_degrees_e7(m.lat_int),
                        .y = from_degrees_e7(m.lon_int),
                        .z = double{m.alt},
                        .frame = m.coordinate_frame};
    const bool is_on_earth = std::abs(place.x) <= 90 && std::abs(place.y) <= 180;
    const bool has_unknown_frame = (has_place || has_height) && !has_global_frame(place);
    if (has_unknown_frame || asks_for_force(m.type_mask, setpoint) || (has_place && !is_on_earth) ||
        (has_height && std::isinf(m.alt)))
        return reject(SetPositionTargetGlobalInt::name, now);
    const LocalFrame& frame = parts_.flight.frame();
    if (has_place) setpoint.position.head<2>() = frame.to_local({place.x, place.y, 0}).head<2>();
    if (has_height) setpoint.position.z() = frame.origin().altitude - altitude_of(place, parts_);
    if (parts_.firmware.is_px4() && !is_whole(setpoint.position)) setpoint.position.setConstant(nan);
    steer(setpoint, SetPositionTargetGlobalInt::name, now);
}

// Without an attitude, rates of roll and pitch must be there. A thrust is always needed.
void Controls::on_attitude_target(ByteView payload, Moment now) {
    const auto m = SetAttitudeTarget::decode(payload);
    const auto ignores = [&](unsigned bit) { return (m.type_mask & bit) != 0; };
    const auto rate = [&](unsigned bit, float value) { return ignores(bit) ? nan : double{value}; };
    OffboardSetpoint setpoint{.steering = Steering::attitude, .thrust = double{m.thrust}};
    setpoint.rates = {rate(ATTITUDE_TARGET_TYPEMASK_BODY_ROLL_RATE_IGNORE, m.body_roll_rate),
                      rate(ATTITUDE_TARGET_TYPEMASK_BODY_PITCH_RATE_IGNORE, m.body_pitch_rate),
                      rate(ATTITUDE_TARGET_TYPEMASK_BODY_YAW_RATE_IGNORE, m.body_yaw_rate)};
    setpoint.yaw_rate = setpoint.rates.z();
    const auto& q = m.q;
    setpoint.attitude = Quaternion(double{q[0]}, double{q[1]}, double{q[2]}, double{q[3]});
    bool is_valid = !ignores(ATTITUDE_TARGET_TYPEMASK_THROTTLE_IGNORE) && std::isfinite(m.thrust) &&
                    !has_infinity(setpoint.rates);
    if (ignores(ATTITUDE_TARGET_TYPEMASK_ATTITUDE_IGNORE)) {
        setpoint.steering = Steering::rates;
        setpoint.attitude = Quaternion::Identity();
        is_valid = is_valid && !setpoint.rates.head<2>().array().isNaN().any();
    } else {
        constexpr double smallest = 0.1;
        const double length = setpoint.attitude.norm();
        is_valid = is_valid && std::isfinite(length) && length > smallest;
    }
    if (!is_valid) return reject(SetAttitudeTarget::name, now);
    parts_.flight.on_offboard(setpoint);
}

// Group 0 holds roll, pitch, yaw and thrust.
void Controls::on_actuator_target(ByteView payload, Moment now) {
    const auto m = SetActuatorControlTarget::decode(payload);
    if (!parts_.firmware.is_px4() || m.group_mlx != 0) return;
    OffboardSetpoint setpoint{.steering = Steering::actuators};
    for (std::size_t i = 0; i < setpoint.mixer.size(); ++i) setpoint.mixer[i] = double{m.controls[i]};
    const bool is_finite = std::ranges::all_of(setpoint.mixer, [](double value) { return std::isfinite(value); });
    if (!is_finite) return reject(SetActuatorControlTarget::name, now);
    parts_.flight.on_offboard(setpoint);
}

// --- The rest

void Controls::on_follow_target(ByteView payload) {
    const auto m = FollowTarget::decode(payload);
    parts_.flight.on_target({from_degrees_e7(m.lat), from_degrees_e7(m.lon), double{m.alt}},
                            {double{m.vel[0]}, double{m.vel[1]}, double{m.vel[2]}});
}

void Controls::on_origin(ByteView payload) {
    const auto m = SetGpsGlobalOrigin::decode(payload);
    (void)set_global_origin(parts_, {from_degrees_e7(m.latitude), from_degrees_e7(m.longitude), m.altitude * 1e-3});
}

void Controls::on_home(ByteView payload) {
    const auto m = SetHomePosition::decode(payload);
    const GeoPoint home{from_degrees_e7(m.latitude), from_degrees_e7(m.longitude), m.altitude * 1e-3};
    if (!parts_.firmware.is_px4()) (void)parts_.flight.set_home(home, nan);
}

}  // namespace mavloom::sim
