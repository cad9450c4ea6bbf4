// SPDX-License-Identifier: MIT
// Integer: an integer argument of any size. It is checked against a range when it is used. A number that does not fit
// raises a UsageError that states the range, and anything else a TypeError that names the argument. nanobind's own
// casters would reject both with a text about all arguments of the C++ function.
// Call with the GIL held.
#pragma once

#include <fmt/format.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>  // the conversion of OptionalInteger

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>

#include "errors.hpp"

namespace mavloom::python {

// Returns the decimal digits of an int. Python does not convert ints of more than 4,300 digits.
[[nodiscard]] inline std::string digits_of(const nb::object& number) {
    const nb::object digits = nb::steal(PyLong_Type.tp_repr(number.ptr()));
    if (digits.is_valid()) return nb::borrow<nb::str>(digits).c_str();
    PyErr_Clear();
    return "a number with thousands of digits";
}

class Integer {
public:
    // Returns the value, or raises a UsageError that begins with `what`.
    template <class T>
        requires(sizeof(T) < sizeof(std::int64_t) || std::is_signed_v<T>)
    [[nodiscard]] T in(const char* what) const {
        return in<T>(what, std::numeric_limits<T>::min(), std::numeric_limits<T>::max());
    }
    template <class T>
    [[nodiscard]] T in(const char* what, std::int64_t least, std::int64_t most) const {
        if (!is_integer_) raise_no_integer(what);
        if (!fits_ || value_ < least || value_ > most)
            raise_usage(fmt::format("{}: {} is out of range, {} to {}", what, digits_of(number_), least, most));
        return static_cast<T>(value_);
    }
    void take(nb::handle given) noexcept {
        number_ = nb::steal(PyNumber_Index(given.ptr()));
        is_integer_ = number_.is_valid();
        if (!is_integer_) {
            PyErr_Clear();  // `in` raises it with the name of the argument
            number_ = nb::borrow(given);
            return;
        }
        int overflow = 0;
        value_ = PyLong_AsLongLongAndOverflow(number_.ptr(), &overflow);
        fits_ = overflow == 0;
    }

private:
    [[noreturn]] void raise_no_integer(const char* what) const {
        PyErr_Format(PyExc_TypeError, "%s: an integer, not %R", what, number_.ptr());
        throw nb::python_error();
    }

    nb::object number_;
    std::int64_t value_ = 0;
    bool is_integer_ = true;
    bool fits_ = true;
};

using OptionalInteger = std::optional<Integer>;

}  // namespace mavloom::python

template <>
struct nanobind::detail::type_caster<mavloom::python::Integer> {
    NB_TYPE_CASTER(mavloom::python::Integer, const_name("int"))
    bool from_python(handle source, std::uint8_t, cleanup_list*) noexcept {
        value.take(source);
        return true;
    }
};
