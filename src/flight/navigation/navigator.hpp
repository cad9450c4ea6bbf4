// SPDX-License-Identifier: MIT
// Decides what the vehicle does in each mode, and provides its set-points. Private to flight; single owner.
#pragma once

#include "flight/inputs.hpp"
#include "flight/mode.hpp"
#include "flight/navigation/guidance.hpp"
#include "flight/navigation/manual_control.hpp"
#include "flight/navigation/mission_runner.hpp"
#include "flight/navigation/offboard_control.hpp"
#include "flight/navigation/return_path.hpp"

namespace mavloom::flight {

class Navigator {
public:
    Navigator(FlightContext& context, const Inputs& inputs);
    Navigator(const Navigator&) = delete;
    Navigator& operator=(const Navigator&) = delete;

    // Call it when the mode changes. Entering the same behaviour again changes nothing.
    void enter(Behaviour behaviour);
    // Call it 50 times a second. When the current behaviour is done, returns the behaviour to enter next.
    [[nodiscard]] std::optional<Behaviour> update();
    // Like Plant::move_origin.
    void move_origin(const Vector3& by) { guidance_.move_origin(by); }

    // --- Orders within the current behaviour.
    void take_off(double z, double yaw);
    void orbit(const Circle& circle, double turns);
    // `pause` stops the vehicle where it is; `resume` continues. A mission continues with its current item.
    void pause();
    void resume();

    [[nodiscard]] Behaviour behaviour() const noexcept { return behaviour_; }
    [[nodiscard]] Guidance& guidance() noexcept { return guidance_; }
    [[nodiscard]] const Guidance& guidance() const noexcept { return guidance_; }
    [[nodiscard]] MissionRunner& mission() noexcept { return mission_; }
    [[nodiscard]] const MissionRunner& mission() const noexcept { return mission_; }
    // True once the return is complete. A rover has then arrived at home.
    [[nodiscard]] bool is_home() const noexcept {
        return behaviour_ == Behaviour::return_home && return_path_.is_done();
    }

private:
    void enter_hold(Behaviour before);
    void enter_orbit();
    [[nodiscard]] std::optional<Behaviour> update_climb();
    [[nodiscard]] std::optional<Behaviour> update_mission();
    void update_manual();

    FlightContext& context_;
    const Inputs& inputs_;
    Guidance guidance_;
    ReturnPath return_path_;
    MissionRunner mission_;
    ManualControl manual_;
    OffboardControl offboard_;
    Behaviour behaviour_ = Behaviour::unavailable;
    double turns_ = 0;  // to fly around an orbit; 0: no limit
    bool is_paused_ = false;
};

}  // namespace mavloom::flight
