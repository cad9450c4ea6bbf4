// SPDX-License-Identifier: MIT
// Numbers and names of ArduPilot's modes: enums COPTER_MODE, PLANE_MODE and ROVER_MODE of its MAVLink dialect.
#include <array>

#include "flight/firmware/tables.hpp"

namespace mavloom::flight {

namespace {

constexpr std::uint8_t by_pilot = base_custom | base_stabilize | base_manual_input;
constexpr std::uint8_t by_autopilot = by_pilot | base_guided;
constexpr std::uint8_t by_hand = base_custom | base_manual_input;

constexpr ModeInfo mode_of(std::uint32_t number, std::string_view name, Behaviour behaviour, std::uint8_t base_mode,
                           std::uint32_t properties = 0) {
    return {
        .name = name, .custom_mode = number, .behaviour = behaviour, .base_mode = base_mode, .properties = properties};
}
constexpr ModeInfo piloted_mode(std::uint32_t number, std::string_view name, Behaviour behaviour) {
    return mode_of(number, name, behaviour, by_pilot);
}
constexpr ModeInfo auto_mode(std::uint32_t number, std::string_view name, Behaviour behaviour) {
    return mode_of(number, name, behaviour, by_autopilot, mode_auto);
}
// A mode that needs equipment, or another kind of frame, that the vehicle does not have.
constexpr ModeInfo absent_mode(std::uint32_t number, std::string_view name) {
    ModeInfo mode = mode_of(number, name, Behaviour::unavailable, by_pilot, mode_not_selectable);
    mode.is_listed = false;
    return mode;
}

constexpr std::array ardupilot_copter_modes{
    piloted_mode(0, "STABILIZE", Behaviour::stabilized),
    piloted_mode(1, "ACRO", Behaviour::acro),
    piloted_mode(2, "ALT_HOLD", Behaviour::altitude),
    auto_mode(3, "AUTO", Behaviour::mission),
    auto_mode(4, "GUIDED", Behaviour::offboard),
    piloted_mode(5, "LOITER", Behaviour::position),
    auto_mode(6, "RTL", Behaviour::return_home),
    auto_mode(7, "CIRCLE", Behaviour::orbit),
    auto_mode(9, "LAND", Behaviour::land),
    piloted_mode(11, "DRIFT", Behaviour::altitude),
    piloted_mode(13, "SPORT", Behaviour::altitude),
    absent_mode(14, "FLIP"),
    piloted_mode(15, "AUTOTUNE", Behaviour::altitude),
    piloted_mode(16, "POSHOLD", Behaviour::position),
    auto_mode(17, "BRAKE", Behaviour::brake),
    absent_mode(18, "THROW"),
    auto_mode(19, "AVOID_ADSB", Behaviour::hold),
    auto_mode(20, "GUIDED_NOGPS", Behaviour::offboard),
    auto_mode(21, "SMART_RTL", Behaviour::return_home),
    piloted_mode(22, "FLOWHOLD", Behaviour::position),
    auto_mode(23, "FOLLOW", Behaviour::follow),
    piloted_mode(24, "ZIGZAG", Behaviour::position),
    absent_mode(25, "SYSTEMID"),
    absent_mode(26, "AUTOROTATE"),
    auto_mode(27, "AUTO_RTL", Behaviour::return_home),
    absent_mode(28, "TURTLE"),
};

constexpr std::array ardupilot_plane_modes{
    mode_of(0, "MANUAL", Behaviour::manual, by_hand),
    auto_mode(1, "CIRCLE", Behaviour::orbit),
    piloted_mode(2, "STABILIZE", Behaviour::stabilized),
    piloted_mode(3, "TRAINING", Behaviour::stabilized),
    piloted_mode(4, "ACRO", Behaviour::acro),
    piloted_mode(5, "FBWA", Behaviour::stabilized),
    piloted_mode(6, "FBWB", Behaviour::altitude),
    piloted_mode(7, "CRUISE", Behaviour::altitude),
    piloted_mode(8, "AUTOTUNE", Behaviour::stabilized),
    auto_mode(10, "AUTO", Behaviour::mission),
    auto_mode(11, "RTL", Behaviour::return_home),
    auto_mode(12, "LOITER", Behaviour::hold),
    auto_mode(13, "TAKEOFF", Behaviour::takeoff),
    auto_mode(14, "AVOID_ADSB", Behaviour::hold),
    auto_mode(15, "GUIDED", Behaviour::offboard),
    absent_mode(16, "INITIALISING"),
    absent_mode(17, "QSTABILIZE"),
    absent_mode(18, "QHOVER"),
    absent_mode(19, "QLOITER"),
    absent_mode(20, "QLAND"),
    absent_mode(21, "QRTL"),
    absent_mode(22, "QAUTOTUNE"),
    absent_mode(23, "QACRO"),
    auto_mode(24, "THERMAL", Behaviour::hold),
    absent_mode(25, "LOITER2QLAND"),
    auto_mode(26, "AUTOLAND", Behaviour::land),
};

constexpr std::array ardupilot_rover_modes{
    mode_of(0, "MANUAL", Behaviour::manual, by_hand), piloted_mode(1, "ACRO", Behaviour::acro),
    piloted_mode(3, "STEERING", Behaviour::acro),     auto_mode(4, "HOLD", Behaviour::hold),
    auto_mode(5, "LOITER", Behaviour::hold),          auto_mode(6, "FOLLOW", Behaviour::follow),
    piloted_mode(7, "SIMPLE", Behaviour::manual),     absent_mode(8, "DOCK"),
    auto_mode(9, "CIRCLE", Behaviour::orbit),         auto_mode(10, "AUTO", Behaviour::mission),
    auto_mode(11, "RTL", Behaviour::return_home),     auto_mode(12, "SMART_RTL", Behaviour::return_home),
    auto_mode(15, "GUIDED", Behaviour::offboard),     absent_mode(16, "INITIALISING"),
};

}  // namespace

std::span<const ModeInfo> ardupilot_modes(Kind kind) noexcept {
    switch (kind) {
        case Kind::quad: return ardupilot_copter_modes;
        case Kind::plane: return ardupilot_plane_modes;
        default: return ardupilot_rover_modes;
    }
}

}  // namespace mavloom::flight
