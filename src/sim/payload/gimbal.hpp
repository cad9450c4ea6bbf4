// SPDX-License-Identifier: MIT
// A simulated gimbal and its manager. Private to module sim; single owner. Source: MAVLink guide, "Gimbal Protocol v2".
//
// The autopilot is the manager, and the gimbal is its device 1: a gimbal that speaks no MAVLink and has no heartbeat.
// One client has primary control; orders of others are refused. As in PX4, any client may take control.
#pragma once

#include "flight/flight.hpp"
#include "sim/payload/gimbal_motion.hpp"
#include "sim/service/service.hpp"

namespace mavloom::sim {

struct Command;
class Gimbal final : public Service {
public:
    static constexpr std::uint8_t device_id = 1;

    Gimbal(const VehicleOptions& options, const Flight& flight) noexcept : options_(options), flight_(flight) {}

    [[nodiscard]] std::span<const MessageId> handled() const noexcept override;
    void receive(const Client& from, MessageId id, ByteView payload, Moment now) override;
    void reboot() override;

    // MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW and _CONFIGURE. The vehicle's own mission needs no control.
    [[nodiscard]] Result set_pitch_yaw(const Command& command);
    [[nodiscard]] Result configure(const Command& command);
    // MAV_CMD_DO_MOUNT_CONTROL, the older form. Angles in degrees.
    [[nodiscard]] Result mount_control(double pitch, double yaw, float mode);

    // Call it after each step of the flight.
    void step();

    // --- State, for telemetry.
    [[nodiscard]] const GimbalMotion& motion() const noexcept { return motion_; }
    [[nodiscard]] std::uint16_t flags() const noexcept;  // GIMBAL_DEVICE_FLAGS, the same bits as GIMBAL_MANAGER_FLAGS
    [[nodiscard]] const Source& primary() const noexcept { return primary_; }  // 0/0: nobody
    [[nodiscard]] const Source& secondary() const noexcept { return secondary_; }

private:
    [[nodiscard]] bool may_control(const Source& who) const noexcept;
    void aim(const GimbalAim& aim, std::uint32_t flags);
    void notice_interest();
    void point_at_interest();
    [[nodiscard]] double heading() const noexcept;

    const VehicleOptions& options_;
    const Flight& flight_;
    GimbalMotion motion_;
    Source primary_{SystemId{0}, ComponentId{0}}, secondary_{SystemId{0}, ComponentId{0}};
    std::uint16_t rest_ = 0;  // the flag for retract or neutral, while in that position
    // The region of interest as last seen. The gimbal looks there until a client gives another order.
    std::optional<GeoPoint> interest_;
    GeoPoint origin_;  // of the local frame in which interest_position_ is
    Vector3 interest_position_ = Vector3::Zero();
    bool follows_interest_ = false;
};

}  // namespace mavloom::sim
