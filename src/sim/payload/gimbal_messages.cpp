// SPDX-License-Identifier: MIT
// What a gimbal reports. Yaw is from north while it is locked, and from the vehicle's nose while it follows.
#include <cstring>

#include "flight/physics/math.hpp"
#include "flight/wire_units.hpp"
#include "mavloom/msg/enums/gimbal_device_cap_flags.hpp"
#include "mavloom/msg/enums/gimbal_manager_cap_flags.hpp"
#include "mavloom/msg/gimbal_device_attitude_status.hpp"
#include "mavloom/msg/gimbal_device_information.hpp"
#include "mavloom/msg/gimbal_manager_information.hpp"
#include "mavloom/msg/gimbal_manager_status.hpp"
#include "mavloom/msg/mount_orientation.hpp"
#include "sim/payload/gimbal.hpp"
#include "sim/telemetry/projections.hpp"

namespace mavloom::sim {

namespace {

using namespace msg;

// The bits of both messages are the same, but for the two that only a manager has.
constexpr std::uint32_t device_abilities = GIMBAL_DEVICE_CAP_FLAGS_HAS_RETRACT | GIMBAL_DEVICE_CAP_FLAGS_HAS_NEUTRAL |
                                           GIMBAL_DEVICE_CAP_FLAGS_HAS_ROLL_AXIS |
                                           GIMBAL_DEVICE_CAP_FLAGS_HAS_ROLL_LOCK |
                                           GIMBAL_DEVICE_CAP_FLAGS_HAS_PITCH_AXIS |
                                           GIMBAL_DEVICE_CAP_FLAGS_HAS_PITCH_LOCK |
                                           GIMBAL_DEVICE_CAP_FLAGS_HAS_YAW_AXIS |
                                           GIMBAL_DEVICE_CAP_FLAGS_HAS_YAW_FOLLOW |
                                           GIMBAL_DEVICE_CAP_FLAGS_HAS_YAW_LOCK |
                                           GIMBAL_DEVICE_CAP_FLAGS_SUPPORTS_INFINITE_YAW |
                                           GIMBAL_DEVICE_CAP_FLAGS_SUPPORTS_YAW_IN_EARTH_FRAME;
constexpr std::uint32_t manager_abilities = device_abilities | GIMBAL_MANAGER_CAP_FLAGS_CAN_POINT_LOCATION_GLOBAL;

struct Range {
    float pitch_min = as_float(GimbalMotion::pitch_lowest), pitch_max = as_float(GimbalMotion::pitch_highest);
    float yaw_min = as_float(-pi), yaw_max = as_float(pi);
};

// Of the vehicle's nose over the ground, rad/s.
double heading_rate(const Estimate& estimate) noexcept {
    const Euler& e = estimate.euler;
    const double level = std::max(flight::math::cos(e.pitch), 0.1);
    return (estimate.rates.y() * flight::math::sin(e.roll) + estimate.rates.z() * flight::math::cos(e.roll)) / level;
}

}  // namespace

bool write_gimbal_manager_information(const View& view, ByteSpan payload) {
    if (view.gimbal == nullptr) return false;
    const Range range;
    return put(GimbalManagerInformation{.time_boot_ms = boot_ms(view),
                                        .cap_flags = manager_abilities,
                                        .gimbal_device_id = Gimbal::device_id,
                                        .pitch_min = range.pitch_min,
                                        .pitch_max = range.pitch_max,
                                        .yaw_min = range.yaw_min,
                                        .yaw_max = range.yaw_max},
               payload);
}

bool write_gimbal_device_information(const View& view, ByteSpan payload) {
    if (view.gimbal == nullptr) return false;
    const Range range;
    GimbalDeviceInformation message{.time_boot_ms = boot_ms(view),
                                    .firmware_version = 0x00000001,  // 1.0.0: major in the lowest byte
                                    .uid = view.options.system.value,
                                    .cap_flags = static_cast<std::uint16_t>(device_abilities),
                                    .pitch_min = range.pitch_min,
                                    .pitch_max = range.pitch_max,
                                    .yaw_min = range.yaw_min,
                                    .yaw_max = range.yaw_max,
                                    .gimbal_device_id = Gimbal::device_id,
                                    .cap_flags2 = device_abilities};
    std::memcpy(message.vendor_name.data(), "Mavloom", 7);
    std::memcpy(message.model_name.data(), "Simulated gimbal", 16);
    return put(message, payload);
}

bool write_gimbal_manager_status(const View& view, ByteSpan payload) {
    if (view.gimbal == nullptr) return false;
    const Source &primary = view.gimbal->primary(), &secondary = view.gimbal->secondary();
    return put(GimbalManagerStatus{.time_boot_ms = boot_ms(view),
                                   .flags = view.gimbal->flags(),
                                   .gimbal_device_id = Gimbal::device_id,
                                   .primary_control_sysid = primary.system.value,
                                   .primary_control_compid = primary.component.value,
                                   .secondary_control_sysid = secondary.system.value,
                                   .secondary_control_compid = secondary.component.value},
               payload);
}

bool write_gimbal_device_attitude_status(const View& view, ByteSpan payload) {
    if (view.gimbal == nullptr) return false;
    const GimbalMotion& motion = view.gimbal->motion();
    const Estimate& estimate = view.flight.estimate();
    return put(GimbalDeviceAttitudeStatus{.time_boot_ms = boot_ms(view),
                                          .flags = view.gimbal->flags(),
                                          .q = quaternion_on_wire(to_quaternion({0, motion.pitch(), motion.yaw()})),
                                          .angular_velocity_x = 0,
                                          .angular_velocity_y = as_float(motion.pitch_rate()),
                                          .angular_velocity_z = as_float(motion.yaw_rate()),
                                          .delta_yaw = as_float(wrap_pi(estimate.heading)),
                                          .delta_yaw_velocity = as_float(heading_rate(estimate)),
                                          .gimbal_device_id = Gimbal::device_id},
               payload);
}

bool write_mount_orientation(const View& view, ByteSpan payload) {
    if (view.gimbal == nullptr) return false;
    const GimbalMotion& motion = view.gimbal->motion();
    const double heading = view.flight.estimate().heading;
    return put(MountOrientation{.time_boot_ms = boot_ms(view),
                                .roll = 0,
                                .pitch = as_float(to_degrees(motion.pitch())),
                                .yaw = as_float(to_degrees(motion.yaw_in_vehicle(heading))),
                                .yaw_absolute = as_float(to_degrees(motion.yaw_from_north(heading)))},
               payload);
}

}  // namespace mavloom::sim
