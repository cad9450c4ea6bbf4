// SPDX-License-Identifier: MIT
// The rule for the names of rings, routers and groups. Pure; allocates nothing.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace mavloom {

inline constexpr std::size_t longest_name = 64;

// True for a valid name: 1 to 64 of A-Z a-z 0-9 _ -.
[[nodiscard]] constexpr bool is_name(std::string_view text) noexcept {
    const auto good = [](char c) {
        return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    };
    return !text.empty() && text.size() <= longest_name && std::ranges::all_of(text, good);
}

}  // namespace mavloom
