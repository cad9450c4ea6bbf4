// SPDX-License-Identifier: MIT
// Decodes and encodes UTF-8 one code point at a time. Pure; allocates nothing.
// Invalid input becomes U+FFFD, one for each maximal subpart (Unicode 15, section 3.9, table 3-8).
// Browsers and Python's errors="replace" do the same.
#pragma once

#include <cstdint>
#include <string_view>

namespace mavloom::message {

inline constexpr char32_t replacement_character = 0xfffd;

struct CodePoint {
    char32_t value;
    std::uint8_t length;  // bytes consumed, 1 to 4
};

// Decodes the first code point of `bytes`, which must not be empty.
[[nodiscard]] CodePoint decode_utf8(std::string_view bytes) noexcept;

// Writes `code_point` as UTF-8 at `at`, which must have room for 4 bytes. Returns the end.
char* write_utf8(char* at, char32_t code_point) noexcept;

// True for characters that control a terminal or are invisible: C0, DEL, C1, line and paragraph separators, and
// bidirectional marks and overrides.
[[nodiscard]] bool is_control(char32_t code_point) noexcept;

}  // namespace mavloom::message
