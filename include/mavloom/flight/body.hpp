// SPDX-License-Identifier: MIT
// The body of a simulated vehicle as numbers: mass, inertia, rotors, wings, wheels. Plain values; nothing here checks
// them. docs/guide/sim.md lists the keys that set them. Axes: x forward, y right, z down, through the centre of mass.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string_view>

namespace mavloom::flight {

inline constexpr double sea_level_density = 1.225;  // kg/m^3, of the standard atmosphere

// Where the rotors are. Their order and directions of rotation are those of PX4's airframe reference.
enum class Frame : std::uint8_t { quad_x, quad_plus, hexa_x, hexa_plus, octo_x, octo_plus, octo_cox, dodeca_cox };
// Sets of numbers: `standard` is Mavloom's own quadrotor; `iris` flies in Gazebo classic, `jmavsim` in jMAVSim.
enum class BodyPreset : std::uint8_t { standard, iris, jmavsim };
// `standard` is Mavloom's own plane; `aerosonde` is the example of Beard and McLain, "Small Unmanned Aircraft" (2012);
// `gazebo` is the standard plane with the motor of Gazebo classic's, which PX4's airframe 1030 is tuned for.
enum class PlanePreset : std::uint8_t { standard, aerosonde, gazebo };
// `standard` is Mavloom's own rover; `sih` has the size and the speed of the rover in PX4's own simulator.
enum class RoverPreset : std::uint8_t { standard, sih };

inline constexpr std::string_view frame_names[] = {"quad-x", "quad-plus", "hexa-x",   "hexa-plus",
                                                   "octo-x", "octo-plus", "octo-cox", "dodeca-cox"};
inline constexpr std::string_view body_names[] = {"standard", "iris", "jmavsim"};
inline constexpr std::string_view plane_names[] = {"standard", "aerosonde", "gazebo"};
inline constexpr std::string_view rover_names[] = {"standard", "sih"};

struct Rotor {
    double forward_m = 0, right_m = 0;
    double turn = 1;  // 1: counter-clockwise seen from above, so that it turns the body clockwise; -1: clockwise
};

struct CopterBody {
    static constexpr std::size_t max_rotors = 12;  // as PX4 has

    double mass_kg = 1.5;
    std::array<double, 3> inertia_kg_m2{0.0368, 0.0368, 0.06};  // about x, y and z
    std::array<Rotor, max_rotors> rotors{{{0.15, 0.15, 1}, {-0.15, -0.15, 1}, {0.15, -0.15, -1}, {-0.15, 0.15, -1}}};
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

// Coefficients refer to the wing's area and, for moments, to its span (roll, yaw) or chord (pitch). The standard plane
// stalls at 7 m/s and cruises at 15.
struct PlaneBody {
    double mass_kg = 1.5;
    std::array<double, 3> inertia_kg_m2{0.09, 0.07, 0.15};  // about x, y and z
    double area_m2 = 0.4, span_m = 1.67, chord_m = 0.24;    // of the wing
    double lift_zero = 0.15;                                // lift coefficient at no angle of attack
    double lift_slope = 4.5;                                // per rad, up to the stall
    double stall_deg = 13;                                  // angle of attack
    double drag_zero = 0.03;                                // drag coefficient without lift
    // Drag coefficient per square of the lift coefficient; this one is that of an aspect ratio of 7.
    double induced = 1 / (std::numbers::pi * 0.8 * 7);
    double side_slope = 0.6;      // side force coefficient, per rad of slip
    double thrust_n = 12;         // at rest, full output
    double pitch_speed_m_s = 40;  // at which the propeller has no thrust left
    double spin_s = 0.15;         // time constant of the motor
    double roll_damping = 0.5, pitch_damping = 15, yaw_damping = 0.12;
    double pitch_stiffness = 0.6, yaw_stiffness = 0.05;                     // per rad of attack and slip
    double trim_deg = 2.5;                                                  // angle of attack with a centred elevator
    double full_ailerons = 0.088, full_elevator = 0.3, full_rudder = 0.03;  // moment coefficients
    double turn_radius_m = 5;                                               // of the nose wheel at full deflection
};

struct RoverBody {
    double mass_kg = 5;
    double thrust_n = 75;        // of the wheels at rest, full output
    double top_speed_m_s = 10;   // at full output
    double turn_radius_m = 0.8;  // at full steering
    double grip_m_s2 = 4;        // acceleration that the tyres hold sideways
    double steering_lag_s = 0.15;
};

// Only the body of the vehicle's kind is used.
struct Body {
    CopterBody copter{};
    PlaneBody plane{};
    RoverBody rover{};
};

[[nodiscard]] CopterBody body_of(BodyPreset preset);
[[nodiscard]] PlaneBody body_of(PlanePreset preset);
[[nodiscard]] RoverBody body_of(RoverPreset preset);
// The tightest turn, in metres, of a rover whose front wheels turn by up to `steering_deg`.
[[nodiscard]] double turn_radius(double wheel_base_m, double steering_deg) noexcept;
// The highest lift coefficient: that at the stall.
[[nodiscard]] double highest_lift(const PlaneBody& body) noexcept;
// The lowest airspeed at which the plane can fly level at sea level, in m/s.
[[nodiscard]] double stall_speed(const PlaneBody& body) noexcept;
// Puts the rotors on a circle around the centre of mass.
void set_frame(CopterBody& body, Frame frame, double arm_m);
// The distance of the farthest rotor from the centre of mass.
[[nodiscard]] double arm_of(const CopterBody& body);

}  // namespace mavloom::flight
