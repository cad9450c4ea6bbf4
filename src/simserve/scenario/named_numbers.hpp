// SPDX-License-Identifier: MIT
// Parses a preset and the numbers that change it: "iris,mass:1.8". Private to module simserve.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "simserve/scenario/values.hpp"

namespace mavloom::simserve {

// A key that sets one number of the target.
template <class Target>
struct NamedNumber {
    std::string_view name;
    Range range;
    double& (*of)(Target&);
};

constexpr std::string_view preset_name = "preset";

// The parts of the text. A first part without a name is the preset's.
inline SetupResult<std::vector<NamedPart>> named_parts_of(std::string_view text) {
    return parse_named_parts(text, preset_name);
}

inline std::optional<std::string_view> find_part(const std::vector<NamedPart>& parts, std::string_view name) {
    const auto part = std::ranges::find(parts, name, &NamedPart::first);
    return part == parts.end() ? std::nullopt : std::optional(part->second);
}

// The index of the preset that the parts name; 0 if they name none.
inline SetupResult<std::size_t> preset_index(const std::vector<NamedPart>& parts,
                                             std::span<const std::string_view> presets) {
    const auto name = find_part(parts, preset_name);
    if (!name) return 0;
    auto index = parse_choice(*name, presets);
    if (!index) return tl::unexpected(SetupError(index.error()).within(preset_name));
    return index;
}

// Sets the numbers. `others` are names of parts that are no numbers.
template <class Target>
SetupResult<void> set_named_numbers(Target& target, const std::vector<NamedPart>& parts,
                                    std::span<const NamedNumber<Target>> numbers,
                                    std::initializer_list<std::string_view> others) {
    std::vector<std::string_view> names(others);
    names.reserve(others.size() + numbers.size());
    for (const auto& number : numbers) names.push_back(number.name);
    for (const auto& [name, text] : parts) {
        const auto known = parse_choice(name, names);
        if (!known) return tl::unexpected(known.error());
        if (*known < others.size()) continue;
        const auto& number = numbers[*known - others.size()];
        const auto value = parse_number(text, number.range);
        if (!value) return tl::unexpected(SetupError(value.error()).within(number.name));
        number.of(target) = *value;
    }
    return {};
}

}  // namespace mavloom::simserve
