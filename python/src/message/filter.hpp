// SPDX-License-Identifier: MIT
// The arguments `type=`, `system=`, `component=` and `condition=` of calls that select messages. Call with the GIL
// held.
#pragma once

#include <nanobind/nanobind.h>

#include <optional>

#include "integer.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/dialect/filter.hpp"
#include "mavloom/message/instance.hpp"

namespace mavloom::python {

namespace nb = nanobind;

// `type` is None, a name, a class of mavloom.messages, or an iterable of these; an empty one admits no message. An
// unknown name raises UsageError, which suggests the nearest one.
[[nodiscard]] dialect::Filter make_filter(const dialect::Dialect& dialect, const nb::object& type,
                                          const OptionalInteger& system, const OptionalInteger& component);

// The argument `instance=`: None, a number or text. Raises TypeError for anything else.
[[nodiscard]] std::optional<message::Instance> instance_from(const nb::object& given);
// Raises UsageError if these messages have no instances, or numbers where `instance` is text, or the reverse.
void check_instance(const dialect::Message& message, const message::Instance& instance);

// Raises TypeError unless `condition` is None or callable. Text for eval(), which pymavlink accepts, is rejected.
void check_condition(const nb::object& condition);

}  // namespace mavloom::python
