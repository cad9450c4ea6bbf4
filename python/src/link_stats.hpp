// SPDX-License-Identifier: MIT
// The counters of a link as Python sees them: LinkStats and SourceStats.
#pragma once

#include <nanobind/nanobind.h>

#include <string>
#include <vector>

#include "hub.hpp"

namespace mavloom::python {

namespace nb = nanobind;

// What a user should look at, in words.
[[nodiscard]] std::vector<std::string> hints_of(const dialect::Dialect& dialect, const LinkStats& stats);

void bind_link_stats(nb::module_& module);

}  // namespace mavloom::python
