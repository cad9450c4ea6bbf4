// SPDX-License-Identifier: MIT
#include <nanobind/nanobind.h>
#include <nanobind/stl/string_view.h>

#include "bindings.hpp"
#include "mavloom/base/version.hpp"
#include "message/definitions.hpp"
#include "message/message.hpp"

NB_MODULE(_core, module) {
    using namespace mavloom::python;
    nb::set_leak_warnings(false);  // users would take the warnings for bugs
    module.def("set_leak_warnings", &nb::set_leak_warnings, nb::arg("on"),
               "Sets whether the interpreter reports objects of this module that remain at exit. For tests of\n"
               "this package.");
    module.doc() = "The compiled part of mavloom. Use the package `mavloom` instead.";
    module.def("version", &mavloom::version,
               "The version of the compiled code, such as \"0.1.0\"; between releases, with the commit appended.");
    bind_message(module);
    bind_dialect(module);
    bind_parser(module);
    bind_recording(module);
    bind_columns(module);
    bind_ring_writer(module);
    bind_ring_reader(module);
    bind_link(module);
}
