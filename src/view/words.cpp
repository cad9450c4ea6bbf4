// SPDX-License-Identifier: MIT
#include "view/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "mavloom/base/text.hpp"
#include "mavloom/dialect/entry_name.hpp"
#include "mavloom/view/grid.hpp"

namespace mavloom::view {

namespace {

// Three digits that count.
std::string three_digits(double value) {
    if (value < 9.995) return fmt::format("{:.2f}", value);
    if (value < 99.95) return fmt::format("{:.1f}", value);
    return fmt::format("{:.0f}", value);
}

}  // namespace

std::string hz_text(double hz) {
    if (hz < 0.95) return fmt::format("{:.2f}", hz);
    return hz < 9999.5 ? fmt::format("{:.1f}", hz) : fmt::format("{:.0f}", hz);
}

std::string time_text(Nanoseconds time) {
    const auto s = std::chrono::duration<double>(std::max(time, Nanoseconds{})).count();
    if (s < 0.9995e-3) return fmt::format("{:.0f} us", s * 1e6);
    if (s < 0.9995) return three_digits(s * 1e3) + " ms";
    if (s < 99.95) return three_digits(s) + " s";
    if (s < 100 * 60) return fmt::format("{:.0f} min", s / 60);
    return s < 100 * 3600 ? fmt::format("{:.0f} h", s / 3600) : fmt::format("{:.0f} d", s / 86400);
}

std::string age_text(Nanoseconds age) {
    using namespace std::chrono_literals;
    return age < 10s ? fmt::format("{:.1f} s", std::chrono::duration<double>(age).count()) : time_text(age);
}

std::string clock_text(Nanoseconds time) {
    const auto s = std::chrono::duration_cast<std::chrono::seconds>(std::max(time, Nanoseconds{})).count();
    if (s < 3600) return fmt::format("{:02}:{:02}", s / 60, s % 60);
    return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

std::string bytes_text(double bytes) {
    constexpr std::array units{"kB", "MB", "GB", "TB"};
    if (bytes < 999.5) return fmt::format("{:.0f} B", bytes);
    for (const auto* const unit : units)
        if ((bytes /= 1000) < 999.5) return fmt::format("{} {}", three_digits(bytes), unit);
    return fmt::format("{:.0f} TB", bytes);
}

std::string count_text(std::uint64_t count) {
    if (count < 10'000'000) return fmt::format("{}", count);
    const auto millions = static_cast<double>(count) / 1e6;
    return millions < 9999 ? three_digits(millions) + " M" : three_digits(millions / 1000) + " G";
}

std::string percent_text(double ratio) { return fmt::format("{:.1f} %", 100 * ratio); }

std::string_view take_words(std::string_view& text, int width) {
    std::size_t end = std::min(text.find(' '), text.size());
    for (auto next = end; next < text.size(); end = next) {
        next = std::min(text.find(' ', next + 1), text.size());
        if (width_of(text.substr(0, next)) > width) break;
    }
    const auto words = text.substr(0, end);
    text.remove_prefix(std::min(text.size(), end + 1));
    return words;
}

std::string entry_text(const dialect::Dialect& dialect, std::string_view enum_name, std::uint64_t value) {
    std::string text(dialect::short_entry_name(dialect, enum_name, value));
    if (text.empty()) return fmt::format("{}?", value);
    std::ranges::transform(text, text.begin(), [](char c) { return c == '_' ? ' ' : lower(c); });
    return text;
}

}  // namespace mavloom::view
