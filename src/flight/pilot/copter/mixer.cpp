// SPDX-License-Identifier: MIT
#include "flight/pilot/copter/mixer.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace mavloom::flight {

namespace {

using Columns = Eigen::Matrix<double, 4, Eigen::Dynamic, 0, 4, CopterBody::max_rotors>;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, 4, 0, CopterBody::max_rotors, 4>;

constexpr double max_yaw = 0.15;  // share of the outputs that yaw may take

// The effect of each motor's full thrust on the body: roll, pitch and yaw in rad/s^2, thrust in m/s^2.
Columns effects_of(const CopterBody& body) {
    const auto& inertia = body.inertia_kg_m2;
    Columns effects(4, body.rotor_count);
    for (std::size_t i = 0; i < body.rotor_count; ++i) {
        const Rotor& rotor = body.rotors[i];
        effects.col(static_cast<Eigen::Index>(
            i)) = body.thrust_n * Eigen::Vector4d(-rotor.right_m / inertia[0], rotor.forward_m / inertia[1],
                                                  rotor.turn * body.moment_ratio_m / inertia[2], 1 / body.mass_kg);
    }
    return effects;
}

}  // namespace

Mixer::Mixer(const CopterBody& body) : count_(body.rotor_count), curve_(body.curve), idle_(body.idle) {
    const Columns effects = effects_of(body);
    const Eigen::Matrix4d square = effects * effects.transpose();
    const Rows shares = effects.transpose() * square.inverse();
    const Eigen::RowVector4d largest = shares.cwiseAbs().colwise().maxCoeff();
    for (std::size_t i = 0; i < count_; ++i) {
        const Eigen::RowVector4d row = shares.row(static_cast<Eigen::Index>(i)).cwiseQuotient(largest);
        factors_[i] = {row[0], row[1], row[2], row[3]};
    }
    full_moment_ = largest.head<3>().cwiseInverse().transpose();
    full_thrust_ = 1 / largest[3];
}

const Outputs& Mixer::mix(const Moments& wanted) noexcept {
    const double yaw = std::clamp(wanted.yaw, -max_yaw, max_yaw);
    double largest = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        const Moments& factor = factors_[i];
        outputs_[i] = factor.thrust * wanted.thrust + factor.roll * wanted.roll + factor.pitch * wanted.pitch +
                      factor.yaw * yaw;
        largest = std::max(largest, outputs_[i]);
    }
    const double shift = std::min(1 - largest, 0.0);
    for (std::size_t i = 0; i < count_; ++i) outputs_[i] = output_for(std::clamp(outputs_[i] + shift, 0.0, 1.0));
    return outputs_;
}

// The output at which a motor has this share of its thrust: the inverse of the motor's curve.
double Mixer::output_for(double thrust) const noexcept {
    if (curve_ == 0 && idle_ == 0) return thrust;
    const double linear = 1 - curve_;
    const double speed = curve_ == 0 ? thrust
                                     : (std::sqrt(linear * linear + 4 * curve_ * thrust) - linear) / (2 * curve_);
    return std::max(0.0, (speed - idle_) / (1 - idle_));
}

}  // namespace mavloom::flight
