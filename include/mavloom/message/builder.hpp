// SPDX-License-Identifier: MIT
// Builds the payload of one message field by field; the counterpart of MessageView.
// Holds the full payload (at most 255 bytes) without heap memory. Single owner.
// The `set` functions check values; their errors (`usage`) name message, field and valid range.
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
    // Starts with all fields 0.
    explicit MessageBuilder(const dialect::Message& definition) noexcept : definition_(&definition) {}
    // Starts with the fields of a received payload. Missing bytes are 0; bytes beyond the definition are dropped.
    MessageBuilder(const dialect::Message& definition, ByteView payload) noexcept;

    [[nodiscard]] const dialect::Message& definition() const noexcept { return *definition_; }

    // Writes element `index` without checks. `T` must have the size of the field's type.
    template <class T>
    void put(const dialect::Field& field, T value, std::size_t index = 0) noexcept {
        store_le(bytes_.data() + field.offset + index * sizeof(T), value);
    }

    // Checked writes: an integer field takes only whole numbers in its range. Text must fit in the field's length in
    // bytes.
    [[nodiscard]] SetupResult<void> set_number(const dialect::Field& field, double value, std::size_t index = 0);
    [[nodiscard]] SetupResult<void> set_integer(const dialect::Field& field, std::int64_t value, std::size_t index = 0);
    [[nodiscard]] SetupResult<void> set_unsigned(const dialect::Field& field, std::uint64_t value,
                                                 std::size_t index = 0);
    [[nodiscard]] SetupResult<void> set_text(const dialect::Field& field, std::string_view utf8);

    // Parses the value in `--set MESSAGE.field=value`: a number (decimal, 0x…, nan, inf), enum names (A|B for flags),
    // text, or [a,b,c] for arrays. The error states what was expected and suggests the closest enum name.
    [[nodiscard]] SetupResult<void> set_from_text(const dialect::Field& field, std::string_view value);

    // Like `set_from_text`, for one element of a numeric array. `index` must be in range.
    [[nodiscard]] SetupResult<void> set_element_from_text(const dialect::Field& field, std::string_view value,
                                                          std::size_t index);

    // The full payload of `max_length` bytes. The frame writer truncates it for MAVLink 2 and cuts extension fields for
    // MAVLink 1.
    [[nodiscard]] ByteView payload() const noexcept { return {bytes_.data(), definition_->wire.max_length}; }

private:
    const dialect::Message* definition_;
    std::array<std::uint8_t, wire::max_payload_length> bytes_{};
};

}  // namespace mavloom::message
