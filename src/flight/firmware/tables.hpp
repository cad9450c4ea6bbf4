// SPDX-License-Identifier: MIT
// Helpers that define tables of parameters, and the tables of both firmwares. Private to flight; constants.
#pragma once

#include <initializer_list>
#include <span>
#include <string_view>
#include <vector>

#include "flight/firmware/firmware.hpp"

namespace mavloom::flight {

// One row of a table. Each method returns a copy of the row with one more property.
struct ParamRow : ParamInfo {
    [[nodiscard]] constexpr ParamRow in(double low, double high, std::string_view unit_name = {},
                                        std::uint8_t places = 0) const {
        ParamRow row = *this;
        row.minimum = low;
        row.maximum = high;
        row.unit = unit_name;
        row.decimals = places;
        return row;
    }
    [[nodiscard]] constexpr ParamRow unit_of(std::string_view name_of_unit, std::uint8_t places = 0) const {
        ParamRow row = *this;
        row.unit = name_of_unit;
        row.decimals = places;
        return row;
    }
    [[nodiscard]] constexpr ParamRow one_of(std::span<const ParamChoice> values) const {
        ParamRow row = *this;
        row.choices = values;
        return row;
    }
    [[nodiscard]] constexpr ParamRow at_reboot() const {
        ParamRow row = *this;
        row.needs_reboot = true;
        return row;
    }
    // Marks a parameter that the vehicle changes by itself.
    [[nodiscard]] constexpr ParamRow by_vehicle() const {
        ParamRow row = *this;
        row.is_volatile = true;
        return row;
    }
};

[[nodiscard]] constexpr ParamRow param(ParamType type, std::string_view name, double initial, std::string_view summary) {
    ParamRow row;
    row.name = name;
    row.type = type;
    row.initial = initial;
    row.summary = summary;
    return row;
}
[[nodiscard]] constexpr ParamRow real(std::string_view name, double initial, std::string_view summary) {
    return param(ParamType::real32, name, initial, summary);
}
[[nodiscard]] constexpr ParamRow int8(std::string_view name, double initial, std::string_view summary) {
    return param(ParamType::int8, name, initial, summary);
}
[[nodiscard]] constexpr ParamRow int16(std::string_view name, double initial, std::string_view summary) {
    return param(ParamType::int16, name, initial, summary);
}
[[nodiscard]] constexpr ParamRow int32(std::string_view name, double initial, std::string_view summary) {
    return param(ParamType::int32, name, initial, summary);
}

struct ParamGroup {
    std::string_view name;
    std::span<const ParamRow> rows;
};
// An initial value that replaces the table's for one kind of vehicle.
struct ParamPreset {
    std::string_view name;
    double initial;
};

using ParamTable = std::vector<ParamInfo>;
// All rows of the groups, sorted by name.
[[nodiscard]] ParamTable joined(std::initializer_list<std::span<const ParamGroup>> groups,
                                std::span<const ParamPreset> presets);

[[nodiscard]] const ParamTable& px4_parameters(Kind kind);
[[nodiscard]] const ParamTable& ardupilot_parameters(Kind kind);

[[nodiscard]] std::span<const ModeInfo> px4_modes(Kind kind) noexcept;
[[nodiscard]] std::span<const ModeInfo> ardupilot_modes(Kind kind) noexcept;

[[nodiscard]] Tuning px4_tuning(Kind kind, const Parameters& parameters);
[[nodiscard]] Tuning ardupilot_tuning(Kind kind, const Parameters& parameters);

[[nodiscard]] const Texts& px4_texts() noexcept;
[[nodiscard]] const Texts& ardupilot_texts(Kind kind) noexcept;

[[nodiscard]] const Firmware& px4_firmware(Kind kind);
[[nodiscard]] const Firmware& ardupilot_firmware(Kind kind);

}  // namespace mavloom::flight
