// SPDX-License-Identifier: MIT
// Sources: PX4 src/modules/simulation/simulator_sih and sensor_*_sim; jMAVSim SimpleSensors.java; gazebo_imu_plugin,
// gazebo_magnetometer_plugin, gazebo_barometer_plugin and gazebo_gps_plugin of PX4-SITL_gazebo-classic. A density per
// square root of hertz is multiplied by the square root of our sample rate. Random walks that their code lets decay too
// fast stand with the deviations and times that they have in effect.
#include "mavloom/flight/noise_options.hpp"

namespace mavloom::flight {

NoiseOptions noise_of(NoisePreset preset) noexcept {
    switch (preset) {
        case NoisePreset::jmavsim:
            return {.accelerometer = 0.05,
                    .gyroscope = 0.01,
                    .magnetometer = 0.005,
                    .magnetometer_z = 0.005,
                    .pressure = 1.15,  // 0.1 m at 500 m above mean sea level
                    .gps = 0.01,
                    .gps_down = 0.01,
                    .gps_time = 0.12,
                    .gps_velocity = 0,
                    .gps_climb = 0};
        case NoisePreset::gazebo:
            return {.accelerometer = 0.101,  // 0.00637 m/s^2 per square root of hertz
                    .gyroscope = 0.0138,     // 8.7e-4 rad/s
                    .magnetometer = 0.0028,  // 4e-4 gauss
                    .magnetometer_z = 0.0028,
                    .gps = 0.003,
                    .gps_down = 0.006,
                    .gps_time = 0.24,
                    .gps_velocity = 0.013,
                    .gps_climb = 0.025,
                    .gps_velocity_time = 0};
        case NoisePreset::sih: return {.gyroscope = 0.01};
        case NoisePreset::standard: break;
    }
    return {};
}

}  // namespace mavloom::flight
