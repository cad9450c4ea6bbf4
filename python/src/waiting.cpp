// SPDX-License-Identifier: MIT
#include "waiting.hpp"

#include <fmt/format.h>

#include <cmath>

namespace mavloom::python {

static constexpr auto for_ever = Nanoseconds{std::chrono::hours{24 * 365}};

Nanoseconds duration_of(const char* what, const nb::object& given) {
    const double seconds = PyFloat_AsDouble(given.ptr());
    if (PyErr_Occurred() != nullptr) throw nb::python_error();
    if (std::isnan(seconds)) raise_usage(fmt::format("{}: NaN is not a time", what));
    if (seconds >= std::chrono::duration<double>(for_ever).count()) return for_ever;
    return std::chrono::duration_cast<Nanoseconds>(std::chrono::duration<double>(std::max(seconds, 0.0)));
}

std::optional<Nanoseconds> timeout_of(const nb::object& given) {
    if (given.is_none()) return std::nullopt;
    return duration_of("timeout", given);
}

std::optional<Nanoseconds> match_timeout(std::optional<bool> blocking, const nb::object& timeout) {
    const auto given = timeout_of(timeout);
    return blocking.value_or(given.has_value()) ? given : Nanoseconds{};
}

MonoTime deadline_after(std::optional<Nanoseconds> timeout) {
    return timeout ? mono_now() + *timeout : MonoTime::max();
}

}  // namespace mavloom::python
