// SPDX-License-Identifier: MIT
// Which raw numbers people cannot read, and what to show instead: integers in degE7, centi- and deci- units. Only the text form uses it;
// JSON and CSV are always raw. Pure; allocates nothing.
#pragma once

#include <cmath>
#include <string_view>

#include "mavloom/dialect/dialect.hpp"

namespace mavloom::message {

struct Scale {
    std::string_view units;  // to print; empty for none
    unsigned decimals = 0;   // shown value = raw / 10^decimals, exactly
    double factor = 1;       // another multiplier: shown value = raw * factor, as a float
};

// Plain prefixes that people do read (mm, cm, ms, us, mV, mAh, mG, hPa) stay raw.
[[nodiscard]] constexpr Scale scale_of_units(std::string_view units) noexcept {
    struct Known {
        std::string_view raw, shown;
        unsigned decimals;
    };
    constexpr Known known[] = {{"degE7", "deg", 7},    {"degE5", "deg", 5},    {"cdeg", "deg", 2},
                               {"cdegC", "degC", 2},   {"c%", "%", 2},         {"d%", "%", 1},
                               {"cA", "A", 2},         {"cV", "V", 2},         {"cs", "s", 2},
                               {"ds", "s", 1},         {"ddeg/s", "deg/s", 1}, {"dpix", "pix", 1},
                               {"cdeg/s", "deg/s", 2}, {"mrad", "rad", 3},     {"mrad/s", "rad/s", 3}};
    for (const auto& k : known)
        if (k.raw == units) return {k.shown, k.decimals};
    return {units, 0};
}

// Integer fields only. The multiplier counts where the units do not already say it.
[[nodiscard]] inline Scale scale_of(const dialect::Field& field) noexcept {
    auto scale = scale_of_units(field.units);
    if (scale.decimals != 0 || field.multiplier <= 0 || field.multiplier == 1) return scale;
    const double decimals = -std::log10(field.multiplier);
    if (std::abs(decimals - std::round(decimals)) < 1e-9 && decimals > 0 && decimals < 19) {
        scale.decimals = static_cast<unsigned>(std::lround(decimals));
    } else {
        scale.factor = field.multiplier;
    }
    return scale;
}

}  // namespace mavloom::message
