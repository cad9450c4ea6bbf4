// SPDX-License-Identifier: MIT
// Owns the strings and records of a dialect that was loaded from XML or merged. Their addresses never change. One
// thread fills the object; afterwards it is immutable and can be shared.
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "mavloom/dialect/dialect.hpp"

namespace mavloom::dialect {

struct Records {
    std::unordered_set<std::string> strings;
    std::deque<std::vector<Field>> fields;
    std::deque<std::vector<EnumEntry>> entries;
    std::deque<std::vector<CommandParam>> params;
    std::vector<Message> messages;                        // by ascending id
    std::vector<Enum> enums;                              // by name
    std::vector<std::shared_ptr<const void>> kept_alive;  // what the views of a merged dialect point into

    std::string_view intern(std::string_view text) { return *strings.emplace(text).first; }

    template <class T>
    static std::span<const T> keep(std::deque<std::vector<T>>& where, std::vector<T> records) {
        return where.emplace_back(std::move(records));
    }
};

struct Dialect::Storage : Records {};

// Finds an enum in a range that is sorted by name; null if there is none.
[[nodiscard]] const Enum* find_enum_in(std::span<const Enum> sorted, std::string_view name) noexcept;

}  // namespace mavloom::dialect
