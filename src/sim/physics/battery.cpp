// SPDX-License-Identifier: MIT
#include "sim/physics/battery.hpp"

#include <algorithm>

namespace mavloom::sim {

namespace {

// A lithium-polymer cell: 4.2 V full to 3.5 V empty at rest, and its resistance.
constexpr double full_cell = 4.2, empty_cell = 3.5;  // V
constexpr double cell_resistance = 0.004;            // ohm
constexpr double average_tau = 10;                   // s

}  // namespace

Battery::Battery(const BatteryOptions& options) noexcept
    : capacity_mah_(options.capacity_mah),
      hover_current_(options.capacity_mah / 1000 * 60 / options.hover_minutes),
      used_mah_(options.capacity_mah * (1 - options.start_percent / 100)),
      cells_(options.cells) {}

void Battery::step(double load, double dt) noexcept {
    current_ = remaining() <= 0 ? 0 : idle_current_ + load * hover_current_;
    average_current_ += (current_ - average_current_) * dt / average_tau;
    used_mah_ = std::min(used_mah_ + current_ * dt / 3.6, capacity_mah_);
    used_joule_ += current_ * voltage() * dt;
}

double Battery::remaining() const noexcept { return std::max(0.0, 1 - used_mah_ / capacity_mah_); }

double Battery::voltage() const noexcept {
    const double at_rest = empty_cell + (full_cell - empty_cell) * remaining();
    return cells_ * (at_rest - current_ * cell_resistance);
}

double Battery::seconds_left() const noexcept {
    if (average_current_ <= 2 * idle_current_) return 0;
    return (capacity_mah_ - used_mah_) * 3.6 / average_current_;
}

double Battery::supply() const noexcept { return voltage() / (cells_ * full_cell); }

}  // namespace mavloom::sim
