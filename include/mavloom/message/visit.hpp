// SPDX-License-Identifier: MIT
// Maps a field's type at run time to a C++ type at compile time. `char` maps to std::uint8_t.
#pragma once

#include <cstdint>
#include <utility>

#include "mavloom/dialect/dialect.hpp"

namespace mavloom::message {

// Calls `f` with a zero value of the field's type. Only the type of the argument matters.
template <class F>
constexpr decltype(auto) visit_type(dialect::FieldType type, F&& f) {
    using enum dialect::FieldType;
    switch (type) {
        case char8:
        case u8: return std::forward<F>(f)(std::uint8_t{});
        case i8: return std::forward<F>(f)(std::int8_t{});
        case u16: return std::forward<F>(f)(std::uint16_t{});
        case i16: return std::forward<F>(f)(std::int16_t{});
        case u32: return std::forward<F>(f)(std::uint32_t{});
        case i32: return std::forward<F>(f)(std::int32_t{});
        case u64: return std::forward<F>(f)(std::uint64_t{});
        case i64: return std::forward<F>(f)(std::int64_t{});
        case f32: return std::forward<F>(f)(float{});
        case f64: break;
    }
    return std::forward<F>(f)(double{});
}

}  // namespace mavloom::message
