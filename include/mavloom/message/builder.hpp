// SPDX-License-Identifier: MIT
// A payload that is written field by field, by handle or by name: the counterpart of MessageView. Holds the full payload of one message
// (at most 255 bytes, no heap). Single owner. Values from outside are checked: out of range is an error that names message, field and range.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::message {

class MessageBuilder {
public:
    // All fields 0.
    explicit MessageBuilder(const dialect::Message& definition) noexcept : definition_(&definition) {}
    // The fields of a received payload; bytes that were cut off are 0, bytes beyond the definition are dropped.
    MessageBuilder(const dialect::Message& definition, ByteView payload) noexcept;

    [[nodiscard]] const dialect::Message& definition() const noexcept { return *definition_; }

    // Writes element `index` in the field's own type; `T` must have the field's size.
    template <class T>
    void put(const dialect::Field& field, T value, std::size_t index = 0) noexcept {
        store_le(bytes_.data() + field.offset + index * sizeof(T), value);
    }

    // Checked writes: integers must be in the field's range and whole; text at most the field's length in bytes.
    [[nodiscard]] SetupResult<void> set_number(const dialect::Field& field, double value, std::size_t index = 0);
    [[nodiscard]] SetupResult<void> set_integer(const dialect::Field& field, std::int64_t value, std::size_t index = 0);
    [[nodiscard]] SetupResult<void> set_unsigned(const dialect::Field& field, std::uint64_t value,
                                                 std::size_t index = 0);
    [[nodiscard]] SetupResult<void> set_text(const dialect::Field& field, std::string_view utf8);

    // Parses what a user types for `--set MESSAGE.field=value`: number (decimal, 0x…, nan, inf), enum names (A|B for flags),
    // text, [a,b,c] for arrays; the error says what was expected and the nearest enum name.
    [[nodiscard]] SetupResult<void> set_from_text(const dialect::Field& field, std::string_view value);

    // The same for one element of an array of numbers; `index` is in range.
    [[nodiscard]] SetupResult<void> set_element_from_text(const dialect::Field& field, std::string_view value,
                                                          std::size_t index);

    // The full payload, `max_length` bytes, untruncated: the frame writer truncates for MAVLink 2 and cuts extensions for MAVLink 1.
    [[nodiscard]] ByteView payload() const noexcept { return {bytes_.data(), definition_->wire.max_length}; }

private:
    const dialect::Message* definition_;
    std::array<std::uint8_t, wire::max_payload_length> bytes_{};
};

}  // namespace mavloom::message
