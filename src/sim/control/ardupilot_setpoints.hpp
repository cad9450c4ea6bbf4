// SPDX-License-Identifier: MIT
// What ArduPilot does with set-points of clients. Private to module sim; single owner. Source: the handlers of
// SET_POSITION_TARGET_* and SET_ATTITUDE_TARGET in ArduCopter, Rover and ArduPlane 4.6, and what later versions
// corrected in them: a copter stops also at a force, and a plane changes its altitude only if the mask has one.
//
// Outside of Guided, set-points are ignored. A set-point that a copter cannot fly stops it, without a text; a rover
// ignores it. Of all set-points, a plane takes altitudes only, and attitudes.
#pragma once

#include "flight/flight.hpp"
#include "flight/orders.hpp"
#include "mavloom/msg/set_position_target_global_int.hpp"
#include "mavloom/msg/set_position_target_local_ned.hpp"
#include "sim/service/service.hpp"

namespace mavloom::sim {

class ArdupilotSetpoints {
public:
    ArdupilotSetpoints(Kind kind, Flight& flight, FlightObserver& observer) noexcept
        : kind_(kind), flight_(flight), observer_(observer) {}

    void on_local_target(ByteView payload);
    void on_global_target(ByteView payload);
    void on_attitude_target(ByteView payload);

private:
    // A position target of either message, in the local frame. `setpoint` has all fields of the message, excluded
    // ones too; `nan` in `position`: no such place.
    struct Target {
        unsigned mask = 0;
        bool has_known_frame = false;
        bool needs_frame = true;  // for copters
        bool is_above_terrain = false;
        bool is_backwards = false;  // for rovers
        OffboardSetpoint setpoint;
    };

    [[nodiscard]] bool is_guided() const noexcept;
    [[nodiscard]] Target target_of(const msg::SetPositionTargetLocalNed& m) const;
    void obey(const Target& target);
    void fly(const Target& target);
    void drive(const Target& target);
    void steer_rover(const Target& target);
    void climb_by(const msg::SetPositionTargetLocalNed& m);
    void climb_to(const msg::SetPositionTargetGlobalInt& m);

    void go_to(const Vector3& place, double yaw);
    void stop();

    const Kind kind_;
    Flight& flight_;
    FlightObserver& observer_;
};

}  // namespace mavloom::sim
