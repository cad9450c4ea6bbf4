// SPDX-License-Identifier: MIT
// Bytes that claim to be UTF-8, one code point at a time. What is not UTF-8 becomes U+FFFD, one for each maximal subpart (Unicode 15,
// section 3.9, table 3-8), as browsers and Python's errors="replace" do. Pure; allocates nothing.
#pragma once

#include <cstdint>
#include <string_view>

namespace mavloom::message {

inline constexpr char32_t replacement_character = 0xfffd;

struct CodePoint {
    char32_t value;
    std::uint8_t length;  // bytes used up: 1 to 4
};

// The first code point of `bytes`, which must not be empty.
[[nodiscard]] CodePoint decode_utf8(std::string_view bytes) noexcept;

// Writes `code_point` as UTF-8 at `at` (room for 4) and returns the end.
char* write_utf8(char* at, char32_t code_point) noexcept;

// True for what a terminal obeys or hides instead of showing: C0, DEL, C1, line and paragraph separators, bidirectional overrides.
[[nodiscard]] bool is_control(char32_t code_point) noexcept;

}  // namespace mavloom::message
