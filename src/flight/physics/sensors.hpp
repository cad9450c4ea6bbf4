// SPDX-License-Identifier: MIT
// The vehicle's measurements and estimates: its true motion with noise. Private to flight, sim and hil; single owner;
// nothing allocates.
//
// All noise advances with the steps, never with messages, so the telemetry of one client does not depend on another.
// The magnitudes are those of PX4's built-in simulator (docs/design/simulator.md).
#pragma once

#include <optional>

#include "flight/physics/estimate_error.hpp"
#include "flight/physics/failures.hpp"
#include "flight/physics/geodesy.hpp"
#include "flight/physics/noise.hpp"
#include "flight/plant/plant.hpp"
#include "mavloom/flight/noise_options.hpp"

namespace mavloom::flight {

// The vehicle's estimate of its own motion. The position is the sum of the velocity times the step.
struct Estimate {
    Vector3 position = Vector3::Zero(), velocity = Vector3::Zero(), acceleration = Vector3::Zero();
    Quaternion attitude = Quaternion::Identity();
    Euler euler;
    Vector3 rates = Vector3::Zero();
    double heading = 0;  // rad, 0 to 2 pi
};

struct ImuSample {
    Vector3 acceleration = Vector3::Zero();  // specific force, m/s^2, body frame
    Vector3 rates = Vector3::Zero();         // rad/s
    Vector3 magnetic = Vector3::Zero();      // gauss, body frame
    double pressure_hpa = 0, differential_hpa = 0, pressure_altitude = 0, temperature_c = 0;
};

struct GpsFix {
    Vector3 position = Vector3::Zero(), velocity = Vector3::Zero();  // local frame, as measured last
    std::uint8_t fix_type = 0;                                       // GPS_FIX_TYPE
    std::uint8_t satellites = 0;
    double hdop = 0, vdop = 0;
    double horizontal_m = 0, vertical_m = 0, speed_m_s = 0;  // accuracies
};

// How long a step is, and how many steps lie between two samples: at least 1, on average. With 2.5, every other sample
// comes after 2 steps, and the rest after 3.
struct SensorTiming {
    double step_s = flight::step_s;
    double magnetometer = 5;  // 50 Hz
    double barometer = 12.5;  // 20 Hz
    double gps = 31.25;       // 8 Hz
};
// The sensors that took a sample in the last step. All others show an older one.
struct SensorSamples {
    bool magnetometer = false, barometer = false, gps = false;
};

class Sensors {
public:
    // Without `noise`, measurements are exact. `magnetic_field` in gauss; north, east, down. It does not change:
    // vehicles do not fly far.
    Sensors(const std::optional<NoiseOptions>& noise, std::uint64_t seed, const Vector3& magnetic_field,
            const SensorTiming& timing = {});

    // Call it after each step of the plant, and once before the first. `origin_altitude` is the altitude (AMSL, m)
    // of the local origin.
    void step(const Kinematics& truth, const Vector3& air_velocity, bool at_rest, double origin_altitude,
              double air_density);
    // Like Plant::move_origin.
    void move_origin(const Vector3& by);
    void set_failures(const Failures& failures) noexcept { failures_ = failures; }
    [[nodiscard]] const Failures& failures() const noexcept { return failures_; }
    // A drift begins at 0, and ends with its deception.
    void set_deceptions(const Deceptions& deceptions);
    // Of the estimate, by measurements that are wrong on purpose.
    [[nodiscard]] Vector3 estimate_error() const { return horizontal_error_.value() + vertical_error_.value(); }
    [[nodiscard]] Vector3 estimate_error_rate() const { return horizontal_error_.rate() + vertical_error_.rate(); }
    [[nodiscard]] bool is_deceived() const noexcept { return is_deceived_; }
    // The estimator starts anew, after a boot.
    void restart_estimate();
    // Sets whether GPS has a fix. Without one, fix_type is 1.
    void acquire_gps(bool acquired) noexcept { gps_acquired_ = acquired; }

    [[nodiscard]] const Estimate& estimate() const noexcept { return estimate_; }
    [[nodiscard]] const ImuSample& imu() const noexcept { return imu_; }
    [[nodiscard]] const SensorSamples& samples() const noexcept { return samples_; }
    [[nodiscard]] const GpsFix& gps() const noexcept { return gps_; }
    [[nodiscard]] bool has_position() const noexcept;
    // Estimated standard deviations for covariance and accuracy fields, m and m/s.
    [[nodiscard]] double position_accuracy() const noexcept;
    [[nodiscard]] double velocity_accuracy() const noexcept { return 0.05; }
    // Vibration level of the accelerometer, m/s^2.
    [[nodiscard]] double vibration() const noexcept { return vibration_; }

private:
    using Wander3 = std::array<SmoothWander, 3>;

    void step_imu(const Kinematics& truth);
    void step_vibration(bool at_rest);
    void step_bias();
    void step_magnetometer(const Quaternion& attitude);
    void step_barometer(const Kinematics& truth, const Vector3& air_velocity, double altitude, double air_density);
    void step_gps(const Kinematics& truth);
    void step_estimate(const Kinematics& truth, double share);
    void step_deceptions();
    void step_airspeed(double along, double air_density);
    [[nodiscard]] Vector3 gps_error() const { return deceptions_.gps_jump + gps_drifted_; }
    [[nodiscard]] double barometer_error() const { return deceptions_.barometer_offset + barometer_drifted_; }
    [[nodiscard]] Vector3 noise(const Vector3& sigma);

    Random random_;
    Vector3 magnetic_field_;
    SensorTiming timing_;
    SensorSamples samples_;
    bool has_noise_, gps_acquired_ = false;
    NoiseOptions noise_;
    Failures failures_;
    Deceptions deceptions_;
    bool is_deceived_ = false;  // or was, and the estimate still is
    Vector3 gps_drifted_ = Vector3::Zero();
    double barometer_drifted_ = 0;
    EstimateError horizontal_error_, vertical_error_;
    double open_pitot_ = 1;  // share of the pressure that arrives
    Wander3 position_wander_, attitude_wander_;
    std::array<GaussMarkov, 3> gps_position_, gps_velocity_;
    std::array<RandomWalk, 3> gyroscope_bias_;
    ExponentialDecay impact_;  // of a touchdown
    bool rested_ = true;
    Estimate estimate_;
    ImuSample imu_;
    GpsFix gps_;
    double vibration_ = 0;
    std::uint64_t steps_ = 0;
};

}  // namespace mavloom::flight
