// SPDX-License-Identifier: MIT
// Class RingClaim: a record of a RingWriter that is filled in place.
#pragma once

#include <nanobind/nanobind.h>

#include <optional>

#include "ring_writer.hpp"

namespace mavloom::python {

void bind_ring_claim(nb::module_& module);

// RingWriter.claim; `writer` is one.
[[nodiscard]] nb::object claim_room(const nb::object& writer, std::int64_t length, std::optional<std::int64_t> time_ns,
                                    std::int64_t link, std::int64_t kind, std::int64_t verdict);

}  // namespace mavloom::python
