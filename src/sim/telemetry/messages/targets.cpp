// SPDX-License-Identifier: MIT
#include "flight/physics/math.hpp"
#include "flight/wire_units.hpp"
#include "mavloom/msg/attitude_target.hpp"
#include "mavloom/msg/enums/mav_frame.hpp"
#include "mavloom/msg/enums/position_target_typemask.hpp"
#include "mavloom/msg/nav_controller_output.hpp"
#include "mavloom/msg/orbit_execution_status.hpp"
#include "mavloom/msg/position_target_global_int.hpp"
#include "mavloom/msg/position_target_local_ned.hpp"
#include "mavloom/msg/time_estimate_to_target.hpp"
#include "sim/telemetry/projections.hpp"

namespace mavloom::sim {

namespace {

using namespace msg;

// The goal of the position controller. NaN: not controlled.
struct Trajectory {
    Vector3 position = no_vector, velocity = no_vector, acceleration = no_vector;
    double yaw = nan, yaw_rate = nan;
};

// At rest PX4 reports no position and velocity, and an acceleration that presses the vehicle to the ground.
Trajectory at_rest(const Flight& flight) noexcept {
    return {.acceleration = {0, 0, 100}, .yaw = flight.estimate().euler.yaw, .yaw_rate = 0};
}

// Inner loops that move a point along the path report it; otherwise the goal itself is the target.
Trajectory trajectory_of(const Flight& flight) noexcept {
    const Setpoint& setpoint = flight.setpoint();
    const InnerTargets inner = flight.inner_targets();
    if (!flight.armed() || setpoint.steering == Steering::none) return at_rest(flight);
    const auto first = [](double a, double b, double c) { return !std::isnan(a) ? a : !std::isnan(b) ? b : c; };
    Trajectory trajectory{.position = inner.position,
                          .velocity = inner.velocity,
                          .acceleration = inner.acceleration,
                          .yaw = first(inner.yaw, setpoint.yaw, yaw_of(inner.attitude)),
                          .yaw_rate = first(inner.yaw_rate, setpoint.yaw_rate, 0)};
    if (inner.position.hasNaN() && setpoint.steering != Steering::circle) trajectory.position = setpoint.position;
    return trajectory;
}

// The bits of the fields that are NaN.
std::uint16_t ignored(const Trajectory& t) noexcept {
    unsigned mask = 0;
    const auto ignore = [&](double value, unsigned bit) { mask |= std::isnan(value) ? bit : 0; };
    unsigned bit = POSITION_TARGET_TYPEMASK_X_IGNORE;
    for (const Vector3* const part : {&t.position, &t.velocity, &t.acceleration})
        for (int axis = 0; axis < 3; ++axis, bit <<= 1) ignore((*part)[axis], bit);
    ignore(t.yaw, POSITION_TARGET_TYPEMASK_YAW_IGNORE);
    ignore(t.yaw_rate, POSITION_TARGET_TYPEMASK_YAW_RATE_IGNORE);
    return static_cast<std::uint16_t>(mask);
}

// The fields that both position targets have.
template <class Message>
void fill_trajectory(const Trajectory& trajectory, Message& message) noexcept {
    message.vx = as_float(trajectory.velocity.x());
    message.vy = as_float(trajectory.velocity.y());
    message.vz = as_float(trajectory.velocity.z());
    message.afx = as_float(trajectory.acceleration.x());
    message.afy = as_float(trajectory.acceleration.y());
    message.afz = as_float(trajectory.acceleration.z());
    message.yaw = as_float(trajectory.yaw);
    message.yaw_rate = as_float(trajectory.yaw_rate);
}

// Random motion has no goal. Such a vehicle reports where its velocity leads within 10 s.
std::optional<NavigationTarget> navigation_target(const View& view) noexcept {
    if (!view.flight.armed()) return std::nullopt;
    if (view.options.motion == Motion::flight || view.flight.target()) return view.flight.target();
    return NavigationTarget{view.flight.estimate().position + 10 * view.flight.estimate().velocity};
}

std::int16_t to_signed_degrees(double radians) noexcept {
    return saturated<std::int16_t>(to_degrees(wrap_pi(radians)));
}

// Seconds to climb to the return altitude, fly home, and land.
double seconds_to_return(const View& view) {
    const Flight& flight = view.flight;
    const Tuning& tuning = flight.tuning();
    const auto over = [](double way, double speed) { return way / std::max(speed, 0.1); };
    const Vector3 way = flight.frame().to_local(*flight.home()) - flight.estimate().position;
    const double altitude = relative_altitude_of(view);
    const double top = std::max(altitude, tuning.return_altitude);
    const double slow = std::min(tuning.land_slow_height, top);
    return over(top - altitude, tuning.climb_speed) + over(flight::math::hypot(way.x(), way.y()), tuning.cruise_speed) +
           over(top - slow, tuning.descent_speed) + over(slow, tuning.land_speed);
}

// Of PX4's controllers, only those of planes and rovers publish these values. Vehicles that move at random send all.
bool has_nav_controller(const View& view) noexcept {
    return !view.firmware.is_px4() || view.options.kind != Kind::quad || view.options.motion == Motion::random;
}

}  // namespace

// Disarmed, the controllers aim at level flight with the present heading.
bool write_attitude_target(const View& view, ByteSpan payload) {
    const Flight& flight = view.flight;
    const InnerTargets inner = flight.inner_targets();
    const double half_yaw = flight.estimate().euler.yaw / 2;
    const Quaternion level(flight::math::cos(half_yaw), 0, 0, flight::math::sin(half_yaw));
    const Vector3 rates = flight.armed() ? inner.rates : Vector3::Zero();
    return put(AttitudeTarget{.time_boot_ms = boot_ms(view),
                              .q = quaternion_on_wire(flight.armed() ? inner.attitude : level),
                              .body_roll_rate = as_float(rates.x()),
                              .body_pitch_rate = as_float(rates.y()),
                              .body_yaw_rate = as_float(rates.z()),
                              .thrust = flight.armed() ? as_float(inner.thrust) : 0.001f},
               payload);
}

bool write_position_target_local_ned(const View& view, ByteSpan payload) {
    const Steering steering = view.flight.setpoint().steering;
    if (view.flight.armed() && steering != Steering::none && !steers_by_path(steering)) return false;
    const Trajectory trajectory = trajectory_of(view.flight);
    PositionTargetLocalNed message{.time_boot_ms = boot_ms(view),
                                   .coordinate_frame = MAV_FRAME_LOCAL_NED,
                                   .type_mask = ignored(trajectory),
                                   .x = as_float(trajectory.position.x()),
                                   .y = as_float(trajectory.position.y()),
                                   .z = as_float(trajectory.position.z())};
    fill_trajectory(trajectory, message);
    return put(message, payload);
}

// The point that the vehicle navigates to. PX4 sets no bit of the mask.
bool write_position_target_global_int(const View& view, ByteSpan payload) {
    const auto target = navigation_target(view);
    if (!target) return false;
    const GeoPoint point = view.flight.frame().to_geo(target->position);
    PositionTargetGlobalInt message{.time_boot_ms = boot_ms(view),
                                    .coordinate_frame = MAV_FRAME_GLOBAL_INT,
                                    .lat_int = to_degrees_e7(point.latitude),
                                    .lon_int = to_degrees_e7(point.longitude),
                                    .alt = as_float(point.altitude)};
    fill_trajectory(trajectory_of(view.flight), message);
    return put(message, payload);
}

bool write_nav_controller_output(const View& view, ByteSpan payload) {
    const auto target = navigation_target(view);
    if (!target || !has_nav_controller(view)) return false;
    const InnerTargets inner = view.flight.inner_targets();
    const Euler attitude = to_euler(inner.attitude);
    const Vector3 way = target->position - view.flight.estimate().position;
    const double bearing = flight::math::atan2(way.y(), way.x());
    const bool moves = flight::math::hypot(inner.velocity.x(), inner.velocity.y()) > 0.3;
    return put(NavControllerOutput{.nav_roll = as_float(to_degrees(attitude.roll)),
                                   .nav_pitch = as_float(to_degrees(attitude.pitch)),
                                   .nav_bearing = to_signed_degrees(
                                       moves ? flight::math::atan2(inner.velocity.y(), inner.velocity.x()) : bearing),
                                   .target_bearing = to_signed_degrees(bearing),
                                   .wp_dist = saturated<std::uint16_t>(flight::math::hypot(way.x(), way.y())),
                                   .alt_error = as_float(-way.z()),
                                   .xtrack_error = as_float(target->cross_track)},
               payload);
}

bool write_orbit_execution_status(const View& view, ByteSpan payload) {
    const auto orbit = view.flight.orbit_status();
    if (!orbit) return false;
    return put(OrbitExecutionStatus{.time_usec = boot_us(view),
                                    .radius = as_float(orbit->radius),
                                    .frame = MAV_FRAME_GLOBAL_INT,
                                    .x = to_degrees_e7(orbit->center.latitude),
                                    .y = to_degrees_e7(orbit->center.longitude),
                                    .z = as_float(orbit->center.altitude)},
               payload);
}

// On the ground a return takes no time. -1: unknown, as PX4 leaves all other fields.
bool write_time_estimate_to_target(const View& view, ByteSpan payload) {
    const Flight& flight = view.flight;
    if (!flight.home()) return false;
    const bool is_grounded = flight.landed() == LandedState::on_ground;
    return put(TimeEstimateToTarget{.safe_return = is_grounded ? 0 : saturated<std::int32_t>(seconds_to_return(view)),
                                    .land = -1,
                                    .mission_next_item = -1,
                                    .mission_end = -1,
                                    .commanded_action = -1},
               payload);
}

}  // namespace mavloom::sim
