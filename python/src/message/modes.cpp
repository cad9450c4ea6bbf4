// SPDX-License-Identifier: MIT
// The names of flight modes, for mavloom._modes.
#include "mavloom/message/modes.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>

#include "bindings.hpp"
#include "strings.hpp"

namespace mavloom::python {

namespace nb = nanobind;

namespace {

nb::dict flight_modes(std::uint8_t autopilot, std::uint8_t type) {
    nb::dict names;
    for (const auto& mode : message::flight_modes(autopilot, type)) names[nb::cast(mode.number)] = nb::cast(mode.name);
    return names;
}

std::optional<std::uint32_t> mode_number(std::uint8_t autopilot, std::uint8_t type, std::string_view name) {
    return message::mode_number(message::flight_modes(autopilot, type), name);
}

}  // namespace

void bind_modes(nb::module_& module) {
    module.def("flight_modes", &flight_modes, nb::arg("autopilot"), nb::arg("type"),
               nb::sig("def flight_modes(autopilot: int, type: int) -> dict[int, str]"),
               "The modes of a vehicle, {custom_mode: name}, by the fields of its HEARTBEAT. Empty if they are not\n"
               "known.");
    module.def("mode_number", &mode_number, nb::arg("autopilot"), nb::arg("type"), nb::arg("name"),
               "The custom_mode that has this name in any of the vocabularies; None if there is none.");
}

}  // namespace mavloom::python
