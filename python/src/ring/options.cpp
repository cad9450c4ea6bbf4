// SPDX-License-Identifier: MIT
// The texts of ring options, for the commands of the package.
#include "bindings.hpp"
#include "errors.hpp"
#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/endpoint/grammar.hpp"
#include "strings.hpp"

namespace mavloom::python {

void bind_ring_options(nb::module_& module) {
    module.def(
        "ring_capacity", [](std::string_view text) { return value_or_raise(endpoint::parse_ring_capacity(text)); },
        nb::arg("text"), "The bytes of a capacity such as \"8MiB\".");
    module.def(
        "file_mode", [](std::string_view text) { return value_or_raise(endpoint::parse_mode(text)); }, nb::arg("text"),
        "The number of a file mode such as \"0640\".");
}

}  // namespace mavloom::python
