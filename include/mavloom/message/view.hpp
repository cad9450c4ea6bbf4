// SPDX-License-Identifier: MIT
// Reads the fields of a payload by their definition, for messages whose type is known only at run time. A MessageView
// owns nothing; the definition and the payload must outlive it. Reading allocates nothing and cannot fail. Bytes that
// the sender cut off (trailing zeros in MAVLink 2, extension fields in MAVLink 1) read as 0.
// Source: MAVLink guide, "Payload Truncation" and "Message Extensions".
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <string_view>

#include "mavloom/base/bytes.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::message {

class MessageView {
public:
    MessageView(const dialect::Message& definition, ByteView payload) noexcept
        : definition_(&definition), payload_(payload) {}

    [[nodiscard]] const dialect::Message& definition() const noexcept { return *definition_; }
    [[nodiscard]] ByteView payload() const noexcept { return payload_; }

    // Returns element `index` of a field. `T` must have the size of the field's type.
    template <class T>
    [[nodiscard]] T get(const dialect::Field& field, std::size_t index = 0) const noexcept {
        assert(sizeof(T) == dialect::size_of(field.type) && index < field.count());
        const std::size_t at = field.offset + index * sizeof(T);
        if (at + sizeof(T) <= payload_.size()) [[likely]]
            return load_le<T>(payload_.data() + at);
        std::array<std::uint8_t, sizeof(T)> bytes{};
        if (at < payload_.size()) std::memcpy(bytes.data(), payload_.data() + at, payload_.size() - at);
        return load_le<T>(bytes.data());
    }

    // Return an element of any numeric type, converted:
    // - `number`: as double; 64-bit integers beyond 2^53 lose digits.
    // - `integer`, `unsigned_integer`: integers convert modulo 2^64. Floats are truncated and limited to the range of
    //   the result; NaN becomes 0.
    // Use `unsigned_integer` to look up enum entries.
    [[nodiscard]] double number(const dialect::Field& field, std::size_t index = 0) const noexcept;
    [[nodiscard]] std::int64_t integer(const dialect::Field& field, std::size_t index = 0) const noexcept;
    [[nodiscard]] std::uint64_t unsigned_integer(const dialect::Field& field, std::size_t index = 0) const noexcept;

    // The bytes of a char[] field without trailing NULs, as a view into the payload. May hold any bytes, including
    // invalid UTF-8.
    [[nodiscard]] std::string_view text(const dialect::Field& field) const noexcept;

private:
    const dialect::Message* definition_;
    ByteView payload_;
};

}  // namespace mavloom::message
