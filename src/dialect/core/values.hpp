// SPDX-License-Identifier: MIT
// Parses the attribute values of MAVLink XML. Pure functions that return empty for invalid text; nothing allocates.
// Source: MAVLink's XSD (mavschema.xsd): attributes name, value, type, multiplier.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "mavloom/dialect/dialect.hpp"

namespace mavloom::dialect {

struct TypeText {
    FieldType type = FieldType::u8;
    std::size_t array_length = 0;  // 0: a scalar; the maximum is not checked
};

// True for 1 to 100 letters, digits and underscores, which are safe in C++ and in file names.
[[nodiscard]] bool is_word(std::string_view text) noexcept;
// True for valid UTF-8 without control characters.
[[nodiscard]] bool is_printable(std::string_view text) noexcept;
// Accepts "42", "0x2a", "0b101010" and "2**5".
[[nodiscard]] std::optional<std::uint64_t> parse_unsigned(std::string_view text) noexcept;
// Accepts "1.5", "-1", "1E-2" and "360/255"; the result is finite.
[[nodiscard]] std::optional<double> parse_number(std::string_view text) noexcept;
// Accepts "float", "uint8_t[20]" and "uint8_t_mavlink_version".
[[nodiscard]] std::optional<TypeText> parse_type(std::string_view text) noexcept;
[[nodiscard]] std::optional<bool> parse_bool(std::string_view text) noexcept;

}  // namespace mavloom::dialect
