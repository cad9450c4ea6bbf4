// SPDX-License-Identifier: MIT
#include "mavloom/message/view.hpp"

#include <limits>

#include "mavloom/message/visit.hpp"

namespace mavloom::message {
namespace {

// Casts without undefined behaviour: out-of-range values become the nearest limit, NaN becomes 0.
template <class Integer>
Integer saturate(double value) noexcept {
    constexpr double low = static_cast<double>(std::numeric_limits<Integer>::min());
    constexpr Integer half = std::numeric_limits<Integer>::max() / 2 + 1;
    constexpr double beyond = 2.0 * static_cast<double>(half);
    if (value >= beyond) return std::numeric_limits<Integer>::max();
    if (value > low) return static_cast<Integer>(value);
    return value <= low ? std::numeric_limits<Integer>::min() : Integer{0};
}

template <class Integer>
Integer as_integer(const MessageView& view, const dialect::Field& field, std::size_t index) noexcept {
    return visit_type(field.type, [&](auto tag) -> Integer {
        const auto value = view.get<decltype(tag)>(field, index);
        if constexpr (std::is_floating_point_v<decltype(tag)>) {
            return saturate<Integer>(value);
        } else {
            return static_cast<Integer>(value);
        }
    });
}

}  // namespace

double MessageView::number(const dialect::Field& field, std::size_t index) const noexcept {
    return visit_type(field.type, [&](auto tag) { return static_cast<double>(get<decltype(tag)>(field, index)); });
}

std::int64_t MessageView::integer(const dialect::Field& field, std::size_t index) const noexcept {
    return as_integer<std::int64_t>(*this, field, index);
}

std::uint64_t MessageView::unsigned_integer(const dialect::Field& field, std::size_t index) const noexcept {
    return as_integer<std::uint64_t>(*this, field, index);
}

std::string_view MessageView::text(const dialect::Field& field) const noexcept {
    if (field.offset >= payload_.size()) return {};
    const auto bytes = payload_.subspan(field.offset, std::min(field.size(), payload_.size() - field.offset));
    auto length = bytes.size();
    while (length > 0 && bytes[length - 1] == 0) --length;
    // The bytes are not validated here; the caller must expect any value.
    return {reinterpret_cast<const char*>(bytes.data()), length};
}

}  // namespace mavloom::message
