// SPDX-License-Identifier: MIT
// Dynamic access to a payload by its definition: the same layout that the typed structs use, for messages known only at run time.
// A MessageView owns nothing and lives as long as the definition and the payload; reading allocates nothing and cannot fail on bytes from
// outside: bytes that the sender cut off (trailing zeros in MAVLink 2, extension fields in MAVLink 1) read as 0.
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

    // The element `index` of a field in its own type; `T` must have the size of the field's type.
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

    // Any numeric element as double (64-bit integers beyond 2^53 lose digits), as two's complement, or as the bits an enum is looked up by.
    [[nodiscard]] double number(const dialect::Field& field, std::size_t index = 0) const noexcept;
    [[nodiscard]] std::int64_t integer(const dialect::Field& field, std::size_t index = 0) const noexcept;
    [[nodiscard]] std::uint64_t unsigned_integer(const dialect::Field& field, std::size_t index = 0) const noexcept;

    // A char[] field up to its trailing NULs; may hold any bytes. A view into the payload.
    [[nodiscard]] std::string_view text(const dialect::Field& field) const noexcept;

private:
    const dialect::Message* definition_;
    ByteView payload_;
};

}  // namespace mavloom::message
