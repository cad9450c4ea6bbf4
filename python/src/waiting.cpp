// SPDX-License-Identifier: MIT
#include "waiting.hpp"

#include <fmt/format.h>

#include <cmath>

namespace mavloom::python {

static constexpr auto for_ever = Nanoseconds{std::chrono::hours{24 * 365}};

Nanoseconds duration_of(const char* what, const nb::object& given) {
    const double seconds = PyFloat_AsDouble(given.ptr());
    if (PyErr_Occurred() != nullptr) {
        if (PyErr_ExceptionMatches(PyExc_TypeError) != 0)
            PyErr_Format(PyExc_TypeError, "%s: a number of seconds, not %R", what, given.ptr());
        throw nb::python_error();
    }
    if (std::isnan(seconds)) raise_usage(fmt::format("{}: NaN is not a time", what));
    if (seconds >= std::chrono::duration<double>(for_ever).count()) return for_ever;
    return std::chrono::duration_cast<Nanoseconds>(std::chrono::duration<double>(std::max(seconds, 0.0)));
}

std::optional<Nanoseconds> timeout_of(const nb::object& given) {
    if (given.is_none()) return std::nullopt;
    return duration_of("timeout", given);
}

static std::optional<bool> flag_of(const nb::object& given) {
    if (given.is_none()) return std::nullopt;
    if (PyBool_Check(given.ptr()) != 0) return given.ptr() == Py_True;
    PyErr_Format(PyExc_TypeError, "blocking: True or False, not %R; timeout= takes the seconds to wait", given.ptr());
    throw nb::python_error();
}

std::optional<Nanoseconds> match_timeout(const nb::object& blocking, const nb::object& timeout) {
    const auto given = timeout_of(timeout);
    return flag_of(blocking).value_or(given.has_value()) ? given : Nanoseconds{};
}

MonoTime deadline_after(std::optional<Nanoseconds> timeout) {
    return timeout ? mono_now() + *timeout : MonoTime::max();
}

}  // namespace mavloom::python
