// SPDX-License-Identifier: MIT
// Parses the values of scenario keys. Private to module simserve; pure functions. Errors are `usage`.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "mavloom/base/result.hpp"
#include "mavloom/sim/flight.hpp"

namespace mavloom::simserve {

struct Range {
    double least, most;
    [[nodiscard]] constexpr bool has(double value) const noexcept { return value >= least && value <= most; }
};
// In degrees, and in metres above home.
inline constexpr Range latitude_range{-90, 90}, longitude_range{-180, 180}, takeoff_range{0.5, 10'000};
// A finite number within the range.
[[nodiscard]] SetupResult<double> parse_number(std::string_view text, Range range);
// "2026-11-29T12:00:00Z".
[[nodiscard]] SetupResult<WallTime> parse_utc(std::string_view text);
// The index of a word in a list.
[[nodiscard]] SetupResult<std::size_t> parse_choice(std::string_view text, std::span<const std::string_view> choices);

// "LAT,LON[,ALT[,HEADING]]" in degrees and metres above mean sea level; without these 489.4 and 0.
[[nodiscard]] SetupResult<sim::Home> parse_home(std::string_view text);
// "SPEED,DIR" or "SPEED,DIR,GUST": metres per second, and the direction that the wind comes from, in degrees.
[[nodiscard]] SetupResult<sim::Wind> parse_wind(std::string_view text);
// "capacity:5000,cells:4,minutes:20,start:100"; each part may be left out.
[[nodiscard]] SetupResult<sim::BatteryOptions> parse_battery(std::string_view text);
// "1,2,3": three numbers of the range.
[[nodiscard]] SetupResult<std::array<double, 3>> parse_three(std::string_view text, Range range);
using NamedPart = std::pair<std::string_view, std::string_view>;
// "NAME:VALUE,NAME:VALUE", in this order, each name once. With a `preset`, the first part may be a value alone: that is
// the name it gets.
[[nodiscard]] SetupResult<std::vector<NamedPart>> parse_named_parts(std::string_view text, std::string_view preset);
// The same, of numbers.
[[nodiscard]] SetupResult<std::vector<std::pair<std::string, double>>> parse_pairs(std::string_view text);

// The words between blanks.
[[nodiscard]] std::vector<std::string_view> words_of(std::string_view text);

}  // namespace mavloom::simserve
