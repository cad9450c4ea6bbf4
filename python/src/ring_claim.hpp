// SPDX-License-Identifier: MIT
// Class RingClaim: a record of a RingWriter that is filled in place.
#pragma once

#include <nanobind/nanobind.h>

#include <optional>

#include "ring_writer.hpp"

namespace mavloom::python {

void bind_ring_claim(nb::module_& module);

// RingWriter.claim; `writer` is one.
[[nodiscard]] nb::object claim_room(const nb::object& writer, const Integer& length, const OptionalInteger& time_ns,
                                    const Integer& link, const Integer& kind, const Integer& verdict);

}  // namespace mavloom::python
