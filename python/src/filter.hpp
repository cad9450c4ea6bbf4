// SPDX-License-Identifier: MIT
// Filter: the messages that a call selects with `type=`, `system=` and `component=`. A plain value.
#pragma once

#include <nanobind/nanobind.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "integer.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::python {

namespace nb = nanobind;

struct Filter {
    std::optional<std::vector<MessageId>> ids;  // nullopt: any
    std::optional<std::uint8_t> system, component;

    [[nodiscard]] bool takes(const wire::FrameView& frame) const noexcept {
        return (!system || frame.system().value == *system) && (!component || frame.component().value == *component) &&
               (!ids || std::ranges::find(*ids, frame.id()) != ids->end());
    }
};

// Value of the field that distinguishes several sensors in one message: a number, or text without trailing NULs.
using Instance = std::variant<std::int64_t, std::string>;

// Returns that field, or null if the message has none.
[[nodiscard]] const dialect::Field* instance_field(const dialect::Message& message) noexcept;
[[nodiscard]] Instance instance_of(const dialect::Message& message, const dialect::Field& field,
                                   const wire::FrameView& frame);

// `type` is None, a name, a class of mavloom.messages, or an iterable of these. An unknown name raises UsageError,
// which suggests the nearest one.
[[nodiscard]] Filter make_filter(const dialect::Dialect& dialect, const nb::object& type, const OptionalInteger& system,
                                 const OptionalInteger& component);

// Raises TypeError unless `condition` is None or callable. Text for eval(), which pymavlink accepts, is rejected.
void check_condition(const nb::object& condition);

}  // namespace mavloom::python
