// SPDX-License-Identifier: MIT
// The table of parameters of one kind of vehicle, made from rows. Private to src/flight/firmware; immutable.
#pragma once

#include <deque>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "flight/firmware/param_tables/rows.hpp"

namespace mavloom::flight {

// All names that a name with braces stands for, in the order in which it is written.
[[nodiscard]] std::vector<std::string> expanded(std::string_view name);

class ParamTable {
public:
    // Presets count in the order of the sources.
    ParamTable(std::initializer_list<ParamSource> sources);
    ParamTable(const ParamTable&) = delete;  // the rows point at the names
    ParamTable& operator=(const ParamTable&) = delete;

    [[nodiscard]] std::span<const ParamInfo> rows() const noexcept { return rows_; }  // sorted by name

private:
    void add(const ParamGroup& group);
    void apply(const ParamPreset& preset);

    std::deque<std::string> names_;
    std::vector<ParamInfo> rows_;
};

}  // namespace mavloom::flight
