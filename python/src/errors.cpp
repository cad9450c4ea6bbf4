// SPDX-License-Identifier: MIT
#include "errors.hpp"

#include <cerrno>

#include "strings.hpp"

namespace mavloom::python {
namespace {

const char* class_of(SetupCode code) noexcept {
    switch (code) {
        case SetupCode::usage: return "UsageError";
        case SetupCode::bad_input: return "InputError";
        case SetupCode::not_found: return "NotFoundError";
        case SetupCode::permission: return "PermissionDeniedError";
        case SetupCode::in_use:
        case SetupCode::unreachable:
        case SetupCode::no_space:
        case SetupCode::system: break;
    }
    return "SystemFailure";
}

// The errno of errors that were found without a system call; 0 for none.
int errno_of(SetupCode code) noexcept {
    if (code == SetupCode::not_found) return ENOENT;
    return code == SetupCode::permission ? EACCES : 0;
}

[[noreturn]] void raise_as(const char* class_name, const nb::object& arguments) {
    const nb::object type = nb::module_::import_("mavloom._errors").attr(class_name);
    PyErr_SetObject(type.ptr(), arguments.ptr());
    throw nb::python_error();
}

// Replaces bytes that are not UTF-8, which file names may contain.
nb::object text_of(const std::string& text) {
    return nb::steal(PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "replace"));
}

}  // namespace

void raise(const SetupError& error) {
    const nb::object text = text_of(error.text);
    const int number = error.sys_errno != 0 ? error.sys_errno : errno_of(error.code);
    if (number == 0) raise_as(class_of(error.code), text);
    raise_as(class_of(error.code), nb::make_tuple(number, text));
}

void raise_usage(std::string text) { raise(SetupError{SetupCode::usage, 0, std::move(text)}); }
void raise_input(std::string text) { raise(SetupError{SetupCode::bad_input, 0, std::move(text)}); }
void raise_closed(const std::string& text) { raise_as("ClosedError", text_of(text)); }
void raise_error(const std::string& text) { raise_as("Error", text_of(text)); }
void raise_buffer(const std::string& text) {
    PyErr_SetObject(PyExc_BufferError, text_of(text).ptr());
    throw nb::python_error();
}

void warn(const std::string& text) {
    if (PyErr_WarnEx(PyExc_RuntimeWarning, text.c_str(), 1) != 0) throw nb::python_error();
}

std::string path_of(nb::handle path) {
    PyObject* encoded = nullptr;
    if (PyUnicode_FSConverter(path.ptr(), &encoded) != 0) {
        const auto bytes = nb::steal<nb::bytes>(encoded);
        return {bytes.c_str(), bytes.size()};
    }
    // ValueError: a NUL, or what the file system's encoding lacks.
    if (PyErr_ExceptionMatches(PyExc_ValueError) == 0) throw nb::python_error();
    PyErr_Clear();
    const nb::object shown = nb::repr(path);
    raise_usage(escaped(shown) + " cannot be the path of a file");
}

}  // namespace mavloom::python
