// SPDX-License-Identifier: MIT
// The Python classes LinkStats and SourceStats: the counters of a link.
#pragma once

#include <nanobind/nanobind.h>

#include <string>
#include <vector>

#include "hub.hpp"

namespace mavloom::python {

namespace nb = nanobind;

// Returns advice on what the user should check.
[[nodiscard]] std::vector<std::string> hints_of(const dialect::Dialect& dialect, const LinkStats& stats);

void bind_link_stats(nb::module_& module);

}  // namespace mavloom::python
