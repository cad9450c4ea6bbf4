// SPDX-License-Identifier: MIT
#include "sim/physics/sensors.hpp"

namespace mavloom::sim {

Sensors::Sensors(bool has_noise, std::uint64_t seed)
    : random_(seed),
      has_noise_(has_noise),
      position_wander_{GaussMarkov(0.03, 10, step_s), GaussMarkov(0.03, 10, step_s), GaussMarkov(0.03, 10, step_s)},
      attitude_wander_{GaussMarkov(0.002, 5, step_s), GaussMarkov(0.002, 5, step_s), GaussMarkov(0.005, 10, step_s)},
      gps_position_{GaussMarkov(0.025, 0.5, 0.125), GaussMarkov(0.025, 0.5, 0.125), GaussMarkov(0.04, 0.5, 0.125)},
      gps_velocity_{GaussMarkov(0.024, 0.2, 0.125), GaussMarkov(0.024, 0.2, 0.125), GaussMarkov(0.03, 0.2, 0.125)} {}

void Sensors::step(const Kinematics& truth, const Vector3& /*air_velocity*/, bool at_rest, double /*origin_altitude*/,
                   double /*air_density*/) {
    step_estimate(truth, at_rest);
}

void Sensors::step_estimate(const Kinematics& truth, bool /*at_rest*/) {
    estimate_ = {truth.position, truth.velocity, truth.acceleration, truth.attitude, to_euler(truth.attitude),
                 truth.rates, wrap_2pi(yaw_of(truth.attitude))};
}

bool Sensors::has_position() const noexcept { return gps_acquired_ && !failures_.gps_off; }

double Sensors::position_accuracy() const noexcept { return has_position() ? 0.3 : 50; }

}  // namespace mavloom::sim
