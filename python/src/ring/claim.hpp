// SPDX-License-Identifier: MIT
// Class RingClaim: room for one record of a RingWriter, to be filled in place.
#pragma once

#include <nanobind/nanobind.h>

#include <optional>

#include "ring/writer.hpp"

namespace mavloom::python {

void bind_ring_claim(nb::module_& module);

// Implements RingWriter.claim; `writer` is a RingWriter.
[[nodiscard]] nb::object claim_room(const nb::object& writer, const Integer& length, const OptionalInteger& time_ns,
                                    const Integer& link, const Integer& kind, const Integer& verdict);

}  // namespace mavloom::python
