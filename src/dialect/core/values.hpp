// SPDX-License-Identifier: MIT
// The texts that XML attributes may hold, as values. Pure functions; nothing for a text that is none of them.
// Source: MAVLink's XSD (mavschema.xsd): attributes name, value, type, multiplier.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "mavloom/dialect/dialect.hpp"

namespace mavloom::dialect {

struct TypeText {
    FieldType type = FieldType::u8;
    std::size_t array_length = 0;  // 0: a scalar; not yet bounded
};

[[nodiscard]] std::string_view trimmed(std::string_view text) noexcept;
// Letters, digits and underscores, at most 100: safe in C++ and in file names.
[[nodiscard]] bool is_word(std::string_view text) noexcept;
// Valid UTF-8 without control characters.
[[nodiscard]] bool is_printable(std::string_view text) noexcept;
// "42", "0x2a", "0b101010", "2**5".
[[nodiscard]] std::optional<std::uint64_t> parse_unsigned(std::string_view text) noexcept;
// "1.5", "-1", "1E-2", "360/255"; finite.
[[nodiscard]] std::optional<double> parse_number(std::string_view text) noexcept;
// "float", "uint8_t[20]", "uint8_t_mavlink_version".
[[nodiscard]] std::optional<TypeText> parse_type(std::string_view text) noexcept;
[[nodiscard]] std::optional<bool> parse_bool(std::string_view text) noexcept;

}  // namespace mavloom::dialect
