// SPDX-License-Identifier: MIT
#include "flight/physics/battery.hpp"

#include <algorithm>

namespace mavloom::flight {

namespace {

// A lithium-polymer cell: 4.2 V full to 3.5 V empty at rest, and its loss at the hover current. A battery of any size
// and endurance lifts its vehicle.
constexpr double full_cell = 4.2, empty_cell = 3.5;  // V
constexpr double loss_at_hover = 0.06;               // V
constexpr double average_tau = 10;                   // s
constexpr double standby_current = 0.3;              // A
constexpr double charge_rate = 0.05;                 // of the capacity, 1/s

}  // namespace

Battery::Battery(const BatteryOptions& options, bool charges_at_rest) noexcept
    : capacity_mah_(options.capacity_mah),
      hover_current_(options.capacity_mah / 1000 * 60 / options.hover_minutes),
      idle_current_(charges_at_rest ? standby_current : 0),
      charges_at_rest_(charges_at_rest),
      used_at_start_(options.capacity_mah * (1 - options.start_percent / 100)),
      used_mah_(used_at_start_),
      used_after_rest_(used_at_start_),
      cells_(options.cells) {}

void Battery::step(double load, double dt) noexcept {
    current_ = charge() <= 0 ? 0 : idle_current_ + load * hover_current_;
    average_current_ += (current_ - average_current_) * dt / average_tau;
    used_mah_ = std::min(used_mah_ + current_ * dt / 3.6, capacity_mah_);
    used_joule_ += current_ * voltage() * dt;
}

void Battery::set_remaining(double share) noexcept {
    used_mah_ = used_after_rest_ = capacity_mah_ * (1 - std::clamp(share, 0.0, 1.0));
}

void Battery::rest(double dt) noexcept {
    if (!charges_at_rest_) return;
    used_mah_ = std::max(used_mah_ - charge_rate * capacity_mah_ * dt, std::min(used_mah_, used_after_rest_));
}

void Battery::restore() noexcept {
    if (used_after_rest_ != used_at_start_) used_mah_ = used_after_rest_ = used_at_start_;
}

void Battery::replace() noexcept {
    used_mah_ = used_after_rest_ = used_at_start_;
    used_joule_ = current_ = average_current_ = 0;
}

double Battery::charge() const noexcept { return std::max(0.0, 1 - used_mah_ / capacity_mah_); }

double Battery::voltage() const noexcept {
    const double at_rest = empty_cell + (full_cell - empty_cell) * charge();
    return cells_ * (at_rest - current_ / hover_current_ * loss_at_hover);
}

double Battery::seconds_left() const noexcept {
    if (average_current_ <= 2 * standby_current) return 0;
    return (capacity_mah_ - used_mah_) * 3.6 / average_current_;
}

double Battery::supply() const noexcept { return charge() > 0 ? voltage() / (cells_ * full_cell) : 0; }

}  // namespace mavloom::flight
