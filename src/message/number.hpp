// SPDX-License-Identifier: MIT
// Numbers to text, for the formatter: integers in decimal, floats as the shortest digits that read back as the same float32 or double,
// laid out as Python's repr and numpy do (0.01, 1.0, -0.0, 1e-05, 1e+16). Each function writes at `at`, which has `number_room` bytes, and
// returns the end. Pure; allocates nothing.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mavloom::message {

// Room that every writer below may use: it may touch bytes behind what it returns. Longest result: "-2.2250738585072014e-308".
inline constexpr std::size_t number_room = 48;

char* write_unsigned(char* at, std::uint64_t value) noexcept;
char* write_integer(char* at, std::int64_t value) noexcept;

// The value must be finite.
char* write_float(char* at, float value) noexcept;
char* write_float(char* at, double value) noexcept;

// `magnitude` / 10^decimals exactly, without trailing zeros: 473977418 with 7 is 47.3977418. At most 19 decimals.
char* write_scaled(char* at, bool negative, std::uint64_t magnitude, unsigned decimals) noexcept;

}  // namespace mavloom::message
