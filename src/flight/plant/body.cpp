// SPDX-License-Identifier: MIT
#include "mavloom/flight/body.hpp"

#include <algorithm>
#include <cmath>
#include <span>

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

}  // namespace

CopterBody body_of(BodyPreset preset) {
    switch (preset) {
        case BodyPreset::iris: return iris();
        case BodyPreset::jmavsim: return jmavsim();
        case BodyPreset::standard: break;
    }
    return {};
}

void set_frame(CopterBody& body, Frame frame, double arm_m) {
    const Layout layout = layout_of(frame);
    body.rotor_count = layout.places.size();
    body.rotors = {};
    for (std::size_t i = 0; i < body.rotor_count; ++i) {
        const double bearing = to_radians(layout.places[i].bearing_deg + layout.turned_deg);
        body.rotors[i] = {arm_m * std::cos(bearing), arm_m * std::sin(bearing), layout.places[i].turn};
    }
}

double arm_of(const CopterBody& body) {
    double longest = 0;
    for (const Rotor& rotor : std::span(body.rotors).first(body.rotor_count))
        longest = std::max(longest, std::hypot(rotor.forward_m, rotor.right_m));
    return longest;
}

}  // namespace mavloom::flight
