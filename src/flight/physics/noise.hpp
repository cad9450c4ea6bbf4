// SPDX-License-Identifier: MIT
// The kinds of noise that sensors and estimates have, besides uniform and Gaussian samples (random.hpp). Private to
// flight. Each object holds one scalar process; `next` advances it by a step. Nothing allocates.
#pragma once

#include <cmath>

#include "flight/physics/math.hpp"
#include "flight/physics/random.hpp"

namespace mavloom::flight {

// The integral of white noise. Its variance grows by `rate`^2 each second, without bound.
class RandomWalk {
public:
    explicit RandomWalk(double rate) noexcept : rate_(rate) {}
    void next(Random& random, double dt) noexcept { value_ += rate_ * std::sqrt(dt) * random.normal(); }
    [[nodiscard]] double value() const noexcept { return value_; }

private:
    double rate_, value_ = 0;
};

// First-order Gauss-Markov process: correlated over `tau` seconds, with steady standard deviation `sigma`. Exact for
// any step. White noise if `tau` is 0.
class GaussMarkov {
public:
    GaussMarkov(double sigma, double tau, double dt) noexcept
        : decay_(tau > 0 ? math::exp(-dt / tau) : 0), drive_(sigma * std::sqrt(1 - decay_ * decay_)) {}
    void next(Random& random) noexcept { value_ = decay_ * value_ + drive_ * random.normal(); }
    [[nodiscard]] double value() const noexcept { return value_; }

private:
    double decay_, drive_, value_ = 0;
};

// A slow and smooth wander: a critically damped oscillator that white noise drives. `value` is exactly the sum of
// `rate` times the step. The steady standard deviation of `value` is `sigma`, that of `rate` is `sigma` / `tau`.
class SmoothWander {
public:
    SmoothWander(double sigma, double tau, double dt) noexcept
        : dt_(dt),
          pull_(dt / (tau * tau)),
          damping_(2 * dt / tau),
          drive_(2 * sigma * std::sqrt(dt / (tau * tau * tau))) {}
    // `share` scales the noise; the wander then calms down or grows within a few `tau`.
    void next(Random& random, double share = 1) noexcept {
        rate_ += share * drive_ * random.normal() - pull_ * value_ - damping_ * rate_;
        value_ += rate_ * dt_;
    }
    [[nodiscard]] double value() const noexcept { return value_; }
    [[nodiscard]] double rate() const noexcept { return rate_; }

private:
    double dt_, pull_, damping_, drive_, value_ = 0, rate_ = 0;
};

// A disturbance that fades: each `kick` adds to it, and it decays with time constant `tau`.
class ExponentialDecay {
public:
    ExponentialDecay(double tau, double dt) noexcept : decay_(math::exp(-dt / tau)) {}
    void kick(double amount) noexcept { value_ += amount; }
    void next() noexcept { value_ *= decay_; }
    [[nodiscard]] double value() const noexcept { return value_; }

private:
    double decay_, value_ = 0;
};

}  // namespace mavloom::flight
