// SPDX-License-Identifier: MIT
// The noise of a simulated vehicle's sensors as numbers: one standard deviation of a sample each. Plain values.
// docs/guide/sim.md lists the keys that set them.
#pragma once

#include <cstdint>
#include <string_view>

namespace mavloom::flight {

// Sets of numbers: `sih` is that of PX4's built-in simulator, `standard` the same with half of the gyroscope's noise;
// `jmavsim` and `gazebo` are those of jMAVSim and of Gazebo classic's iris.
enum class NoisePreset : std::uint8_t { standard, sih, jmavsim, gazebo };
inline constexpr std::string_view noise_names[] = {"standard", "sih", "jmavsim", "gazebo"};

struct NoiseOptions {
    double accelerometer = 0.1;  // m/s^2, 250 samples a second
    double gyroscope = 0.005;    // rad/s, the same; at 0.01, PX4 believes that a standing plane turns
    double magnetometer = 0.02;  // gauss, along x and y, 50 samples a second
    double magnetometer_z = 0.03;
    double pressure = 1;    // Pa, of the barometer, 20 samples a second
    double airspeed = 0.2;  // m/s
    // Of the satellite receiver, correlated over a time; 8 samples a second.
    double gps = 0.025, gps_down = 0.037;            // m
    double gps_time = 0.45;                          // s
    double gps_velocity = 0.024, gps_climb = 0.029;  // m/s
    double gps_velocity_time = 0.2;                  // s; 0: samples are independent
};

[[nodiscard]] NoiseOptions noise_of(NoisePreset preset) noexcept;

}  // namespace mavloom::flight
