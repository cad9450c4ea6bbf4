// SPDX-License-Identifier: MIT
// Rows of the tables of parameters, and the tables as they are written. Private to src/flight/firmware; constants.
//
// A name may stand for a family, by braces as in a shell: "RC{1..16}_MIN" for RC1_MIN to RC16_MIN, "INS_ACC{,2,3}_ID"
// for INS_ACC_ID, INS_ACC2_ID and INS_ACC3_ID. All its members have the same row.
#pragma once

#include <span>
#include <string_view>

#include "flight/firmware/parameters.hpp"
#include "mavloom/flight/options.hpp"

namespace mavloom::flight {

// Each method returns a copy of the row with one more property.
struct ParamRow : ParamInfo {
    [[nodiscard]] constexpr ParamRow in(double low, double high, std::string_view unit_name = {},
                                        std::uint8_t places = 0) const {
        ParamRow row = unit_of(unit_name, places);
        row.minimum = low;
        row.maximum = high;
        return row;
    }
    [[nodiscard]] constexpr ParamRow from(double low, std::string_view unit_name = {}, std::uint8_t places = 0) const {
        return in(low, unbounded, unit_name, places);
    }
    [[nodiscard]] constexpr ParamRow to(double high, std::string_view unit_name = {}, std::uint8_t places = 0) const {
        return in(-unbounded, high, unit_name, places);
    }
    [[nodiscard]] constexpr ParamRow unit_of(std::string_view unit_name, std::uint8_t places = 0) const {
        ParamRow row = *this;
        row.unit = unit_name;
        row.decimals = places;
        return row;
    }
    [[nodiscard]] constexpr ParamRow one_of(std::span<const ParamChoice> values) const {
        ParamRow row = *this;
        row.choices = values;
        return row;
    }
    [[nodiscard]] constexpr ParamRow bits_of(std::span<const ParamChoice> names) const {
        ParamRow row = *this;
        row.bit_names = names;
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
[[nodiscard]] constexpr ParamRow real(std::string_view name, double initial, std::string_view summary = {}) {
    return param(ParamType::real32, name, initial, summary);
}
[[nodiscard]] constexpr ParamRow int8(std::string_view name, double initial, std::string_view summary = {}) {
    return param(ParamType::int8, name, initial, summary);
}
[[nodiscard]] constexpr ParamRow int16(std::string_view name, double initial, std::string_view summary = {}) {
    return param(ParamType::int16, name, initial, summary);
}
[[nodiscard]] constexpr ParamRow int32(std::string_view name, double initial, std::string_view summary = {}) {
    return param(ParamType::int32, name, initial, summary);
}

struct ParamGroup {
    std::string_view name;
    std::span<const ParamRow> rows;
};
// An initial value that replaces that of the row. The name may stand for a family.
struct ParamPreset {
    std::string_view name;
    double initial;
};
struct ParamSource {
    std::span<const ParamGroup> groups;
    std::span<const ParamPreset> presets;
};

// The parameters of all vehicles of a firmware, and those that one kind has besides.
[[nodiscard]] ParamSource px4_common_source() noexcept;
[[nodiscard]] ParamSource px4_source(Kind kind) noexcept;
[[nodiscard]] ParamSource ardupilot_common_source() noexcept;
[[nodiscard]] ParamSource ardupilot_source(Kind kind) noexcept;

}  // namespace mavloom::flight
