// SPDX-License-Identifier: MIT
// Scales raw integers whose units people cannot read easily, for example degE7, cdeg or dpix. Only the text format uses
// it; JSON and CSV always have raw values. Pure; allocates nothing.
#pragma once

#include <cmath>
#include <string_view>

#include "mavloom/dialect/dialect.hpp"

namespace mavloom::message {

struct Scale {
    std::string_view units;  // units to print; empty for none
    unsigned decimals = 0;   // printed value = raw / 10^decimals, exactly
    double factor = 1;       // if not 1: printed value = raw * factor, as a float
};

// Units with prefixes that people read easily (mm, cm, ms, us, mV, mAh, mG, hPa) are not scaled.
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

// For integer fields only. Uses the multiplier of the definition unless the units already imply a scale.
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
