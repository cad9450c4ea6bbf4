// SPDX-License-Identifier: MIT
#pragma once

#include <nanobind/nanobind.h>

#include <string>

#include "strings.hpp"

namespace mavloom::python {

// A __repr__ for objects that consist of properties: Name(frames=12, lost=3). Omits values that are 0 or empty; if all
// are, it is Name(all 0).
[[nodiscard]] inline std::string counters_repr(nanobind::handle self) {
    namespace nb = nanobind;
    const nb::object type = nb::borrow(self.type());
    std::string text = nb::cast<nb::str>(type.attr("__name__")).c_str();
    const char* before = "(";
    for (const nb::handle key : nb::iter(type.attr("__dict__"))) {
        const std::string name = nb::borrow<nb::str>(key).c_str();
        if (name.starts_with('_')) continue;
        const nb::object value = self.attr(name.c_str());
        if (PyCallable_Check(value.ptr()) != 0 || PyObject_IsTrue(value.ptr()) != 1) continue;
        text += before + name + "=" + escaped(nb::repr(value));
        before = ", ";
    }
    return text + (*before == '(' ? "(all 0)" : ")");
}

}  // namespace mavloom::python
