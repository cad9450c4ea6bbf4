// SPDX-License-Identifier: MIT
#include "flight/firmware/firmware.hpp"

#include <algorithm>

#include "flight/firmware/tables.hpp"
#include "mavloom/message/modes.hpp"
#include "mavloom/msg/enums/mav_type.hpp"

namespace mavloom::flight {

const Firmware& Firmware::of(Autopilot autopilot, Kind kind) {
    return autopilot == Autopilot::px4 ? px4_firmware(kind) : ardupilot_firmware(kind);
}

std::uint8_t Firmware::mav_type() const noexcept {
    switch (kind_) {
        case Kind::plane: return msg::MAV_TYPE_FIXED_WING;
        case Kind::rover: return msg::MAV_TYPE_GROUND_ROVER;
        case Kind::quad: break;
    }
    return msg::MAV_TYPE_QUADROTOR;
}

std::uint8_t Firmware::mav_type_of(const CopterBody& body) const noexcept {
    if (kind_ != Kind::quad) return mav_type();
    switch (body.rotor_count) {
        case 6: return msg::MAV_TYPE_HEXAROTOR;
        case 8: return msg::MAV_TYPE_OCTOROTOR;
        case 12: return msg::MAV_TYPE_DODECAROTOR;
        default: return mav_type();
    }
}

const ModeInfo* Firmware::find_mode(std::uint32_t custom_mode) const noexcept {
    const auto at = std::ranges::find(modes(), custom_mode, &ModeInfo::custom_mode);
    return at == modes().end() ? nullptr : &*at;
}

const ModeInfo* Firmware::find_mode(std::string_view name) const noexcept {
    const auto number = message::mode_number(message::flight_modes(mav_autopilot(), mav_type()), name);
    return number ? find_mode(*number) : nullptr;
}

}  // namespace mavloom::flight
