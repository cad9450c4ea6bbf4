// SPDX-License-Identifier: MIT
// The pilot on other bodies than the standard quadrotor.
#include <gmock/gmock.h>

#include <vector>

#include "flight/pilot/copter/mixer.hpp"
#include "flight/plant/multicopter.hpp"
#include "unit/flight/support/piloted.hpp"

namespace mavloom::flight {
namespace {

std::vector<CopterBody> bodies() {
    std::vector<CopterBody> all{body_of(BodyPreset::iris), body_of(BodyPreset::jmavsim)};
    for (const Frame frame : {Frame::quad_plus, Frame::hexa_x, Frame::hexa_plus, Frame::octo_x, Frame::octo_plus,
                              Frame::octo_cox, Frame::dodeca_cox}) {
        set_frame(all.emplace_back(), frame, 0.25);
        all.back().mass_kg = 2;
    }
    // The quadrotor of PX4's SIH: slow motors, much drag.
    CopterBody& slow = all.emplace_back(CopterBody{.mass_kg = 1,
                                                   .inertia_kg_m2 = {0.025, 0.025, 0.03},
                                                   .thrust_n = 5,
                                                   .moment_ratio_m = 0.02,
                                                   .spin_up_s = 0.05,
                                                   .spin_down_s = 0.05,
                                                   .drag = 1,
                                                   .turn_drag = 0.025});
    set_frame(slow, Frame::quad_x, 0.2);
    return all;
}

class OtherBodyTest : public ::testing::TestWithParam<CopterBody> {};
INSTANTIATE_TEST_SUITE_P(All, OtherBodyTest, ::testing::ValuesIn(bodies()));

TEST_P(OtherBodyTest, FliesToAPointAndLands) {
    test::Piloted copter(Kind::quad, {.copter = GetParam()});
    copter.place(Vector3::Zero(), 0);
    Setpoint setpoint{.steering = Steering::trajectory, .position = {0, 0, -10}, .yaw = 1};
    const auto run = [&](double seconds) {
        for (long i = std::lround(seconds / step_s); i > 0; --i) copter.step(setpoint, true, {.wind = {3, 2, 0}});
    };
    run(25);
    EXPECT_LT((copter.motion().position - setpoint.position).norm(), 0.2);
    setpoint.position = {20, -10, -12};
    run(25);
    EXPECT_LT((copter.motion().position - setpoint.position).norm(), 0.2);
    EXPECT_NEAR(yaw_of(copter.motion().attitude), 1, 0.02);
    EXPECT_LT(copter.motion().rates.norm(), 0.02);  // no oscillation

    setpoint.position.z() = nan;
    setpoint.velocity = {nan, nan, 0.7};
    setpoint.touch_down = true;
    run(25);
    EXPECT_TRUE(copter.touches_ground());
    EXPECT_EQ(copter.motion().velocity, Vector3::Zero());
}

// A moment about one axis leaves the others and the thrust alone, also on a body whose arms differ, and full moments
// are those that the mixer states.
TEST_P(OtherBodyTest, MixesEachAxisForItself) {
    CopterBody quick = GetParam();
    quick.spin_up_s = quick.spin_down_s = quick.drag = quick.square_drag = quick.rotor_drag = 0;
    Mixer mixer(quick);
    for (int axis = 0; axis < 3; ++axis) {
        std::array<double, 3> wanted{};
        wanted[static_cast<std::size_t>(axis)] = 0.1;
        Multicopter copter(quick);
        copter.place({0, 0, -100}, 0);
        copter.step(mixer.mix({wanted[0], wanted[1], wanted[2], 0.5}), {}, 0.001);

        const Vector3 expected = Vector3::Unit(axis) * (0.1 * mixer.full_moment()[axis]);
        EXPECT_LT((copter.motion().rates / 0.001 - expected).norm(), 1e-6 * expected.norm());
        EXPECT_NEAR(copter.motion().acceleration.z(), gravity - 0.5 * mixer.full_thrust(), 1e-6);
    }
}

}  // namespace
}  // namespace mavloom::flight
