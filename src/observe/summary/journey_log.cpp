// SPDX-License-Identifier: MIT
#include "observe/summary/journey_log.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mavloom::observe {

namespace {

// On a sphere, which is within 0.6 % of the ellipsoid; good for points that are a few km apart.
double metres_between(const Fix& a, const Fix& b) noexcept {
    constexpr double metres_per_degree = 6'371'008.8 * std::numbers::pi / 180;  // mean radius, IUGG
    const double middle = (a.lat_deg + b.lat_deg) / 2 * std::numbers::pi / 180;
    const double east = std::remainder(b.lon_deg - a.lon_deg, 360.0) * std::cos(middle);
    return std::hypot(b.lat_deg - a.lat_deg, east) * metres_per_degree;
}

// Farther than a vehicle moves: a glitch of the GPS, or another flight in the same file.
bool is_jump(double metres, Nanoseconds time) noexcept {
    constexpr double always_possible = 1000, fastest_m_s = 1000;
    return metres > always_possible && metres > fastest_m_s * std::chrono::duration<double>(time).count();
}

void raise_to(std::optional<double>& highest, std::optional<double> value) noexcept {
    if (value) highest = std::max(highest.value_or(*value), *value);
}

}  // namespace

void JourneyLog::add(const Fix& fix, std::optional<double> speed_m_s, bool is_flown, bool with_track) {
    if (!journey_.first) journey_.first = anchor_ = fix;
    journey_.last = fix;
    raise_to(journey_.highest_alt_m, fix.alt_m);
    raise_to(journey_.highest_relative_alt_m, fix.relative_alt_m);
    raise_to(journey_.highest_speed_m_s, speed_m_s);
    const bool jumped = move_to(fix, is_flown);
    if (with_track) add_point(fix, jumped);
}

// Returns whether the position jumped. Steps of less than a metre wait for more, so that noise adds nothing.
bool JourneyLog::move_to(const Fix& fix, bool is_flown) noexcept {
    const double step = metres_between(anchor_, fix);
    if (step < 1) return false;
    const bool jumped = is_jump(step, fix.when.at - anchor_.when.at);
    if (is_flown && !jumped) journey_.distance_m += step;
    anchor_ = fix;
    return jumped;
}

void JourneyLog::add_point(const Fix& fix, bool jumped) {
    auto& track = journey_.track;
    const auto gap = fix.when.at - last_point_;
    if (!track.empty() && !jumped && gap < interval_) return;
    const auto whole = [](double value, double scale) { return static_cast<std::int32_t>(std::lround(value * scale)); };
    track.push_back({.time = fix.when.time,
                     .lat_deg_e7 = whole(fix.lat_deg, 1e7),
                     .lon_deg_e7 = whole(fix.lon_deg, 1e7),
                     .alt_mm = whole(fix.alt_m, 1e3),
                     .begins = track.empty() || jumped || gap > std::max(longest_gap, 2 * interval_)});
    last_point_ = fix.when.at;
    if (track.size() == max_points) thin_out();
}

void JourneyLog::thin_out() {
    auto& track = journey_.track;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < track.size(); ++i)
        if (i % 2 == 0 || track[i].begins) track[kept++] = track[i];
    track.resize(kept);
    interval_ *= 2;
}

}  // namespace mavloom::observe
