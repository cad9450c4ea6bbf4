// SPDX-License-Identifier: MIT
// Flies one manoeuvre at a time: turns it into set-points for the kind of vehicle. Private to flight; single owner;
// nothing allocates. Positions are local. Where other vehicles stay at a place, a plane circles around it.
#pragma once

#include <optional>

#include "flight/context.hpp"
#include "flight/navigation/heading.hpp"

namespace mavloom::flight {

// A circle to fly; `center.z()` is the altitude.
struct Circle {
    Vector3 center = Vector3::Zero();
    double radius = 0;  // m; negative counter-clockwise
    OrbitYaw yaw = OrbitYaw::along_path;
};

class Guidance {
public:
    explicit Guidance(FlightContext& context) noexcept : context_(context), heading_(context) {}

    // --- Manoeuvres. Each replaces the one before. `yaw` in rad; `nan`: as Heading decides.
    void rest();                                                             // on the ground, motors idle
    void stop(double z = nan);                                               // brakes, then stays, at `z` if given
    void stay(const Vector3& place, double yaw = nan, double radius = nan);  // goes there and stays
    void go(const Vector3& to, double yaw = nan);                            // along a leg that begins at the last goal
    void circle(const Circle& circle);
    void climb(double z, double yaw = nan);            // takes off and climbs
    void land(const Vector3& spot, double yaw = nan);  // descends at a spot, from wherever the vehicle is
    void land_ahead();                                 // here, or straight ahead for a plane
    void sink();                                       // comes down without a position
    void follow(const Setpoint& setpoint);             // another controller steers

    // Updates the set-point. Call it 50 times a second.
    void update();
    // Like Plant::move_origin.
    void move_origin(const Vector3& by);

    // --- Settings that also apply to later manoeuvres.
    [[nodiscard]] Heading& heading() noexcept { return heading_; }
    [[nodiscard]] const Heading& heading() const noexcept { return heading_; }
    // A speed that is not positive or not finite restores the default.
    void set_speed(SpeedKind kind, double speed) noexcept;
    void reset_speeds() noexcept { speeds_ = {}; }

    [[nodiscard]] const Setpoint& setpoint() const noexcept { return setpoint_; }
    // Empty while the vehicle has no navigation target.
    [[nodiscard]] const std::optional<NavigationTarget>& target() const noexcept { return target_; }
    [[nodiscard]] const Vector3& goal() const noexcept { return goal_; }
    [[nodiscard]] bool is_climbing() const noexcept { return manoeuvre_ == Manoeuvre::climb; }
    [[nodiscard]] bool is_landing() const noexcept;
    [[nodiscard]] bool is_staying() const noexcept;
    // True if the vehicle is horizontally within `radius` of the goal. For a plane, also true once it has passed the
    // goal.
    [[nodiscard]] bool is_near_goal(double radius) const noexcept;
    [[nodiscard]] bool has_goal_altitude() const noexcept;
    // Angle flown around the current circle, rad.
    [[nodiscard]] double turned() const noexcept { return turned_; }
    [[nodiscard]] const std::optional<Circle>& present_circle() const noexcept { return circle_; }

private:
    enum class Manoeuvre : std::uint8_t { rest, stop, stay, leg, circle, climb, approach, final, sink, follow };
    struct Speeds {
        double horizontal = nan, up = nan, down = nan;
    };

    void begin(Manoeuvre manoeuvre, const Vector3& goal, double yaw = nan);
    // Like `begin`, for a caller that sets more before it calls `update`.
    void prepare(Manoeuvre manoeuvre, const Vector3& goal, double yaw = nan);
    [[nodiscard]] SpeedLimits limits() const noexcept;
    [[nodiscard]] bool stays_on_ground() const noexcept;
    [[nodiscard]] double landing_speed() const noexcept;
    [[nodiscard]] Vector3 way() const { return goal_ - context_.craft.estimate().position; }
    // Returns false if a plane has to fly an approach first.
    [[nodiscard]] bool begins_final();
    void steer();
    void steer_stop();
    void steer_stay();
    void steer_circle();
    void steer_climb();
    void steer_approach();
    void steer_down();
    void steer_sink();
    void report_target();

    FlightContext& context_;
    Heading heading_;
    Manoeuvre manoeuvre_ = Manoeuvre::rest;
    Vector3 goal_ = Vector3::Zero(), from_ = Vector3::Zero();
    double yaw_ = nan, radius_ = nan, turned_ = 0, last_bearing_ = nan;
    Vector3 spot_ = Vector3::Zero();  // of a plane's touch-down
    std::optional<Circle> circle_;
    Speeds speeds_;
    Setpoint setpoint_;
    std::optional<NavigationTarget> target_;
};

}  // namespace mavloom::flight
