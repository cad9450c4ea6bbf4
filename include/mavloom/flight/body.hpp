// SPDX-License-Identifier: MIT
// The body of a simulated multicopter as numbers: mass, inertia, rotors, drag. Plain values; nothing here checks them.
// docs/guide/sim.md lists the keys that set them. Axes: x forward, y right, z down, through the centre of mass.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace mavloom::flight {

// Where the rotors are. Their order and directions of rotation are those of PX4's airframe reference.
enum class Frame : std::uint8_t { quad_x, quad_plus, hexa_x, hexa_plus, octo_x, octo_plus };
// Sets of numbers: `standard` is Mavloom's own quadrotor; `iris` flies in Gazebo classic, `jmavsim` in jMAVSim.
enum class BodyPreset : std::uint8_t { standard, iris, jmavsim };

inline constexpr std::string_view frame_names[] = {"quad-x", "quad-plus", "hexa-x", "hexa-plus", "octo-x", "octo-plus"};
inline constexpr std::string_view body_names[] = {"standard", "iris", "jmavsim"};

struct Rotor {
    double forward_m = 0, right_m = 0;
    double turn = 1;  // 1: counter-clockwise seen from above, so that it turns the body clockwise; -1: clockwise
};

struct CopterBody {
    static constexpr std::size_t most_rotors = 8;

    double mass_kg = 1.5;
    std::array<double, 3> inertia_kg_m2{0.0368, 0.0368, 0.06};  // about x, y and z
    std::array<Rotor, most_rotors> rotors{{{0.15, 0.15, 1}, {-0.15, -0.15, 1}, {0.15, -0.15, -1}, {-0.15, 0.15, -1}}};
    std::size_t rotor_count = 4;
    double thrust_n = 7.355;        // of one motor at full output; 4 carry twice the weight
    double moment_ratio_m = 0.041;  // torque of a rotor, divided by its thrust
    double spin_up_s = 0.03;        // time constant of a motor that gets faster
    double spin_down_s = 0.03;      // of one that gets slower
    // A motor at the share s of its full speed has the share (1 - curve) s + curve s^2 of its full thrust, as by PX4's
    // THR_MDL_FAC.
    double curve = 0;
    double idle = 0;         // speed of a running motor at the least output, as a share of the full speed
    double drag = 0.3;       // N per m/s, in air of sea level
    double square_drag = 0;  // N per (m/s)^2, in air of sea level
    double rotor_drag = 0;   // N per m/s across a rotor at full speed
    double turn_drag = 0;    // N m per rad/s
};

[[nodiscard]] CopterBody body_of(BodyPreset preset);
// Puts the rotors on a circle around the centre of mass.
void set_frame(CopterBody& body, Frame frame, double arm_m);
// The distance of the farthest rotor from the centre of mass.
[[nodiscard]] double arm_of(const CopterBody& body);

}  // namespace mavloom::flight
