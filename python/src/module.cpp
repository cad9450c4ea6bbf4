// SPDX-License-Identifier: MIT
#include <nanobind/nanobind.h>

#include "bindings.hpp"
#include "mavloom/base/version.hpp"
#include "mavloom/ws/transport.hpp"
#include "message/definitions.hpp"
#include "message/message.hpp"
#include "strings.hpp"

namespace {

// Gives the compiled functions an attribute `__signature__`, which the module inspect reads. nanobind's types of
// functions are immutable, so it must be set here.
void set_signature(const nanobind::handle type, const nanobind::handle attribute) {
    auto* functions = reinterpret_cast<PyTypeObject*>(type.ptr());
    const auto fixed = functions->tp_flags & Py_TPFLAGS_IMMUTABLETYPE;
    functions->tp_flags &= ~Py_TPFLAGS_IMMUTABLETYPE;
    const int status = PyObject_SetAttrString(type.ptr(), "__signature__", attribute.ptr());
    functions->tp_flags |= fixed;
    if (status != 0) throw nanobind::python_error();
}

}  // namespace

NB_MODULE(_core, module) {
    using namespace mavloom::python;
    nb::set_leak_warnings(false);  // users would take the warnings for bugs
    module.def("set_leak_warnings", &nb::set_leak_warnings, nb::arg("on"),
               "Sets whether the interpreter reports objects of this module that remain at exit. For tests of\n"
               "this package.");
    module.def("set_signature", &set_signature, nanobind::arg("type"), nanobind::arg("attribute"),
               nanobind::sig("def set_signature(type: type, attribute: object) -> None"),
               "Sets the attribute `__signature__` of a type of functions of this module.");
    mavloom::ws::register_transports();
    module.doc() = "The compiled part of mavloom. Use the package `mavloom` instead.";
    module.def("version", &mavloom::version,
               "The version of the compiled code, such as \"0.1.0\"; between releases, with the commit appended.");
    bind_message(module);
    bind_dialect(module);
    bind_modes(module);
    bind_parser(module);
    bind_recording_summary(module);
    bind_recording(module);
    bind_recording_writer(module);
    bind_columns(module);
    bind_ring_options(module);
    bind_ring_writer(module);
    bind_ring_reader(module);
    bind_link(module);
    bind_mavutil_message(module);
    bind_mavutil_state(module);
    bind_mavutil_log(module);
    bind_mavutil_parser(module);
}
