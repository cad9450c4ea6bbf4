// SPDX-License-Identifier: MIT
// Planes and rovers with other numbers, under Mavloom's own pilots and without. Expected values come from closed
// formulas.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "unit/flight/support/piloted.hpp"

namespace mavloom::flight {
namespace {

// ---- planes ---------------------------------------------------------------------------------------------------------

TEST(OtherPlane, StallsByItsWeightAndItsWing) {
    // sqrt(2 m g / (1.225 S C)), with 0.15 + 4.5 times 13 degrees as the greatest lift coefficient.
    EXPECT_NEAR(stall_speed({}), std::sqrt(2 * 1.5 * 9.80665 / (1.225 * 0.4 * 1.17102)), 1e-3);
    EXPECT_NEAR(stall_speed({.mass_kg = 6}), 2 * stall_speed({}), 1e-9);
    EXPECT_NEAR(stall_speed({.area_m2 = 1.6}), stall_speed({}) / 2, 1e-9);
}

// At rest the propeller pulls with its static thrust; the wheels have a friction of 0.04.
TEST(OtherPlane, AcceleratesByItsThrustAndMass) {
    PlaneBody body{.mass_kg = 4, .thrust_n = 50, .spin_s = 0.02};
    const auto plane = make_plant(Kind::plane, {.plane = body});
    plane->place(Vector3::Zero(), 0);
    for (int i = 0; i < 50; ++i) plane->step({0, 0, 1, 0}, {}, 0.004);
    const double speed = plane->motion().velocity.x();
    EXPECT_NEAR(plane->motion().acceleration.x(), 50 * (1 - speed / 40) / 4 - 0.04 * gravity, 0.2);
    plane->set_mass(8);
    plane->step({0, 0, 1, 0}, {}, 0.004);
    EXPECT_NEAR(plane->motion().acceleration.x(), 50 * (1 - speed / 40) / 8 - 0.04 * gravity, 0.2);
}

// Without motor, at last: drag / lift is the slope of the path. Trimmed at 5 degrees, the wing lifts with
// 0.15 + 4.5 * 0.0873 = 0.543, and brakes with 0.06 + 0.0568 * 0.543^2 = 0.0768.
TEST(OtherPlane, GlidesByItsDrag) {
    PlaneBody body{.drag_zero = 0.06, .trim_deg = 5};
    const auto plane = make_plant(Kind::plane, {.plane = body});
    plane->place({0, 0, -3000}, 0);
    for (int i = 0; i < 60'000; ++i) plane->step({0, 0, i < 5000 ? 0.5 : 0, 0}, {}, 0.002);
    const Vector3& velocity = plane->motion().velocity;
    EXPECT_NEAR(velocity.z() / velocity.x(), 0.0768 / 0.543, 0.004);
    const double pressure = 0.5 * 1.225 * velocity.squaredNorm();
    EXPECT_NEAR(pressure * 0.4 * std::hypot(0.543, 0.0768), 1.5 * gravity, 0.2);
}

// Steady roll at full ailerons: full / damping * 2 V / span.
TEST(OtherPlane, RollsByItsAileronsDampingAndSpan) {
    PlaneBody body{.span_m = 1.2, .roll_damping = 0.8, .full_ailerons = 0.05};
    const auto plane = make_plant(Kind::plane, {.plane = body});
    plane->place({0, 0, -1000}, 0);
    for (int i = 0; i < 2000; ++i) plane->step({0, 0, 0.5, 0}, {}, 0.004);
    for (int i = 0; i < 100; ++i) plane->step({1, 0, 0.5, 0}, {}, 0.004);
    const double rate = 0.05 / 0.8 * 2 * plane->air_velocity().norm() / 1.2;
    EXPECT_NEAR(plane->motion().rates.x(), rate, 0.05 * rate);
}

struct NamedPlane {
    const char* name;
    PlaneBody body;
};
class PilotedPlaneTest : public ::testing::TestWithParam<NamedPlane> {};

// Takes off, climbs, circles and lands, at the limits that a standard plane has.
TEST_P(PilotedPlaneTest, Flies) {
    const PlaneBody& body = GetParam().body;
    const double stall = stall_speed(body);
    test::Piloted plane(Kind::plane, {.plane = body});
    plane.place(Vector3::Zero(), 0);
    double slowest = 1e3;
    const auto run = [&](const Setpoint& setpoint, double seconds) {
        for (double t = 0; t < seconds; t += step_s) {
            plane.step(setpoint, true, {});
            const double height = -plane.motion().position.z();
            if (height > 20) slowest = std::min(slowest, plane.air_velocity().norm());
        }
    };
    Setpoint leg{.steering = Steering::waypoint, .position = {1500, 0, -80}, .from = Vector3::Zero()};
    leg.limits.horizontal = 15;
    run(leg, 80);
    EXPECT_NEAR(plane.motion().position.z(), -80, 2);
    EXPECT_GT(slowest, 1.1 * stall);

    Setpoint circle{.steering = Steering::circle, .position = plane.motion().position, .radius = 150};
    circle.position.z() = -80;
    circle.limits.horizontal = 15;
    run(circle, 120);
    EXPECT_NEAR((plane.motion().position - circle.position).head<2>().norm(), 150, 15);
    EXPECT_NEAR(plane.motion().position.z(), -80, 3);
    EXPECT_GT(slowest, 1.1 * stall);

    circle.touch_down = true;
    run(circle, 150);
    EXPECT_TRUE(plane.touches_ground());
    EXPECT_LT(plane.motion().velocity.norm(), 0.1);
}

INSTANTIATE_TEST_SUITE_P(
    Planes, PilotedPlaneTest,
    ::testing::Values(NamedPlane{"aerosonde", body_of(PlanePreset::aerosonde)},
                      NamedPlane{"gazebo", body_of(PlanePreset::gazebo)},
                      NamedPlane{"heavy", {.mass_kg = 4, .inertia_kg_m2 = {0.24, 0.19, 0.4}, .thrust_n = 32}},
                      NamedPlane{"light", {.mass_kg = 0.8, .inertia_kg_m2 = {0.04, 0.03, 0.07}}},
                      NamedPlane{"weak", {.thrust_n = 7}},
                      NamedPlane{"glider", {.mass_kg = 3, .area_m2 = 1, .span_m = 4, .drag_zero = 0.015}}),
    [](const auto& info) { return info.param.name; });

// ---- rovers ---------------------------------------------------------------------------------------------------------

// v = v_max u (1 - exp(-t a / v_max)).
TEST(OtherRover, AcceleratesByItsThrustMassAndTopSpeed) {
    const auto rover = make_plant(Kind::rover, {.rover = {.mass_kg = 20, .thrust_n = 40, .top_speed_m_s = 4}});
    rover->place(Vector3::Zero(), 0);
    for (int i = 0; i < 500; ++i) rover->step({1, 0}, {}, 0.002);
    EXPECT_NEAR(rover->motion().velocity.x(), 4 * (1 - std::exp(-0.5)), 0.01);
    for (int i = 0; i < 10'000; ++i) rover->step({1, 0}, {}, 0.002);
    EXPECT_NEAR(rover->motion().velocity.x(), 4, 1e-3);
}

// The curvature is the inverse of the turn radius, but no more than the grip holds: grip / v^2.
TEST(OtherRover, TurnsByItsRadiusAndGrip) {
    const auto rover = make_plant(Kind::rover, {.rover = {.turn_radius_m = 3, .grip_m_s2 = 2}});
    rover->place(Vector3::Zero(), 0);
    for (int i = 0; i < 10'000; ++i) rover->step({0.1, 1}, {}, 0.002);
    EXPECT_NEAR(rover->motion().rates.z(), 1.0 / 3, 1e-3);
    for (int i = 0; i < 10'000; ++i) rover->step({0.8, 1}, {}, 0.002);
    EXPECT_NEAR(rover->motion().rates.z() * 8, 2, 1e-2);
}

class PilotedRoverTest : public ::testing::TestWithParam<RoverBody> {};

TEST_P(PilotedRoverTest, DrivesToAPlaceAndStops) {
    const RoverBody& body = GetParam();
    test::Piloted rover(Kind::rover, {.rover = body});
    rover.place(Vector3::Zero(), to_radians(90));
    Setpoint setpoint{.steering = Steering::trajectory, .position = {60, 0, 0}};
    double fastest = 0, farthest = 0;
    for (double t = 0; t < 120; t += step_s) {
        rover.step(setpoint, true, {});
        fastest = std::max(fastest, rover.motion().velocity.norm());
        farthest = std::max(farthest, rover.motion().position.x());
    }
    EXPECT_NEAR(rover.motion().position.x(), 60, 1.5);
    EXPECT_LT(rover.motion().velocity.norm(), 0.01);
    EXPECT_LE(fastest, body.top_speed_m_s + 1e-6);
    EXPECT_GT(fastest, 0.7 * std::min(body.top_speed_m_s, 5.0));
    EXPECT_LT(farthest, 62) << "it brakes in time";
}

INSTANTIATE_TEST_SUITE_P(Rovers, PilotedRoverTest,
                         ::testing::Values(RoverBody{}, body_of(RoverPreset::sih),
                                           RoverBody{.mass_kg = 300, .thrust_n = 450, .turn_radius_m = 4},
                                           RoverBody{.mass_kg = 1, .thrust_n = 30, .top_speed_m_s = 20}));

}  // namespace
}  // namespace mavloom::flight
