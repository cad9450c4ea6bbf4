// SPDX-License-Identifier: MIT
// The definition's attribute `invalid`: which value of a field, or of an element of an array, means "no value". Pure; allocates nothing.
// Source: MAVLink guide, "MAVLink XML Schema", attribute invalid: "v"; "[v]" each element; "[v:]" all when the first is v; "[v1,,v3,]" by place.
#pragma once

#include <cstddef>

#include "mavloom/message/view.hpp"

namespace mavloom::message {

[[nodiscard]] bool is_invalid(const MessageView& view, const dialect::Field& field, std::size_t index = 0) noexcept;

}  // namespace mavloom::message
