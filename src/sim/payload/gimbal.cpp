// SPDX-License-Identifier: MIT
#include "sim/payload/gimbal.hpp"

#include <array>
#include <cmath>

#include "flight/physics/math.hpp"
#include "mavloom/msg/enums/gimbal_manager_flags.hpp"
#include "mavloom/msg/enums/mav_mount_mode.hpp"
#include "mavloom/msg/gimbal_manager_set_attitude.hpp"
#include "mavloom/msg/gimbal_manager_set_manual_control.hpp"
#include "mavloom/msg/gimbal_manager_set_pitchyaw.hpp"
#include "sim/command/commands.hpp"

namespace mavloom::sim {

namespace {

constexpr std::array gimbal_message_ids{msg::GimbalManagerSetAttitude::id, msg::GimbalManagerSetPitchyaw::id,
                                        msg::GimbalManagerSetManualControl::id};
constexpr Source nobody{SystemId{0}, ComponentId{0}};

// Device 0 means all gimbals.
bool is_ours(double device) noexcept { return device == 0 || device == Gimbal::device_id; }

// Flags as a command has them: a float that may be anything.
std::uint32_t flags_of(double value) noexcept {
    return value >= 0 && value <= 0xffff ? static_cast<std::uint32_t>(value) : 0;
}

// Clients may send any angle; absurd ones count as not given.
double angle_of(double radians) noexcept { return std::abs(radians) < 1e3 ? radians : nan; }

GimbalAim aim_of(const msg::GimbalManagerSetAttitude& m) {
    GimbalAim aim{.pitch = nan, .yaw = nan, .pitch_rate = m.angular_velocity_y, .yaw_rate = m.angular_velocity_z};
    const Quaternion q(m.q[0], m.q[1], m.q[2], m.q[3]);
    if (const double norm = q.norm(); norm > 0.5 && norm < 2) {
        const Euler euler = to_euler(q.normalized());
        aim.pitch = euler.pitch;
        aim.yaw = euler.yaw;
    }
    return aim;
}

// Sticks: -1 to 1 over the range of the axis, or as a share of the greatest rate.
GimbalAim aim_of(const msg::GimbalManagerSetManualControl& m) {
    const auto share = [](float stick, double full) { return std::abs(stick) <= 1 ? stick * full : nan; };
    return {.pitch = share(m.pitch, -GimbalMotion::pitch_lowest),
            .yaw = share(m.yaw, pi),
            .pitch_rate = share(m.pitch_rate, GimbalMotion::fastest),
            .yaw_rate = share(m.yaw_rate, GimbalMotion::fastest)};
}

GimbalAim aim_of_degrees(double pitch, double yaw, double pitch_rate, double yaw_rate) noexcept {
    return {.pitch = to_radians(pitch),
            .yaw = to_radians(yaw),
            .pitch_rate = to_radians(pitch_rate),
            .yaw_rate = to_radians(yaw_rate)};
}

}  // namespace

std::span<const MessageId> Gimbal::handled() const noexcept { return gimbal_message_ids; }

void Gimbal::receive(const Client& from, MessageId id, ByteView payload, Moment /*now*/) {
    if (!may_control(from.id)) return;
    if (id == msg::GimbalManagerSetAttitude::id) {
        const auto order = msg::GimbalManagerSetAttitude::decode(payload);
        if (is_ours(order.gimbal_device_id)) aim(aim_of(order), order.flags);
    } else if (id == msg::GimbalManagerSetPitchyaw::id) {
        const auto order = msg::GimbalManagerSetPitchyaw::decode(payload);
        if (is_ours(order.gimbal_device_id))
            aim({order.pitch, order.yaw, order.pitch_rate, order.yaw_rate}, order.flags);
    } else {
        const auto order = msg::GimbalManagerSetManualControl::decode(payload);
        if (is_ours(order.gimbal_device_id)) aim(aim_of(order), order.flags);
    }
}

Result Gimbal::set_pitch_yaw(const Command& command) {
    if (!is_ours(command.param(7)) || !may_control(command.from.id)) return Result::denied;
    aim(aim_of_degrees(command.param(1), command.param(2), command.param(3), command.param(4)),
        flags_of(command.param(5)));
    return Result::accepted;
}

// A system id or component id of -1 leaves that side as it is, -2 gives control to the sender, -3 takes it from the
// sender; any other pair is in control from now on, and 0/0 is nobody.
Result Gimbal::configure(const Command& command) {
    if (!is_ours(command.param(7))) return Result::denied;
    const auto apply = [&](Source& side, float system, float component) {
        if (system == -2) side = command.from.id;
        if (system == -3 && side == command.from.id) side = nobody;
        if (system >= 0 && system <= 255 && component >= 0 && component <= 255)
            side = {SystemId{static_cast<std::uint8_t>(system)}, ComponentId{static_cast<std::uint8_t>(component)}};
    };
    apply(primary_, command.param(1), command.param(2));
    apply(secondary_, command.param(3), command.param(4));
    return Result::accepted;
}

Result Gimbal::mount_control(double pitch, double yaw, float mode) {
    using namespace msg;
    switch (mode >= 0 && mode <= 7 ? static_cast<int>(mode) : -1) {
        case MAV_MOUNT_MODE_RETRACT: aim({nan, nan, nan, nan}, GIMBAL_MANAGER_FLAGS_RETRACT); break;
        case MAV_MOUNT_MODE_NEUTRAL: aim({nan, nan, nan, nan}, GIMBAL_MANAGER_FLAGS_NEUTRAL); break;
        case MAV_MOUNT_MODE_MAVLINK_TARGETING: aim(aim_of_degrees(pitch, yaw, nan, nan), 0); break;
        default: return Result::denied;
    }
    return Result::accepted;
}

void Gimbal::reboot() {
    primary_ = secondary_ = {SystemId{0}, ComponentId{0}};
    rest_ = 0;
    interest_.reset();
    follows_interest_ = false;
    motion_.center(heading());
}

void Gimbal::step() {
    if (interest_ != flight_.region_of_interest() || (interest_ && origin_ != flight_.frame().origin()))
        notice_interest();
    if (follows_interest_) point_at_interest();
    motion_.step(step_s);
}

std::uint16_t Gimbal::flags() const noexcept {
    using namespace msg;
    const int yaw = motion_.is_locked() ? GIMBAL_MANAGER_FLAGS_YAW_LOCK | GIMBAL_MANAGER_FLAGS_YAW_IN_EARTH_FRAME
                                        : GIMBAL_MANAGER_FLAGS_YAW_IN_VEHICLE_FRAME;
    return static_cast<std::uint16_t>(GIMBAL_MANAGER_FLAGS_ROLL_LOCK | GIMBAL_MANAGER_FLAGS_PITCH_LOCK |
                                      GIMBAL_MANAGER_FLAGS_ACCEPTS_YAW_IN_EARTH_FRAME | yaw | rest_);
}

bool Gimbal::may_control(const Source& who) const noexcept {
    const Source mission{options_.system, autopilot_component};
    return who == primary_ || (primary_ == nobody && who == secondary_) || who == mission;
}

// Without a flag for the frame, a locked yaw is from north and any other from the nose.
void Gimbal::aim(const GimbalAim& asked, std::uint32_t flags) {
    using namespace msg;
    follows_interest_ = false;
    rest_ = static_cast<std::uint16_t>(flags & (GIMBAL_MANAGER_FLAGS_RETRACT | GIMBAL_MANAGER_FLAGS_NEUTRAL));
    if (rest_ != 0) return motion_.center(heading());
    GimbalAim order{angle_of(asked.pitch), angle_of(asked.yaw), asked.pitch_rate, asked.yaw_rate};
    order.locks_yaw = (flags & GIMBAL_MANAGER_FLAGS_YAW_LOCK) != 0;
    const bool is_in_vehicle = (flags & GIMBAL_MANAGER_FLAGS_YAW_IN_VEHICLE_FRAME) != 0;
    const bool is_from_north = (flags & GIMBAL_MANAGER_FLAGS_YAW_IN_EARTH_FRAME) != 0;
    order.is_yaw_from_north = is_from_north || (order.locks_yaw && !is_in_vehicle);
    motion_.aim(order, heading());
}

void Gimbal::notice_interest() {
    const Flight& flight = flight_;
    const bool is_new = std::exchange(interest_, flight.region_of_interest()) != interest_;
    origin_ = flight.frame().origin();
    if (interest_) interest_position_ = flight.frame().to_local(*interest_);
    if (!is_new) return;
    follows_interest_ = interest_.has_value();
    rest_ = 0;
    if (!interest_) motion_.center(heading());
}

void Gimbal::point_at_interest() {
    const Vector3 line = interest_position_ - flight_.estimate().position;
    motion_.aim({.pitch = -flight::math::atan2(line.z(), flight::math::hypot(line.x(), line.y())),
                 .yaw = flight::math::atan2(line.y(), line.x()),
                 .pitch_rate = nan,
                 .yaw_rate = nan,
                 .locks_yaw = true,
                 .is_yaw_from_north = true},
                heading());
}

double Gimbal::heading() const noexcept { return flight_.estimate().heading; }

}  // namespace mavloom::sim
