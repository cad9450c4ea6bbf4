// SPDX-License-Identifier: MIT
// The kinds of noise that sensors and estimates have. Private to module sim. Each object holds one scalar process;
// `next` advances it by `dt` seconds and returns its value. Nothing allocates.
#pragma once

#include <cmath>

#include "sim/physics/random.hpp"

namespace mavloom::sim {

// Independent samples from [-half_width, half_width).
struct UniformNoise {
    double half_width = 0;
    [[nodiscard]] double next(Random& random) const noexcept { return random.uniform(-half_width, half_width); }
};

// Independent samples with standard deviation `sigma`.
struct GaussianNoise {
    double sigma = 0;
    [[nodiscard]] double next(Random& random) const noexcept { return sigma * random.normal(); }
};

// The integral of white noise. Its variance grows by `rate`^2 each second, without bound.
class RandomWalk {
public:
    explicit RandomWalk(double rate) noexcept : rate_(rate) {}
    [[nodiscard]] double next(Random& random, double dt) noexcept {
        return value_ += rate_ * std::sqrt(dt) * random.normal();
    }
    [[nodiscard]] double value() const noexcept { return value_; }

private:
    double rate_, value_ = 0;
};

// First-order Gauss-Markov process: correlated over `tau` seconds, with steady standard deviation `sigma`. Exact for
// any step. `derivative` is the rate of change over the last step, for a position whose velocity must agree with it.
class GaussMarkov {
public:
    GaussMarkov(double sigma, double tau, double dt) noexcept
        : decay_(std::exp(-dt / tau)), drive_(sigma * std::sqrt(1 - decay_ * decay_)), per_second_(1 / dt) {}
    double next(Random& random) noexcept {
        const double last = value_;
        value_ = decay_ * value_ + drive_ * random.normal();
        derivative_ = (value_ - last) * per_second_;
        return value_;
    }
    [[nodiscard]] double value() const noexcept { return value_; }
    [[nodiscard]] double derivative() const noexcept { return derivative_; }

private:
    double decay_, drive_, per_second_, value_ = 0, derivative_ = 0;
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
    ExponentialDecay(double tau, double dt) noexcept : decay_(std::exp(-dt / tau)) {}
    void kick(double amount) noexcept { value_ += amount; }
    double next() noexcept { return value_ *= decay_; }
    [[nodiscard]] double value() const noexcept { return value_; }

private:
    double decay_, value_ = 0;
};

}  // namespace mavloom::sim
