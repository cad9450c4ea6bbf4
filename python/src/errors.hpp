// SPDX-License-Identifier: MIT
// Raises the library's errors as Python exceptions: the classes of mavloom/_errors.py, with the library's text.
// Call with the GIL held.
#pragma once

#include <nanobind/nanobind.h>

#include <string>
#include <utility>

#include "mavloom/base/result.hpp"

namespace mavloom::python {

namespace nb = nanobind;

// Raises mavloom.UsageError, InputError, NotFoundError, PermissionDeniedError or SystemFailure, depending on the
// error's code.
[[noreturn]] void raise(const SetupError& error);
[[noreturn]] void raise_usage(std::string text);
[[noreturn]] void raise_input(std::string text);
[[noreturn]] void raise_closed(const std::string& text);
[[noreturn]] void raise_error(const std::string& text);   // mavloom.Error itself
[[noreturn]] void raise_buffer(const std::string& text);  // Python's BufferError
// Issues a RuntimeWarning. Raises it if the user's filters turn it into an error. Hold no lock: filters run user code.
void warn(const std::string& text);

template <class T>
T value_or_raise(SetupResult<T>&& result) {
    if (!result) raise(result.error());
    if constexpr (!std::is_void_v<T>) return std::move(*result);
}

}  // namespace mavloom::python
