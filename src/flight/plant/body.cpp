// SPDX-License-Identifier: MIT
#include "mavloom/flight/body.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "flight/physics/math.hpp"
#include "flight/physics/rotation.hpp"

namespace mavloom::flight {

namespace {

// A rotor's direction from the centre, clockwise from the nose, and its sense of rotation (see Rotor).
struct RotorPlace {
    double bearing_deg, turn;
};
constexpr RotorPlace four[] = {{45, 1}, {-135, 1}, {-45, -1}, {135, -1}};
constexpr RotorPlace six[] = {{90, -1}, {-90, 1}, {-30, -1}, {150, 1}, {30, 1}, {-150, -1}};
constexpr RotorPlace eight[] = {{22.5, -1}, {-157.5, -1}, {67.5, 1},   {157.5, 1},
                                {-22.5, 1}, {-112.5, 1},  {-67.5, -1}, {112.5, -1}};
// Two rotors on each arm. PX4 numbers the upper ones of eight first, and the lower ones of twelve.
constexpr RotorPlace eight_on_four[] = {{45, 1},  {-45, -1}, {-135, 1}, {135, -1},
                                        {-45, 1}, {45, -1},  {135, 1},  {-135, -1}};
constexpr RotorPlace twelve_on_six[] = {{90, 1},  {-90, -1}, {-30, 1},  {150, -1}, {30, -1}, {-150, 1},
                                        {90, -1}, {-90, 1},  {-30, -1}, {150, 1},  {30, 1},  {-150, -1}};

// A plus frame is its X frame, turned until motor 1 is at the right (quad) or in front (others).
struct Layout {
    std::span<const RotorPlace> places;
    double turned_deg;
};
Layout layout_of(Frame frame) noexcept {
    switch (frame) {
        case Frame::quad_x: return {four, 0};
        case Frame::quad_plus: return {four, 45};
        case Frame::hexa_x: return {six, 0};
        case Frame::hexa_plus: return {six, -90};
        case Frame::octo_x: return {eight, 0};
        case Frame::octo_plus: return {eight, -22.5};
        case Frame::octo_cox: return {eight_on_four, 0};
        case Frame::dodeca_cox: return {twelve_on_six, 0};
    }
    return {four, 0};
}

// From the model of Gazebo classic. Its motors turn at 1100 rad/s at most, and at 100 rad/s when they idle.
CopterBody iris() {
    constexpr double fastest = 1100, slowest = 100;  // rad/s
    CopterBody body{.mass_kg = 1.55,
                    .inertia_kg_m2 = {0.0291, 0.0291, 0.0552},
                    .thrust_n = 5.84e-6 * fastest * fastest,
                    .moment_ratio_m = 0.06,
                    .spin_up_s = 0.0125,
                    .spin_down_s = 0.025,
                    .curve = 1,
                    .idle = slowest / fastest,
                    .drag = 0,
                    .rotor_drag = 1.75e-4 * fastest};
    body.rotors = {{{0.13, 0.22, 1}, {-0.13, -0.20, 1}, {0.13, -0.22, -1}, {-0.13, 0.20, -1}}};
    return body;
}

CopterBody jmavsim() {
    CopterBody body{.mass_kg = 0.8,
                    .inertia_kg_m2 = {0.005, 0.005, 0.009},
                    .thrust_n = 4,
                    .moment_ratio_m = 0.0125,
                    .spin_up_s = 0.005,
                    .spin_down_s = 0.005,
                    .drag = 0,
                    .square_drag = 0.01};
    set_frame(body, Frame::quad_x, 0.165);
    return body;
}

// The book gives moments per rad of deflection; full deflections are 30 degrees here. Thrust, stall and nose wheel are
// ours.
PlaneBody aerosonde() {
    constexpr double full = to_radians(30), aspect_ratio = 2.9 * 2.9 / 0.55;
    return {.mass_kg = 11,
            .inertia_kg_m2 = {0.824, 1.135, 1.759},
            .area_m2 = 0.55,
            .span_m = 2.9,
            .chord_m = 0.19,
            .lift_zero = 0.23,
            .lift_slope = 5.61,
            .stall_deg = 15,
            .drag_zero = 0.043,
            .induced = 1 / (pi * 0.9 * aspect_ratio),
            .side_slope = 0.83,
            .thrust_n = 60,
            .pitch_speed_m_s = 60,
            .roll_damping = 0.51,
            .pitch_damping = 38.21,
            .yaw_damping = 0.069,
            .pitch_stiffness = 2.74,
            .yaw_stiffness = 0.073,
            .trim_deg = to_degrees(0.0135 / 2.74),
            .full_ailerons = 0.17 * full,
            .full_elevator = 0.99 * full,
            .full_rudder = 0.069 * full,
            .turn_radius_m = 10};
}

// motorConstant times the square of maxRotVelocity; no thrust at 25 m/s (models/plane, gazebo_motor_model.cpp of
// PX4-SITL_gazebo-classic).
PlaneBody gazebo_plane() { return {.thrust_n = 8.54858e-6 * 3500 * 3500, .pitch_speed_m_s = 25, .spin_s = 0.02}; }

// From PX4's airframe 10045: mass, wheel base 0.321 m, steering angle 30 degrees, speed at full output. The thrust is
// ours.
RoverBody sih() {
    return {.mass_kg = 20, .thrust_n = 100, .top_speed_m_s = 3.2, .turn_radius_m = turn_radius(0.321, 30)};
}

}  // namespace

CopterBody body_of(BodyPreset preset) {
    switch (preset) {
        case BodyPreset::iris: return iris();
        case BodyPreset::jmavsim: return jmavsim();
        case BodyPreset::standard: break;
    }
    return {};
}

PlaneBody body_of(PlanePreset preset) {
    switch (preset) {
        case PlanePreset::aerosonde: return aerosonde();
        case PlanePreset::gazebo: return gazebo_plane();
        case PlanePreset::standard: break;
    }
    return {};
}

RoverBody body_of(RoverPreset preset) { return preset == RoverPreset::sih ? sih() : RoverBody{}; }

double turn_radius(double wheel_base_m, double steering_deg) noexcept {
    return wheel_base_m / math::tan(to_radians(steering_deg));
}

double highest_lift(const PlaneBody& body) noexcept {
    return body.lift_zero + body.lift_slope * to_radians(body.stall_deg);
}

double stall_speed(const PlaneBody& body) noexcept {
    return std::sqrt(2 * body.mass_kg * gravity / (sea_level_density * body.area_m2 * highest_lift(body)));
}

void set_frame(CopterBody& body, Frame frame, double arm_m) {
    const Layout layout = layout_of(frame);
    body.rotor_count = layout.places.size();
    body.rotors = {};
    for (std::size_t i = 0; i < body.rotor_count; ++i) {
        const double bearing = to_radians(layout.places[i].bearing_deg + layout.turned_deg);
        body.rotors[i] = {arm_m * math::cos(bearing), arm_m * math::sin(bearing), layout.places[i].turn};
    }
}

double arm_of(const CopterBody& body) {
    double longest = 0;
    for (const Rotor& rotor : std::span(body.rotors).first(body.rotor_count))
        longest = std::max(longest, math::hypot(rotor.forward_m, rotor.right_m));
    return longest;
}

}  // namespace mavloom::flight
