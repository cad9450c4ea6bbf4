// SPDX-License-Identifier: MIT
#include "sim/control/ardupilot_setpoints.hpp"

#include <fmt/format.h>

#include <cmath>

#include "flight/physics/math.hpp"
#include "mavloom/msg/enums/mav_frame.hpp"
#include "sim/command/positions.hpp"
#include "sim/control/setpoint_fields.hpp"

namespace mavloom::sim {

namespace {

using namespace msg;

constexpr unsigned no_x = POSITION_TARGET_TYPEMASK_X_IGNORE, no_y = POSITION_TARGET_TYPEMASK_Y_IGNORE,
                   no_z = POSITION_TARGET_TYPEMASK_Z_IGNORE, no_vx = POSITION_TARGET_TYPEMASK_VX_IGNORE,
                   no_vy = POSITION_TARGET_TYPEMASK_VY_IGNORE, no_vz = POSITION_TARGET_TYPEMASK_VZ_IGNORE,
                   no_acceleration = POSITION_TARGET_TYPEMASK_AX_IGNORE | POSITION_TARGET_TYPEMASK_AY_IGNORE |
                                     POSITION_TARGET_TYPEMASK_AZ_IGNORE,
                   no_yaw = POSITION_TARGET_TYPEMASK_YAW_IGNORE, no_yaw_rate = POSITION_TARGET_TYPEMASK_YAW_RATE_IGNORE;

// A vector counts as given only if the mask excludes none of its axes. For rovers, vectors have no vertical axis.
constexpr bool has(unsigned mask, unsigned none_of) noexcept { return (mask & none_of) == 0; }

bool is_sane(const Vector3& vector) noexcept { return (vector.array().abs() <= 1000).all(); }  // m/s or m/s^2
// Farther away, the local frame has no meaning. False for a place that is not on earth.
bool is_place(const Vector3& place) noexcept { return place.norm() < 1e6; }

template <class Message>
OffboardSetpoint all_of(Message m) noexcept {
    m.type_mask = 0;
    return motion_of(m);
}

Vector3 ahead(double heading, double speed) noexcept {
    return {speed * flight::math::cos(heading), speed * flight::math::sin(heading), 0};
}

}  // namespace

bool ArdupilotSetpoints::is_guided() const noexcept { return flight_.mode().behaviour == Behaviour::offboard; }

void ArdupilotSetpoints::on_local_target(ByteView payload) {
    const auto m = SetPositionTargetLocalNed::decode(payload);
    if (!is_guided()) return;
    if (kind_ == Kind::plane) return climb_by(m);
    obey(target_of(m));
}

void ArdupilotSetpoints::on_global_target(ByteView payload) {
    const auto m = SetPositionTargetGlobalInt::decode(payload);
    if (!is_guided()) return;
    if (kind_ == Kind::plane) return climb_to(m);
    Target target{.mask = m.type_mask,
                  .has_known_frame = is_global_frame(m.coordinate_frame),
                  .needs_frame = has(m.type_mask, no_x | no_y | no_z),
                  .is_above_terrain = is_terrain_frame(m.coordinate_frame),
                  .is_backwards = m.vx < 0,
                  .setpoint = all_of(m)};
    target.setpoint.position = local_position_of(m, flight_);
    obey(target);
}

// Frames with an offset count from where the vehicle is; BODY_NED is one of them. In frames of the body, a yaw counts
// from the present one.
ArdupilotSetpoints::Target ArdupilotSetpoints::target_of(const SetPositionTargetLocalNed& m) const {
    Target target{.mask = m.type_mask,
                  .has_known_frame = is_local_frame(m.coordinate_frame),
                  .is_backwards = m.vx < 0,
                  .setpoint = all_of(m)};
    OffboardSetpoint& setpoint = target.setpoint;
    setpoint.position = {double{m.x}, double{m.y}, double{m.z}};
    const Estimate& estimate = flight_.estimate();
    if (is_body_frame(m.coordinate_frame)) {
        for (Vector3* const vector : {&setpoint.position, &setpoint.velocity, &setpoint.acceleration})
            *vector = turned(*vector, estimate.euler.yaw);
        setpoint.yaw += estimate.euler.yaw;
    }
    if (m.coordinate_frame != MAV_FRAME_LOCAL_NED) setpoint.position += estimate.position;
    return target;
}

void ArdupilotSetpoints::obey(const Target& target) { kind_ == Kind::rover ? drive(target) : fly(target); }

// --- Copters

// A position alone is a goal, to be sent once. All else must be repeated. A yaw alone is not enough.
void ArdupilotSetpoints::fly(const Target& target) {
    const OffboardSetpoint& given = target.setpoint;
    const bool has_position = has(target.mask, no_x | no_y | no_z);
    const bool has_velocity = has(target.mask, no_vx | no_vy | no_vz);
    const bool has_acceleration = has(target.mask, no_acceleration);
    const bool is_force = has_acceleration && (target.mask & POSITION_TARGET_TYPEMASK_FORCE_SET) != 0;
    const bool is_goal = has_position && !has_velocity && !has_acceleration;
    const bool is_motion = has_velocity || (has_acceleration && !has_position);
    const bool is_flyable = (target.has_known_frame || !target.needs_frame) && !is_force &&
                            (!has_position || is_place(given.position)) && (!has_velocity || is_sane(given.velocity)) &&
                            (!has_acceleration || is_sane(given.acceleration)) &&
                            !(has_position && has_velocity && target.is_above_terrain);
    if (!is_flyable || (!is_goal && !is_motion)) return stop();
    const double yaw = has(target.mask, no_yaw) ? given.yaw : nan;
    if (is_goal) return go_to(given.position, yaw);
    OffboardSetpoint setpoint{.yaw = yaw, .yaw_rate = has(target.mask, no_yaw_rate) ? given.yaw_rate : nan};
    if (has_position) setpoint.position = given.position;
    if (has_velocity) setpoint.velocity = given.velocity;
    if (has_acceleration) setpoint.acceleration = given.acceleration;
    flight_.on_offboard(setpoint);
}

// --- Rovers

void ArdupilotSetpoints::drive(const Target& target) {
    if (!target.has_known_frame) return;
    if (!has(target.mask, no_x | no_y)) return steer_rover(target);
    Vector3 place = target.setpoint.position;
    place.z() = flight_.estimate().position.z();
    if (is_place(place)) go_to(place, nan);
}

// A speed with a heading or a turn rate, but not with both. Without a speed, the rover stands. It drives backwards only
// with a heading or a turn rate.
void ArdupilotSetpoints::steer_rover(const Target& target) {
    const OffboardSetpoint& given = target.setpoint;
    const bool has_velocity = has(target.mask, no_vx | no_vy), has_yaw = has(target.mask, no_yaw),
               has_rate = has(target.mask, no_yaw_rate), turns = has_yaw || has_rate;
    if (has(target.mask, no_acceleration) || (has_yaw && has_rate) || (!has_velocity && !turns)) return;
    const double length = has_velocity ? flight::math::hypot(given.velocity.x(), given.velocity.y()) : 0;
    const double heading = has_yaw ? given.yaw : flight_.estimate().euler.yaw;
    OffboardSetpoint setpoint{.yaw = has_yaw ? given.yaw : nan, .yaw_rate = has_rate ? given.yaw_rate : nan};
    setpoint.velocity = turns ? ahead(heading, target.is_backwards ? -length : length) : given.velocity;
    flight_.on_offboard(setpoint);
}

// --- Planes

// Of the frames, a plane knows this one only, and of the message only `z`, for any mask.
void ArdupilotSetpoints::climb_by(const SetPositionTargetLocalNed& m) {
    const auto& goal = flight_.target();
    if (m.coordinate_frame != MAV_FRAME_LOCAL_OFFSET_NED || !goal || !std::isfinite(m.z)) return;
    const double altitude = flight_.frame().origin().altitude - goal->position.z() - double{m.z};
    (void)flight_.change_altitude(altitude);
    observer_.on_text(Severity::info, fmt::format("Change alt to {:.1f}", altitude - flight_.home_altitude()));
}

void ArdupilotSetpoints::climb_to(const SetPositionTargetGlobalInt& m) {
    if (!is_global_frame(m.coordinate_frame))
        return observer_.on_text(Severity::warning, "Invalid coord frame in SET_POSTION_TARGET_GLOBAL_INT");
    if (!has(m.type_mask, no_z)) return;
    (void)flight_.change_altitude(flight_.frame().origin().altitude - local_position_of(m, flight_).z());
}

// --- Attitudes

// A copter takes the three rates together or not at all. A rover turns by the rate, or else to the heading.
void ArdupilotSetpoints::on_attitude_target(ByteView payload) {
    if (!is_guided()) return;
    OffboardSetpoint setpoint = attitude_of(SetAttitudeTarget::decode(payload));
    const bool has_rates = is_whole(setpoint.rates), is_copter = kind_ == Kind::quad;
    const bool is_unit = std::abs(setpoint.attitude.squaredNorm() - 1) < 1e-3;
    const bool is_valid = std::isfinite(setpoint.thrust) && is_unit && (has_rates || !has_any(setpoint.rates));
    if (is_copter && !is_valid) return stop();
    if (!std::isfinite(setpoint.thrust)) return;
    if (is_copter && !has_rates) setpoint.rates.setZero();
    if (kind_ == Kind::rover) setpoint.steering = std::isnan(setpoint.rates.z()) ? Steering::attitude : Steering::rates;
    flight_.on_offboard(setpoint);
}

// --- What the vehicle does

void ArdupilotSetpoints::go_to(const Vector3& place, double yaw) {
    const GeoPoint goal = flight_.frame().to_geo(place);
    (void)flight_.reposition({.latitude = goal.latitude,
                              .longitude = goal.longitude,
                              .altitude = goal.altitude,
                              .yaw = yaw,
                              .may_change_mode = false});
}

// An order to go nowhere stops the vehicle where it is.
void ArdupilotSetpoints::stop() { (void)flight_.reposition({.may_change_mode = false}); }

}  // namespace mavloom::sim
