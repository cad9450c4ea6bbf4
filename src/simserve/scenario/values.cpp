// SPDX-License-Identifier: MIT
#include "simserve/scenario/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include "mavloom/base/shown.hpp"
#include "mavloom/base/suggest.hpp"
#include "mavloom/base/text.hpp"
#include "mavloom/dialect/terms.hpp"
#include "mavloom/endpoint/grammar.hpp"

namespace mavloom::simserve {

namespace {

using endpoint::usage;

constexpr Range altitude_range{-500, 20'000}, heading_range{0, 360}, speed_range{0, 60};

SetupResult<std::vector<double>> parse_list(std::string_view text, std::span<const Range> ranges,
                                            std::span<const std::string_view> names) {
    std::vector<double> values;
    const auto add = [&](std::string_view part) -> SetupResult<void> {
        if (values.size() == ranges.size()) return usage(fmt::format("{} is one value too many", in_quotes(part)));
        const auto value = parse_number(trimmed(part), ranges[values.size()]);
        if (!value) return tl::unexpected(SetupError(value.error()).within(names[values.size()]));
        values.push_back(*value);
        return {};
    };
    if (auto done = dialect::for_each_term(text, add); !done) return tl::unexpected(std::move(done.error()));
    return values;
}

constexpr std::array<std::string_view, 4> battery_keys{"capacity", "cells", "minutes", "start"};
constexpr std::array battery_ranges{Range{100, 1'000'000}, Range{1, 14}, Range{0.1, 10'000}, Range{1, 100}};

}  // namespace

SetupResult<double> parse_number(std::string_view text, Range range) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !range.has(value))
        return usage(fmt::format("{} is not a number from {} to {}", in_quotes(text), range.least, range.most));
    return value;
}

SetupResult<WallTime> parse_utc(std::string_view text) {
    std::tm fields{};
    const std::string whole(text);
    const char* const end = strptime(whole.c_str(), "%Y-%m-%dT%H:%M:%SZ", &fields);
    if (end == whole.c_str() + whole.size() && fields.tm_year > 70 && fields.tm_year < 200) {
        const std::tm typed = fields;
        const WallTime time{std::chrono::seconds{timegm(&fields)}};  // which takes 31 February for a day in March
        if (typed.tm_mday == fields.tm_mday && typed.tm_min == fields.tm_min) return time;
    }
    return usage(fmt::format("{} is not a time in UTC from 1971 to 2099, such as 2026-11-29T12:00:00Z", in_quotes(text)));
}

SetupResult<std::size_t> parse_choice(std::string_view text, std::span<const std::string_view> choices) {
    const auto choice = std::ranges::find(choices, text);
    if (choice == choices.end())
        return usage(
            fmt::format("{} is none of {}{}", in_quotes(text), fmt::join(choices, ", "), did_you_mean(text, choices)));
    return static_cast<std::size_t>(choice - choices.begin());
}

SetupResult<sim::Home> parse_home(std::string_view text) {
    static constexpr std::array ranges{latitude_range, longitude_range, altitude_range, heading_range};
    static constexpr std::array<std::string_view, 4> names{"latitude", "longitude", "altitude", "heading"};
    const auto values = parse_list(text, ranges, names);
    if (!values) return tl::unexpected(values.error());
    if (values->size() < 2)
        return usage(
            fmt::format("{} is not LAT,LON[,ALT[,HEADING]], as in 47.397742,8.545594 or 47.397742,8.545594,489.4,90",
                        in_quotes(text)));
    const auto& v = *values;
    const double usual_altitude_m = sim::Home{}.altitude_m;
    return sim::Home{v[0], v[1], v.size() > 2 ? v[2] : usual_altitude_m, v.size() > 3 ? std::fmod(v[3], 360) : 0};
}

SetupResult<sim::Wind> parse_wind(std::string_view text) {
    static constexpr std::array ranges{speed_range, heading_range, speed_range};
    static constexpr std::array<std::string_view, 3> names{"speed", "direction", "gust"};
    const auto values = parse_list(text, ranges, names);
    if (!values) return tl::unexpected(values.error());
    if (values->size() < 2)
        return usage(fmt::format("{} is not SPEED,DIR: m/s, and the degrees that the wind comes from, as in 5,270",
                                 in_quotes(text)));
    const auto& v = *values;
    return sim::Wind{v[0], std::fmod(v[1] + 180, 360), v.size() > 2 ? v[2] : 0};
}

SetupResult<std::array<double, 3>> parse_three(std::string_view text, Range range) {
    static constexpr std::array<std::string_view, 3> names{"first", "second", "third"};
    const std::array ranges{range, range, range};
    const auto values = parse_list(text, ranges, names);
    if (!values) return tl::unexpected(values.error());
    if (values->size() != 3) return usage(fmt::format("{} is not three numbers", in_quotes(text)));
    return std::array{(*values)[0], (*values)[1], (*values)[2]};
}

SetupResult<std::vector<NamedPart>> parse_named_parts(std::string_view text, std::string_view preset) {
    std::vector<NamedPart> parts;
    const auto add = [&](std::string_view term) -> SetupResult<void> {
        const auto colon = term.find(':');
        const bool is_preset = colon == std::string_view::npos && parts.empty() && !preset.empty();
        if (!is_preset && (colon == std::string_view::npos || colon == 0))
            return usage(fmt::format("{} is not NAME:VALUE", in_quotes(term)));
        const auto part = is_preset ? NamedPart{preset, term} : NamedPart{term.substr(0, colon), term.substr(colon + 1)};
        if (std::ranges::find(parts, part.first, &NamedPart::first) != parts.end())
            return usage(fmt::format("{} stands twice", in_quotes(part.first)));
        parts.push_back(part);
        return {};
    };
    if (auto done = dialect::for_each_term(text, add); !done) return tl::unexpected(std::move(done.error()));
    return parts;
}

SetupResult<std::vector<std::pair<std::string, double>>> parse_pairs(std::string_view text) {
    const auto parts = parse_named_parts(text, {});
    if (!parts) return tl::unexpected(parts.error());
    std::vector<std::pair<std::string, double>> pairs;
    for (const auto& [name, number] : *parts) {
        constexpr double most = 3.4e38;  // of a parameter, which is a 32-bit float
        const auto value = parse_number(number, {-most, most});
        if (!value) return usage(fmt::format("{}: {} is not a number", shown(name), in_quotes(number)));
        pairs.emplace_back(name, *value);
    }
    return pairs;
}

SetupResult<sim::BatteryOptions> parse_battery(std::string_view text) {
    const auto pairs = parse_pairs(text);
    if (!pairs) return tl::unexpected(pairs.error());
    sim::BatteryOptions battery;
    for (const auto& [name, value] : *pairs) {
        const auto index = parse_choice(name, battery_keys);
        if (!index) return tl::unexpected(index.error());
        const Range range = battery_ranges[*index];
        const bool is_whole = *index != 1 || value == std::floor(value);
        if (value < range.least || value > range.most || !is_whole)
            return usage(fmt::format("{}: {} is not a number from {} to {}", name, value, range.least, range.most));
        if (*index == 0) battery.capacity_mah = value;
        if (*index == 1) battery.cells = static_cast<std::uint8_t>(value);
        if (*index == 2) battery.hover_minutes = value;
        if (*index == 3) battery.start_percent = value;
    }
    return battery;
}

std::vector<std::string_view> words_of(std::string_view text) {
    std::vector<std::string_view> words;
    for (std::size_t at = 0; at < text.size();) {
        const auto end = std::min(text.find(' ', at), text.size());
        if (end != at) words.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return words;
}

}  // namespace mavloom::simserve
