// SPDX-License-Identifier: MIT
// Flies the uploaded mission, item by item. Private to flight; single owner. Allocates when the plan changes, and for
// texts.
//
// Each item begins, continues until it is done, and is then reported as reached. Items without a place act at once.
// Sources: MAVLink common message set, MAV_CMD; PX4 user guide, "Mission Mode".
#pragma once

#include <utility>
#include <vector>

#include "flight/navigation/guidance.hpp"
#include "flight/navigation/return_path.hpp"

namespace mavloom::flight {

class MissionRunner {
public:
    MissionRunner(FlightContext& context, Guidance& guidance, ReturnPath& return_path) noexcept
        : context_(context), guidance_(guidance), return_path_(return_path) {}

    // The vehicle enters its mission mode, or leaves it.
    void begin();
    void leave();
    // Call it 50 times a second, in the mission mode while armed.
    void update();

    void on_plan_changed();
    // Call it after arming. A finished mission starts over.
    void on_armed();
    // Returns false if there is no such item. Without `seq`, restarts the current item. `resets` also forgets the jumps
    // done so far.
    [[nodiscard]] bool set_current(std::optional<std::uint16_t> seq, bool resets);
    // The first item of the landing section, if the mission has one.
    [[nodiscard]] std::optional<std::uint16_t> landing_start() const noexcept;

    [[nodiscard]] MissionProgress progress() const noexcept;
    [[nodiscard]] bool is_complete() const noexcept { return is_complete_; }
    // True once after an item that makes the vehicle change to its mode for the return.
    [[nodiscard]] bool takes_return() noexcept { return std::exchange(wants_return_, false); }

private:
    // `lift`: takes off; `travel`: on the way to the item's place; `act`: there.
    enum class Stage : std::uint8_t { fresh, lift, travel, act };

    [[nodiscard]] const PlanItem& item() const noexcept { return context_.plans.mission().items()[index_]; }
    [[nodiscard]] std::uint16_t size() const noexcept { return context_.plans.mission().size(); }
    // ArduPilot's item 0 is home.
    [[nodiscard]] std::uint16_t first() const noexcept { return context_.firmware.has_home_in_mission() ? 1 : 0; }

    void restart();
    void enter(Stage stage) noexcept;
    void finish_item();
    void complete();
    [[nodiscard]] bool is_endless() const noexcept;

    // Begins or continues the current item. Returns true once the item is done.
    [[nodiscard]] bool fly();
    [[nodiscard]] bool fly_place();
    [[nodiscard]] bool fly_takeoff();
    [[nodiscard]] bool fly_landing();
    [[nodiscard]] bool fly_return();
    // PX4, and ArduPilot's plane. Others return within the mission.
    [[nodiscard]] bool returns_by_mode() const noexcept {
        return context_.firmware.is_px4() || context_.kind() == Kind::plane;
    }
    [[nodiscard]] bool wait(double seconds);
    void lift_off(double z);
    void set_out();
    [[nodiscard]] bool has_arrived() const;
    void begin_act();
    [[nodiscard]] bool has_acted() const;
    // True if the item has the vehicle, a plane, circle around its place.
    [[nodiscard]] bool circles() const noexcept;
    [[nodiscard]] bool leaves_circle() const;
    [[nodiscard]] std::optional<Vector3> next_place() const;
    [[nodiscard]] double radius() const noexcept;          // of the item's circle; negative counter-clockwise
    [[nodiscard]] double arrival_radius() const noexcept;  // within it, the vehicle is at the item's place

    void act_at_once();
    void jump();
    void set_roi();
    void turn();
    void set_home();

    // The place of the item. Coordinates that the item leaves open come from the last goal.
    [[nodiscard]] Vector3 place() const;
    [[nodiscard]] double altitude_z() const noexcept;
    [[nodiscard]] double param(std::size_t number) const noexcept { return double{item().params[number - 1]}; }
    [[nodiscard]] double yaw() const noexcept { return to_radians(param(4)); }

    FlightContext& context_;
    Guidance& guidance_;
    ReturnPath& return_path_;
    std::uint16_t index_ = 0, next_ = 1;
    Stage stage_ = Stage::fresh;
    FlightTime since_{};
    std::vector<std::uint16_t> jumps_;  // done so far, by item
    int actions_in_a_row_ = 0;          // items since the last one that was a way to go
    bool runs_ = false, is_complete_ = false, has_reached_any_ = false, is_announced_ = false, wants_return_ = false;
};

}  // namespace mavloom::flight
