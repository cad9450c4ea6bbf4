// SPDX-License-Identifier: MIT
// Instance: distinguishes the sensors that send the same message, such as two batteries. A plain value.
#pragma once

#include <cstdint>
#include <string>
#include <variant>

#include "mavloom/base/bytes.hpp"
#include "mavloom/dialect/dialect.hpp"

namespace mavloom::message {

// Value of the message's instance field: a number, or text without trailing NULs.
using Instance = std::variant<std::int64_t, std::string>;

// Returns the field that the definition marks as the instance; null if it marks none.
[[nodiscard]] const dialect::Field* instance_field(const dialect::Message& message) noexcept;
[[nodiscard]] Instance instance_of(const dialect::Message& message, const dialect::Field& field, ByteView payload);

// "1", or the text itself.
[[nodiscard]] std::string text_of(const Instance& instance);

}  // namespace mavloom::message
