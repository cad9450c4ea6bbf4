// SPDX-License-Identifier: MIT
#include "mavloom/msg/attitude.hpp"

#include "flight/wire_units.hpp"
#include "mavloom/msg/attitude_quaternion.hpp"
#include "mavloom/msg/enums/mav_estimator_type.hpp"
#include "mavloom/msg/enums/mav_frame.hpp"
#include "mavloom/msg/hil_state_quaternion.hpp"
#include "mavloom/msg/odometry.hpp"
#include "sim/telemetry/projections.hpp"

namespace mavloom::sim {

namespace {

// The upper triangle of a 6 x 6 matrix, row by row: the diagonal lies at 0, 6, 11, 15, 18 and 20.
std::array<float, 21> diagonal(const std::array<double, 6>& variances) noexcept {
    constexpr std::array<std::size_t, 6> places{0, 6, 11, 15, 18, 20};
    std::array<float, 21> matrix{};
    for (std::size_t i = 0; i < places.size(); ++i) matrix[places[i]] = as_float(variances[i]);
    return matrix;
}

constexpr double square(double x) noexcept { return x * x; }

}  // namespace

std::array<float, 4> quaternion_on_wire(const Quaternion& q) noexcept {
    const double sign = q.w() < 0 ? -1 : 1;
    return {as_float(sign * q.w()), as_float(sign * q.x()), as_float(sign * q.y()), as_float(sign * q.z())};
}

bool write_attitude(const View& view, ByteSpan payload) {
    const Estimate& estimate = view.flight.estimate();
    return put(msg::Attitude{.time_boot_ms = boot_ms(view),
                             .roll = as_float(estimate.euler.roll),
                             .pitch = as_float(estimate.euler.pitch),
                             .yaw = as_float(estimate.euler.yaw),
                             .rollspeed = as_float(estimate.rates.x()),
                             .pitchspeed = as_float(estimate.rates.y()),
                             .yawspeed = as_float(estimate.rates.z())},
               payload);
}

bool write_attitude_quaternion(const View& view, ByteSpan payload) {
    const Estimate& estimate = view.flight.estimate();
    const auto q = quaternion_on_wire(estimate.attitude);
    return put(msg::AttitudeQuaternion{.time_boot_ms = boot_ms(view),
                                       .q1 = q[0],
                                       .q2 = q[1],
                                       .q3 = q[2],
                                       .q4 = q[3],
                                       .rollspeed = as_float(estimate.rates.x()),
                                       .pitchspeed = as_float(estimate.rates.y()),
                                       .yawspeed = as_float(estimate.rates.z())},
               payload);
}

// As PX4: both frames are LOCAL_NED, the rates are those of the body, and the covariances are diagonal.
bool write_odometry(const View& view, ByteSpan payload) {
    if (!view.flight.has_origin()) return false;
    const Estimate& estimate = view.flight.estimate();
    const double position = square(view.flight.sensors().position_accuracy()) / 2;
    const double velocity = square(view.flight.sensors().velocity_accuracy());
    return put(msg::Odometry{.time_usec = boot_us(view),
                             .frame_id = msg::MAV_FRAME_LOCAL_NED,
                             .child_frame_id = msg::MAV_FRAME_LOCAL_NED,
                             .x = as_float(estimate.position.x()),
                             .y = as_float(estimate.position.y()),
                             .z = as_float(estimate.position.z()),
                             .q = quaternion_on_wire(estimate.attitude),
                             .vx = as_float(estimate.velocity.x()),
                             .vy = as_float(estimate.velocity.y()),
                             .vz = as_float(estimate.velocity.z()),
                             .rollspeed = as_float(estimate.rates.x()),
                             .pitchspeed = as_float(estimate.rates.y()),
                             .yawspeed = as_float(estimate.rates.z()),
                             .pose_covariance = diagonal({position, position, 1.5e-3, 3.8e-4, 3.8e-4, 2.3e-2}),
                             .velocity_covariance = diagonal({velocity, velocity, 1e-3, 0, 0, 0}),
                             .estimator_type = msg::MAV_ESTIMATOR_TYPE_AUTOPILOT},
               payload);
}

// The true motion, without the errors of sensors and estimate.
bool write_hil_state_quaternion(const View& view, ByteSpan payload) {
    const Kinematics& truth = view.flight.truth();
    const GeoPoint position = view.flight.frame().to_geo(truth.position);
    const Vector3 force = truth.attitude.conjugate() * (truth.acceleration - Vector3(0, 0, gravity));
    const auto airspeed = saturated<std::uint16_t>(view.flight.plant().air_velocity().norm() * 100);
    const auto milli_g = [](double m_s2) { return saturated<std::int16_t>(m_s2 / gravity * 1e3); };
    return put(msg::HilStateQuaternion{.time_usec = boot_us(view),
                                       .attitude_quaternion = quaternion_on_wire(truth.attitude),
                                       .rollspeed = as_float(truth.rates.x()),
                                       .pitchspeed = as_float(truth.rates.y()),
                                       .yawspeed = as_float(truth.rates.z()),
                                       .lat = to_degrees_e7(position.latitude),
                                       .lon = to_degrees_e7(position.longitude),
                                       .alt = to_mm(position.altitude),
                                       .vx = to_cm_s(truth.velocity.x()),
                                       .vy = to_cm_s(truth.velocity.y()),
                                       .vz = to_cm_s(truth.velocity.z()),
                                       .ind_airspeed = airspeed,
                                       .true_airspeed = airspeed,
                                       .xacc = milli_g(force.x()),
                                       .yacc = milli_g(force.y()),
                                       .zacc = milli_g(force.z())},
               payload);
}

}  // namespace mavloom::sim
