// SPDX-License-Identifier: MIT
// Applies the XML attribute `invalid`, which defines the value of a field or array element that means "no value".
// The forms of the attribute:
// - "v": the field is invalid if its value is v.
// - "[v]": each array element with the value v is invalid.
// - "[v:]": all elements are invalid if the first one has the value v.
// - "[v1,,v3,]": one value per element; an element without one is always valid.
//
// Pure; allocates nothing. Source: MAVLink guide, "MAVLink XML Schema".
#pragma once

#include <cstddef>

#include "mavloom/message/view.hpp"

namespace mavloom::message {

[[nodiscard]] bool is_invalid(const MessageView& view, const dialect::Field& field, std::size_t index = 0) noexcept;

}  // namespace mavloom::message
