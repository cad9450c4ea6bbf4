// SPDX-License-Identifier: MIT
#include "flight/firmware/firmware.hpp"

#include <algorithm>
#include <cctype>

#include "flight/firmware/tables.hpp"

namespace mavloom::flight {

namespace {

bool equals_ignoring_case(std::string_view a, std::string_view b) noexcept {
    return std::ranges::equal(a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

}  // namespace

const Firmware& Firmware::of(Autopilot autopilot, Kind kind) {
    return autopilot == Autopilot::px4 ? px4_firmware(kind) : ardupilot_firmware(kind);
}

const ModeInfo* Firmware::find_mode(std::uint32_t custom_mode) const noexcept {
    const auto at = std::ranges::find(modes(), custom_mode, &ModeInfo::custom_mode);
    return at == modes().end() ? nullptr : &*at;
}

const ModeInfo* Firmware::find_mode(std::string_view name) const noexcept {
    const auto at = std::ranges::find_if(modes(), [&](const ModeInfo& m) { return equals_ignoring_case(m.name, name); });
    return at == modes().end() ? nullptr : &*at;
}

}  // namespace mavloom::flight
