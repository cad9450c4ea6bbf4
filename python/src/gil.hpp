// SPDX-License-Identifier: MIT
#pragma once

#include <nanobind/nanobind.h>

#include <mutex>

namespace mavloom::python {

namespace nb = nanobind;

// Takes a mutex whose holder may need the GIL: never waits for it with the GIL held.
[[nodiscard]] inline std::unique_lock<std::mutex> lock_without_gil(std::mutex& mutex) {
    std::unique_lock lock(mutex, std::try_to_lock);
    if (!lock.owns_lock()) {
        const nb::gil_scoped_release release;
        lock.lock();
    }
    return lock;
}

// Runs Python's signal handlers; raises what they raise.
inline void check_signals() {
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
}

}  // namespace mavloom::python
