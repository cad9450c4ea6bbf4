// SPDX-License-Identifier: MIT
#include "hil/further_imus.hpp"

namespace mavloom::hil {

using flight::Vector3;

static constexpr std::uint64_t imu_stream = 0x696d7573;  // they draw from numbers of their own

FurtherImus::FurtherImus(const flight::VehicleOptions& options, unsigned imus)
    : noise_(options.has_noise ? std::optional(options.noise) : std::nullopt),
      random_(options.seed ^ imu_stream),
      samples_(imus - 1) {}

void FurtherImus::step(const flight::Kinematics& truth) {
    if (samples_.empty()) return;
    const Vector3 force = flight::specific_force(truth);
    for (Sample& sample : samples_) {
        sample.acceleration = shaken(force, noise_ ? noise_->accelerometer : 0);
        sample.rates = shaken(truth.rates, noise_ ? noise_->gyroscope : 0);
    }
}

Vector3 FurtherImus::shaken(const Vector3& value, double sigma) {
    const double x = random_.normal(), y = random_.normal(), z = random_.normal();
    return value + sigma * Vector3(x, y, z);
}

}  // namespace mavloom::hil
