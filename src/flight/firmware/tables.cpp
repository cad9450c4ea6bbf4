// SPDX-License-Identifier: MIT
#include "flight/firmware/tables.hpp"

#include <algorithm>

namespace mavloom::flight {

ParamTable joined(std::initializer_list<std::span<const ParamGroup>> groups, std::span<const ParamPreset> presets) {
    ParamTable table;
    for (const auto list : groups)
        for (const ParamGroup& group : list)
            for (const ParamRow& row : group.rows) table.emplace_back(row).group = group.name;
    std::ranges::sort(table, {}, &ParamInfo::name);
    for (const ParamPreset& preset : presets) {
        const auto at = std::ranges::lower_bound(table, preset.name, {}, &ParamInfo::name);
        if (at != table.end() && at->name == preset.name) at->initial = preset.initial;
    }
    return table;
}

}  // namespace mavloom::flight
