// SPDX-License-Identifier: MIT
// Converts between str and std::string or std::string_view, in place of nanobind's own casters. A str may have lone
// surrogates, which cannot be encoded as UTF-8: they become escapes such as \udc80. A name with one is then unknown and
// the error quotes it. nanobind's casters would raise std::bad_cast, or report an argument of the wrong type.
#pragma once

#include <nanobind/nanobind.h>

#include <new>
#include <optional>
#include <string>
#include <string_view>

namespace mavloom::python {

// Returns the UTF-8 form of a str as a new bytes object, with escapes for lone surrogates; null if that failed.
[[nodiscard]] inline PyObject* escaped_utf8(nanobind::handle text) noexcept {
    PyErr_Clear();
    PyObject* bytes = PyUnicode_AsEncodedString(text.ptr(), "utf-8", "backslashreplace");
    if (bytes == nullptr) PyErr_Clear();
    return bytes;
}

[[nodiscard]] inline nanobind::handle str_of(std::string_view text) noexcept {
    return PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "replace");
}

// The UTF-8 form of a str, valid as long as the str. Nothing, and an exception is set, if it has lone surrogates.
[[nodiscard]] inline std::optional<std::string_view> utf8_of(PyObject* text) noexcept {
    Py_ssize_t size = 0;
    const char* utf8 = PyUnicode_AsUTF8AndSize(text, &size);
    if (utf8 == nullptr) return std::nullopt;
    return std::string_view(utf8, static_cast<std::size_t>(size));
}

// The same, but keeps the exception that is set.
[[nodiscard]] inline std::optional<std::string_view> utf8_during_error(PyObject* text) noexcept {
    PyObject *type = nullptr, *value = nullptr, *trace = nullptr;
    PyErr_Fetch(&type, &value, &trace);
    const auto utf8 = utf8_of(text);
    PyErr_Restore(type, value, trace);  // replaces the error of a text that is not UTF-8
    return utf8;
}

// The UTF-8 form of a str, with escapes for lone surrogates.
[[nodiscard]] inline std::string escaped(nanobind::handle text) {
    const auto bytes = nanobind::steal<nanobind::bytes>(escaped_utf8(text));
    if (!bytes.is_valid()) throw std::bad_alloc();
    return {bytes.c_str(), bytes.size()};
}

// The bytes of an argument `path`: a str, bytes or a path object. Raises TypeError for anything else, and UsageError
// for text that cannot be a path.
[[nodiscard]] std::string path_of(nanobind::handle path);

}  // namespace mavloom::python

namespace nanobind::detail {

template <>
struct type_caster<std::string> {
    NB_TYPE_CASTER(std::string, const_name("str"))
    bool from_python(handle given, std::uint32_t, cleanup_list*) noexcept {
        if (PyUnicode_Check(given.ptr()) == 0) return false;
        Py_ssize_t size = 0;
        if (const char* utf8 = PyUnicode_AsUTF8AndSize(given.ptr(), &size)) {
            value.assign(utf8, static_cast<std::size_t>(size));
            return true;
        }
        PyObject* bytes = mavloom::python::escaped_utf8(given);
        if (bytes == nullptr) return false;
        value.assign(PyBytes_AS_STRING(bytes), static_cast<std::size_t>(PyBytes_GET_SIZE(bytes)));
        Py_DECREF(bytes);
        return true;
    }
    static handle from_cpp(const std::string& text, rv_policy, cleanup_list*) noexcept {
        return mavloom::python::str_of(text);
    }
};

// The view is valid as long as the str, or until the end of the call.
template <>
struct type_caster<std::string_view> {
    NB_TYPE_CASTER(std::string_view, const_name("str"))
    bool from_python(handle given, std::uint32_t, cleanup_list* cleanup) noexcept {
        if (PyUnicode_Check(given.ptr()) == 0) return false;
        Py_ssize_t size = 0;
        if (const char* utf8 = PyUnicode_AsUTF8AndSize(given.ptr(), &size)) {
            value = {utf8, static_cast<std::size_t>(size)};
            return true;
        }
        PyObject* bytes = cleanup == nullptr ? nullptr : mavloom::python::escaped_utf8(given);
        if (bytes == nullptr) return false;
        cleanup->append(bytes);
        value = {PyBytes_AS_STRING(bytes), static_cast<std::size_t>(PyBytes_GET_SIZE(bytes))};
        return true;
    }
    static handle from_cpp(std::string_view text, rv_policy, cleanup_list*) noexcept {
        return mavloom::python::str_of(text);
    }
};

}  // namespace nanobind::detail
