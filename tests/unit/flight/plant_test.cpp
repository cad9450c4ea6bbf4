// SPDX-License-Identifier: MIT
// Plants without a pilot, against closed-form physics. The numbers of bodies are those of the simulators that they come
// from.
#include "flight/plant/plant.hpp"

#include <gmock/gmock.h>

#include <vector>

#include "flight/plant/multicopter.hpp"

namespace mavloom::flight {
namespace {

using ::testing::ElementsAreArray;

constexpr Outputs stopped{};

Outputs all(double value) {
    Outputs outputs;
    outputs.fill(value);
    return outputs;
}
Outputs only(std::size_t motor, double value) {
    Outputs outputs{};
    outputs[motor] = value;
    return outputs;
}
CopterBody without_drag(CopterBody body = {}) {
    body.drag = body.square_drag = body.rotor_drag = 0;
    return body;
}

class High {  // a plant in the air
public:
    explicit High(const CopterBody& body) : High(Kind::quad, {.copter = body}) {}
    explicit High(Kind kind, const Body& body = {}) : plant(make_plant(kind, body)) {
        plant->place({0, 0, -10'000}, 0);
    }
    void run(const Outputs& outputs, double seconds, double dt = 0.001) const {
        for (long i = std::lround(seconds / dt); i > 0; --i) plant->step(outputs, around, dt);
    }
    [[nodiscard]] const Kinematics& motion() const { return plant->motion(); }
    [[nodiscard]] double airspeed() const { return plant->air_velocity().norm(); }

    std::unique_ptr<Plant> plant;
    Surroundings around;
};

TEST(PlantTest, FallsFreelyWithoutThrustAndDrag) {
    const High body(without_drag());
    body.run(stopped, 2);

    EXPECT_NEAR(body.motion().velocity.z(), 19.6133, 1e-6);
    EXPECT_NEAR(body.motion().position.z(), -10'000 + 19.6133, 0.02);
    EXPECT_EQ(body.plant->load(), 0);
}

// m g = 4 T. Gazebo's iris: 5.84e-6 (1000 u + 100)^2 N a motor; jMAVSim's: 4 u N.
TEST(PlantTest, HoversWhereTheThrustEqualsTheWeight) {
    struct {
        BodyPreset preset;
        double output;
    } const hovers[] = {{BodyPreset::standard, 0.5}, {BodyPreset::jmavsim, 0.4903}, {BodyPreset::iris, 0.7067}};
    for (const auto& [preset, output] : hovers) {
        const High body(without_drag(body_of(preset)));
        body.run(all(output), 1);
        EXPECT_NEAR(body.motion().acceleration.z(), 0, 0.01) << output;
        EXPECT_NEAR(body.plant->load(), 1, 0.01) << output;
    }
}

// sqrt(m g / drag), or m g / drag if it is linear; thin air lets the vehicle fall faster.
TEST(PlantTest, FallsAtTheTerminalVelocityOfItsDrag) {
    High square(body_of(BodyPreset::jmavsim)), linear((CopterBody()));
    square.run(stopped, 60);
    linear.run(stopped, 60);
    EXPECT_NEAR(square.motion().velocity.z(), 28.01, 0.01);
    EXPECT_NEAR(linear.motion().velocity.z(), 49.03, 0.01);

    square.around.air_density = 1.225 / 2;
    square.run(stopped, 60);
    EXPECT_NEAR(square.motion().velocity.z(), 39.61, 0.02);
}

// The iris: 4 rotors at 806.7 rad/s, 1.75e-4 N per m/s and rad/s, 1.55 kg. The wind blows across the rotors.
TEST(PlantTest, RotorsBrakeTheAirThatCrossesThem) {
    High body(body_of(BodyPreset::iris));
    body.run(all(0.7067), 1);
    body.around.wind = {10, 0, 0};
    const Vector3 before = body.motion().velocity;
    body.run(all(0.7067), 0.01);

    const double expected = 4 * 806.7 * 1.75e-4 * (10 - before.x()) / 1.55;
    EXPECT_NEAR(body.motion().acceleration.x(), expected, 0.02 * expected);
    EXPECT_NEAR(body.motion().acceleration.z(), 0, 0.02);
}

TEST(PlantTest, DragSlowsTheRotation) {
    CopterBody body = without_drag();
    body.turn_drag = 0.025;
    const High turning(body);
    turning.run({0, 1, 1, 0}, 0.05);
    turning.run(stopped, 0.5);  // until the motors stand still
    const double before = turning.motion().rates.x();
    ASSERT_GT(before, 1);
    turning.run(stopped, 1);

    EXPECT_NEAR(turning.motion().rates.x(), before * std::exp(-0.025 / 0.0368), 1e-3 * before);
}

// After one time constant, 63.2 % of the change are done, whatever the step.
TEST(PlantTest, MotorsFollowWithTheirTimeConstant) {
    for (const double dt : {0.001, 0.002, 0.004, 0.01}) {
        const High body(without_drag());
        body.run(all(1), 0.06, dt);
        EXPECT_NEAR(body.plant->thrust(), 1 - std::exp(-2), 1e-9) << dt;
        body.run(stopped, 0.06, dt);
        EXPECT_NEAR(body.plant->thrust(), (1 - std::exp(-2)) * std::exp(-2), 1e-9) << dt;
    }
}

// Up within 12.5 ms, down within 25 ms; the thrust grows with the square of the speed.
TEST(PlantTest, MotorsOfTheIrisGetFasterSoonerThanSlower) {
    const High body(body_of(BodyPreset::iris));
    body.run(all(1), 0.0125, 0.0025);
    EXPECT_NEAR(body.plant->thrust(), std::pow(1 - std::exp(-1), 2), 1e-9);
    body.run(all(1), 1);
    body.run(stopped, 0.025, 0.0025);
    EXPECT_NEAR(body.plant->thrust(), std::exp(-2), 1e-9);
}

// PX4's tables: CA_ROTORn_PX, _PY and the sign of _KM of its airframes 4001, 6001, 7001 and 8001, and, for the frames
// without such parameters, positions and directions of its geometries quad_plus, octa_plus, octa_cox, and
// dodeca_bottom_cox before dodeca_top_cox. Each row is a motor's place (forward, right) in turns of the arm, and its
// direction.
struct FrameCase {
    Frame frame;
    std::vector<std::array<double, 3>> motors;
};
constexpr double ccw = 1, cw = -1, s = 0.70711, h = 0.86603, a = 0.92388, b = 0.38268;

class FrameTest : public ::testing::TestWithParam<FrameCase> {};
INSTANTIATE_TEST_SUITE_P(
    All, FrameTest,
    ::testing::Values(
        FrameCase{Frame::quad_x, {{s, s, ccw}, {-s, -s, ccw}, {s, -s, cw}, {-s, s, cw}}},
        FrameCase{Frame::quad_plus, {{0, 1, ccw}, {0, -1, ccw}, {1, 0, cw}, {-1, 0, cw}}},
        FrameCase{Frame::hexa_x,
                  {{0, 1, cw}, {0, -1, ccw}, {h, -0.5, cw}, {-h, 0.5, ccw}, {h, 0.5, ccw}, {-h, -0.5, cw}}},
        FrameCase{Frame::hexa_plus,
                  {{1, 0, cw}, {-1, 0, ccw}, {-0.5, -h, cw}, {0.5, h, ccw}, {0.5, -h, ccw}, {-0.5, h, cw}}},
        FrameCase{
            Frame::octo_x,
            {{a, b, cw}, {-a, -b, cw}, {b, a, ccw}, {-a, b, ccw}, {a, -b, ccw}, {-b, -a, ccw}, {b, -a, cw}, {-b, a, cw}}},
        FrameCase{
            Frame::octo_plus,
            {{1, 0, cw}, {-1, 0, cw}, {s, s, ccw}, {-s, s, ccw}, {s, -s, ccw}, {-s, -s, ccw}, {0, -1, cw}, {0, 1, cw}}},
        FrameCase{
            Frame::octo_cox,
            {{s, s, ccw}, {s, -s, cw}, {-s, -s, ccw}, {-s, s, cw}, {s, -s, ccw}, {s, s, cw}, {-s, s, ccw}, {-s, -s, cw}}},
        FrameCase{Frame::dodeca_cox,
                  {{0, 1, ccw},
                   {0, -1, cw},
                   {h, -0.5, ccw},
                   {-h, 0.5, cw},
                   {h, 0.5, cw},
                   {-h, -0.5, ccw},
                   {0, 1, cw},
                   {0, -1, ccw},
                   {h, -0.5, cw},
                   {-h, 0.5, ccw},
                   {h, 0.5, ccw},
                   {-h, -0.5, cw}}}));

// A motor in front lifts the nose, one at the right lifts the right side, and a counter-clockwise one turns the vehicle
// clockwise: moments r x T and k T.
TEST_P(FrameTest, EachMotorTurnsTheVehicleItsWay) {
    CopterBody body = without_drag();
    set_frame(body, GetParam().frame, 0.2);
    ASSERT_EQ(body.rotor_count, GetParam().motors.size());
    for (std::size_t motor = 0; motor < body.rotor_count; ++motor) {
        const auto& [forward, right, turn] = GetParam().motors[motor];
        const High turning(body);
        turning.run(only(motor, 0.5), 0.004, 0.004);

        const double thrust = turning.plant->thrust() * 7.355 * static_cast<double>(body.rotor_count);
        const Vector3 expected(-right * 0.2 * thrust / 0.0368, forward * 0.2 * thrust / 0.0368,
                               turn * 0.041 * thrust / 0.06);
        EXPECT_LT((turning.motion().rates / 0.004 - expected).norm(), 1e-3 * expected.norm()) << "motor " << motor + 1;
        EXPECT_NEAR(turning.motion().acceleration.z(), gravity - thrust / 1.5, 1e-9);
    }
}

// The arms of Gazebo's iris differ in front and behind.
TEST(PlantTest, TheIrisHasItsOwnGeometry) {
    const CopterBody body = body_of(BodyPreset::iris);
    std::vector<double> places;
    for (const Rotor& rotor : body.rotors) places.insert(places.end(), {rotor.forward_m, rotor.right_m, rotor.turn});
    places.resize(12);
    EXPECT_THAT(places, ElementsAreArray({0.13, 0.22, 1.0, -0.13, -0.20, 1.0, 0.13, -0.22, -1.0, -0.13, 0.20, -1.0}));
    EXPECT_NEAR(body.thrust_n, 7.066, 1e-3);
}

// The angular momentum of a free body stays the same in the local frame, also while the body wobbles.
TEST(PlantTest, KeepsItsAngularMomentum) {
    CopterBody body = without_drag();
    body.inertia_kg_m2 = {0.02, 0.04, 0.06};
    const High free(body);
    free.run({0.3, 0.7, 0.9, 0.4}, 0.05);
    free.run(stopped, 0.5);
    const Vector3 inertia(0.02, 0.04, 0.06);
    const auto momentum = [&] { return Vector3(free.motion().attitude * inertia.cwiseProduct(free.motion().rates)); };
    const Vector3 before = momentum(), rates = free.motion().rates;
    free.run(stopped, 1, 0.0001);

    EXPECT_GT((free.motion().rates - rates).norm(), 0.05 * rates.norm());
    EXPECT_LT((momentum() - before).norm(), 0.01 * before.norm());
}

TEST(PlantTest, TheBatteryScalesThrustAndMoments) {
    High full(without_drag()), weak(without_drag());
    weak.around.supply = 0.8;
    for (const High* const body : {&full, &weak}) body->run(only(0, 1), 0.004, 0.004);

    const double fall = gravity;
    EXPECT_NEAR(fall - weak.motion().acceleration.z(), 0.8 * (fall - full.motion().acceleration.z()), 1e-9);
    EXPECT_LT((weak.motion().rates - 0.8 * full.motion().rates).norm(), 1e-9);
}

TEST(PlantTest, OutputsBeyondTheirRangeCountAsItsLimits) {
    for (const Kind kind : {Kind::quad, Kind::plane, Kind::rover}) {
        const High wild(kind), tame(kind);
        wild.run({nan, -1e300, 1e9, -nan}, 0.5, 0.004);
        const double least = kind == Kind::quad ? 0 : -1;
        tame.run({0, least, 1, 0}, 0.5, 0.004);
        EXPECT_EQ(wild.motion().velocity, tame.motion().velocity);
        EXPECT_EQ(wild.motion().attitude.coeffs(), tame.motion().attitude.coeffs());
    }
}

TEST(PlantTest, RestsOnTheGroundAndLiftsWithMoreThanItsWeight) {
    Multicopter copter{CopterBody()};
    copter.place(Vector3::Zero(), 1);
    for (int i = 0; i < 500; ++i) copter.step(all(0.02), {}, 0.004);
    EXPECT_EQ(copter.motion().acceleration, Vector3::Zero());
    EXPECT_EQ(copter.motion().position, Vector3::Zero());
    EXPECT_TRUE(copter.touches_ground());

    for (int i = 0; i < 500; ++i) copter.step(all(0.48), {}, 0.004);
    EXPECT_TRUE(copter.touches_ground());
    for (int i = 0; i < 500; ++i) copter.step(all(0.55), {}, 0.004);
    EXPECT_FALSE(copter.touches_ground());
    EXPECT_LT(copter.motion().position.z(), -0.5);
}

// The motor follows within 0.15 s. Its thrust grows with the square of its speed, from 12 N at rest to 0 at 40 m/s. It
// pulls 1.5 kg, on wheels with a friction of 0.04.
TEST(PlantTest, APlaneRollsOffUnderItsThrust) {
    const auto plane = make_plant(Kind::plane, {});
    plane->place(Vector3::Zero(), 0);
    for (int i = 0; i < 250; ++i) plane->step(stopped, {.wind = {0, 10, 0}}, 0.004);
    EXPECT_EQ(plane->motion().position, Vector3::Zero());
    for (int i = 0; i < 125; ++i) plane->step({0, 0, 1, 0}, {}, 0.004);

    const double motor = 1 - std::exp(-0.5 / 0.15), speed = plane->motion().velocity.x();
    const double thrust = 12 * motor * motor * (1 - speed / 40);
    EXPECT_GT(speed, 2);
    EXPECT_NEAR(plane->motion().acceleration.x(), thrust / 1.5 - 0.04 * gravity, 0.15);
    EXPECT_NEAR(plane->motion().velocity.y(), 0, 1e-9);
}

// Steady roll at full ailerons: 0.088 / 0.5 * 2 V / span.
TEST(PlantTest, APlanesControlsTurnItTheirWay) {
    const High plane(Kind::plane);
    plane.run({0, 0, 0.5, 0}, 8, 0.004);  // falls into a glide
    const auto rates_with = [&](const Outputs& outputs) {
        const Vector3 before = plane.motion().rates;
        plane.run(outputs, 0.1, 0.004);
        return Vector3(plane.motion().rates - before);
    };
    EXPECT_GT(rates_with({0, 0.5, 0.5, 0}).y(), 0.1);
    EXPECT_LT(rates_with({0, -0.5, 0.5, 0}).y(), -0.1);
    EXPECT_GT(rates_with({0, 0, 0.5, 1}).z(), 0.1);
    EXPECT_LT(rates_with({0, 0, 0.5, -1}).z(), -0.1);
    EXPECT_LT(rates_with({-0.5, 0, 0.5, 0}).x(), -0.5);
    plane.run({1, 0, 0.5, 0}, 0.3, 0.004);
    const double speed = plane.airspeed();
    EXPECT_NEAR(plane.motion().rates.x(), 0.088 / 0.5 * 2 * speed / 1.67, 0.05 * plane.motion().rates.x());
}

// v = v_max (1 - exp(-t a / v_max)), with 10 m/s and 15 m/s^2.
TEST(PlantTest, ARoversSpeedFollowsItsMotor) {
    const auto rover = make_plant(Kind::rover, {});
    rover->place(Vector3::Zero(), 0);
    for (int i = 0; i < 250; ++i) rover->step({0.5, 0}, {}, 0.002);
    EXPECT_NEAR(rover->motion().velocity.x(), 5 * (1 - std::exp(-0.75)), 0.01);
    for (int i = 0; i < 5000; ++i) rover->step({-0.1, -1}, {}, 0.002);
    EXPECT_NEAR(rover->motion().velocity.norm(), 1, 1e-3);
    EXPECT_NEAR(rover->motion().rates.z(), 1 / 0.8, 1e-3);  // backwards with the wheels to the left: clockwise
}

}  // namespace
}  // namespace mavloom::flight
