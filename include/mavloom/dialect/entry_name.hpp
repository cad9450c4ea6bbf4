// SPDX-License-Identifier: MIT
// Names of enum entries for people.
#pragma once

#include <algorithm>
#include <string_view>

#include "mavloom/dialect/dialect.hpp"

namespace mavloom::dialect {

// The name without the enum's own name: "QUADROTOR" for MAV_TYPE 2. Empty if the enum has no such entry. Valid as long
// as the dialect.
[[nodiscard]] inline std::string_view short_entry_name(const Dialect& dialect, std::string_view enum_name,
                                                       std::uint64_t value) noexcept {
    const auto* const all = dialect.find_enum(enum_name);
    const auto* const entry = all == nullptr ? nullptr : all->find(value);
    if (entry == nullptr) return {};
    auto name = entry->name;
    if (name.starts_with(enum_name)) name.remove_prefix(std::min(enum_name.size() + 1, name.size()));
    return name;
}

}  // namespace mavloom::dialect
