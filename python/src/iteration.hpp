// SPDX-License-Identifier: MIT
// Python's iterator slots, for which nanobind has no class.
#pragma once

#include <nanobind/nanobind.h>

#include <exception>

namespace mavloom::python {

namespace nb = nanobind;

// `T::iterate` returns a new reference, or null at the end.
template <class T>
PyObject* next_of(PyObject* self) noexcept {
    try {
        if (nb::inst_ready(self)) return nb::inst_ptr<T>(self)->iterate();
        PyErr_SetString(PyExc_TypeError, "not initialised");
    } catch (nb::python_error& error) {
        error.restore();
    } catch (const std::exception& error) {
        PyErr_SetString(PyExc_RuntimeError, error.what());
    }
    return nullptr;
}

template <class T>
inline PyType_Slot iterator_slots[] = {
    {Py_tp_iternext, reinterpret_cast<void*>(next_of<T>)},     // NOLINT
    {Py_tp_iter, reinterpret_cast<void*>(PyObject_SelfIter)},  // NOLINT
    {0, nullptr},
};

}  // namespace mavloom::python
