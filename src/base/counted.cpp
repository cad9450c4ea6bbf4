// SPDX-License-Identifier: MIT
#include "mavloom/base/counted.hpp"

#include <array>

namespace mavloom {

std::string amount_text(double bytes) {
    constexpr std::array<std::string_view, 4> units{"B", "kB", "MB", "GB"};
    std::size_t unit = 0;
    for (; bytes >= 1000 && unit + 1 < units.size(); ++unit) bytes /= 1000;
    return fmt::format("{:.{}f} {}", bytes, unit == 0 || bytes >= 100 ? 0 : 1, units[unit]);
}

}  // namespace mavloom
