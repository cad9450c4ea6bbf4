// SPDX-License-Identifier: MIT
// Helpers for Python calls that wait: time-outs, and protection of forked children.
#pragma once

#include <nanobind/nanobind.h>

#include <optional>

#include "errors.hpp"
#include "gil.hpp"
#include "mavloom/base/clock.hpp"
#include "mavloom/feed/fork.hpp"

namespace mavloom::python {

// Converts a number of seconds. Negative numbers become 0, and more than a year becomes a year. Errors begin with
// `what`, the name of the argument.
[[nodiscard]] Nanoseconds duration_of(const char* what, const nb::object& given);
// Converts a time-out. None becomes nullopt, which means to wait forever.
[[nodiscard]] std::optional<Nanoseconds> timeout_of(const nb::object& given);
// Returns how long recv_match waits: as `timeout_of`, or 0 if it polls. Without `blocking`, it waits if a time-out is
// given.
[[nodiscard]] std::optional<Nanoseconds> match_timeout(const nb::object& blocking, const nb::object& timeout);
// Returns the deadline of a wait that begins now.
[[nodiscard]] MonoTime deadline_after(std::optional<Nanoseconds> timeout);
[[nodiscard]] inline MonoTime deadline_after(const nb::object& timeout) { return deadline_after(timeout_of(timeout)); }

class ForkGuard : public feed::ForkGuard {
public:
    // Raises ClosedError in a forked child of the process that made the object.
    void check() const {
        if (!is_own_process()) raise_closed("opened before fork: open it again in this process");
    }
};

}  // namespace mavloom::python
