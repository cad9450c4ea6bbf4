// SPDX-License-Identifier: MIT
#include "flight/firmware/param_tables/table.hpp"

#include <algorithm>
#include <charconv>

#include "flight/firmware/tables.hpp"

namespace mavloom::flight {

namespace {

int number_of(std::string_view text) noexcept {
    int number = 0;
    std::from_chars(text.data(), text.data() + text.size(), number);
    return number;
}

// "1..16" or "X,Y,Z".
std::vector<std::string> alternatives(std::string_view inside) {
    std::vector<std::string> found;
    if (const auto dots = inside.find(".."); dots != std::string_view::npos) {
        for (int i = number_of(inside.substr(0, dots)); i <= number_of(inside.substr(dots + 2)); ++i)
            found.push_back(std::to_string(i));
        return found;
    }
    for (;;) {
        const auto comma = inside.find(',');
        found.emplace_back(inside.substr(0, comma));
        if (comma == std::string_view::npos) return found;
        inside.remove_prefix(comma + 1);
    }
}

}  // namespace

std::vector<std::string> expanded(std::string_view name) {
    const auto open = name.find('{');
    if (open == std::string_view::npos) return {std::string(name)};
    const auto close = name.find('}', open);
    const auto tails = expanded(name.substr(close + 1));
    std::vector<std::string> names;
    for (const std::string& part : alternatives(name.substr(open + 1, close - open - 1)))
        for (const std::string& tail : tails)
            names.push_back(std::string(name.substr(0, open)).append(part).append(tail));
    return names;
}

ParamTable::ParamTable(std::initializer_list<ParamSource> sources) {
    for (const ParamSource& source : sources)
        for (const ParamGroup& group : source.groups) add(group);
    std::ranges::sort(rows_, {}, &ParamInfo::name);
    for (const ParamSource& source : sources)
        for (const ParamPreset& preset : source.presets) apply(preset);
}

void ParamTable::add(const ParamGroup& group) {
    for (const ParamRow& row : group.rows) {
        for (std::string& name : expanded(row.name)) {
            ParamInfo& info = rows_.emplace_back(row);
            info.name = names_.emplace_back(std::move(name));
            info.group = group.name;
        }
    }
}

void ParamTable::apply(const ParamPreset& preset) {
    for (const std::string& name : expanded(preset.name)) {
        const auto at = std::ranges::lower_bound(rows_, std::string_view(name), {}, &ParamInfo::name);
        if (at != rows_.end() && at->name == name) at->initial = preset.initial;
    }
}

std::span<const ParamInfo> px4_parameters(Kind kind) {
    static const ParamTable quad{px4_common_source(), px4_source(Kind::quad)};
    static const ParamTable plane{px4_common_source(), px4_source(Kind::plane)};
    static const ParamTable rover{px4_common_source(), px4_source(Kind::rover)};
    return (kind == Kind::quad ? quad : kind == Kind::plane ? plane : rover).rows();
}

std::span<const ParamInfo> ardupilot_parameters(Kind kind) {
    static const ParamTable quad{ardupilot_common_source(), ardupilot_source(Kind::quad)};
    static const ParamTable plane{ardupilot_common_source(), ardupilot_source(Kind::plane)};
    static const ParamTable rover{ardupilot_common_source(), ardupilot_source(Kind::rover)};
    return (kind == Kind::quad ? quad : kind == Kind::plane ? plane : rover).rows();
}

}  // namespace mavloom::flight
