// SPDX-License-Identifier: MIT
// Numbers and names as short texts of bounded width. Private to module view.
#pragma once

#include <string>
#include <string_view>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/source_text.hpp"
#include "mavloom/dialect/dialect.hpp"

namespace mavloom::view {

[[nodiscard]] std::string hz_text(double hz);           // "49.8", "12345"
[[nodiscard]] std::string time_text(Nanoseconds time);  // "1.25 ms", "3 min"
// The same, in tenths of a second below ten seconds: an age changes with each picture.
[[nodiscard]] std::string age_text(Nanoseconds age);
[[nodiscard]] std::string clock_text(Nanoseconds time);     // "1:02:03", "02:03"
[[nodiscard]] std::string bytes_text(double bytes);         // "1.25 kB"
[[nodiscard]] std::string count_text(std::uint64_t count);  // "40087", "12.3 M"
[[nodiscard]] std::string percent_text(double ratio);       // "12.5 %"

// Removes from `text` the words that fit into `width` cells, and at least one. Returns them.
[[nodiscard]] std::string_view take_words(std::string_view& text, int width);

// The entry of an enum in small letters, without the words that all entries begin with: "quadrotor". "?": it has none.
[[nodiscard]] std::string entry_text(const dialect::Dialect& dialect, std::string_view enum_name, std::uint64_t value);

}  // namespace mavloom::view
