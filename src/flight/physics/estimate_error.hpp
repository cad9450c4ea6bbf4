// SPDX-License-Identifier: MIT
// How far an estimator follows measurements that are wrong. Private to flight; single owner; nothing allocates.
//
// It follows a small error within about half a second. An error beyond its gate it rejects; after 7 s without a good
// measurement it starts anew from what is measured. These are the rules of PX4's EKF2 in short.
#pragma once

#include "flight/plant/plant.hpp"

namespace mavloom::flight {

class EstimateError {
public:
    // Advances by a step. `measured` is the error of the measurement, m.
    void step(const Vector3& measured) {
        const Vector3 apart = measured - value_;
        rate_.setZero();
        if (apart.squaredNorm() > gate * gate) {
            rejected_s_ += step_s;
            if (rejected_s_ >= patience) restart(measured);
            return;
        }
        rejected_s_ = 0;
        rate_ = apart / tau;
        value_ += rate_ * step_s;
        if (apart.squaredNorm() < 1e-12) restart(measured);
    }
    // The estimator starts anew.
    void restart(const Vector3& measured) {
        value_ = measured;
        rejected_s_ = 0;
    }

    [[nodiscard]] const Vector3& value() const noexcept { return value_; }  // m
    [[nodiscard]] const Vector3& rate() const noexcept { return rate_; }    // m/s
    [[nodiscard]] bool any() const noexcept { return !value_.isZero(0); }

private:
    static constexpr double gate = 4.5;    // m; 5 deviations of 0.9 m, the accuracy of the simulated receiver
    static constexpr double patience = 7;  // s
    static constexpr double tau = 0.5;     // s

    Vector3 value_ = Vector3::Zero(), rate_ = Vector3::Zero();
    double rejected_s_ = 0;
};

}  // namespace mavloom::flight
