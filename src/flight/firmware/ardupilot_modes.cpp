// SPDX-License-Identifier: MIT
// What the vehicle does in ArduPilot's modes. mavloom/message/modes.hpp has their numbers.
#include <array>

#include "flight/firmware/tables.hpp"
#include "mavloom/message/modes.hpp"

namespace mavloom::flight {

namespace {

constexpr std::uint8_t by_pilot = base_custom | base_stabilize | base_manual_input;
constexpr std::uint8_t by_autopilot = by_pilot | base_guided;
constexpr std::uint8_t by_hand = base_custom | base_manual_input;

constexpr ModeInfo mode_of(std::string_view name, Behaviour behaviour, std::uint8_t base_mode,
                           std::uint32_t properties = 0) {
    return {.name = name, .behaviour = behaviour, .base_mode = base_mode, .properties = properties};
}
constexpr ModeInfo piloted_mode(std::string_view name, Behaviour behaviour) {
    return mode_of(name, behaviour, by_pilot);
}
constexpr ModeInfo auto_mode(std::string_view name, Behaviour behaviour) {
    return mode_of(name, behaviour, by_autopilot, mode_auto);
}
// A mode that needs equipment, or another kind of frame, that the vehicle does not have.
constexpr ModeInfo absent_mode(std::string_view name) {
    ModeInfo mode = mode_of(name, Behaviour::unavailable, by_pilot, mode_not_selectable);
    mode.is_listed = false;
    return mode;
}

template <std::size_t count>
consteval std::array<ModeInfo, count> numbered(std::array<ModeInfo, count> modes,
                                               std::span<const message::FlightMode> numbers) {
    for (ModeInfo& mode : modes) mode.custom_mode = message::number_of_mode(numbers, mode.name);
    return modes;
}

constexpr std::array copter_rows{
    piloted_mode("STABILIZE", Behaviour::stabilized),
    piloted_mode("ACRO", Behaviour::acro),
    piloted_mode("ALT_HOLD", Behaviour::altitude),
    auto_mode("AUTO", Behaviour::mission),
    auto_mode("GUIDED", Behaviour::offboard),
    piloted_mode("LOITER", Behaviour::position),
    auto_mode("RTL", Behaviour::return_home),
    auto_mode("CIRCLE", Behaviour::orbit),
    auto_mode("LAND", Behaviour::land),
    piloted_mode("DRIFT", Behaviour::altitude),
    piloted_mode("SPORT", Behaviour::altitude),
    absent_mode("FLIP"),
    piloted_mode("AUTOTUNE", Behaviour::altitude),
    piloted_mode("POSHOLD", Behaviour::position),
    auto_mode("BRAKE", Behaviour::brake),
    absent_mode("THROW"),
    auto_mode("AVOID_ADSB", Behaviour::hold),
    auto_mode("GUIDED_NOGPS", Behaviour::offboard),
    auto_mode("SMART_RTL", Behaviour::return_home),
    piloted_mode("FLOWHOLD", Behaviour::position),
    auto_mode("FOLLOW", Behaviour::follow),
    piloted_mode("ZIGZAG", Behaviour::position),
    absent_mode("SYSTEMID"),
    absent_mode("AUTOROTATE"),
    auto_mode("AUTO_RTL", Behaviour::return_home),
    absent_mode("TURTLE"),
};
constexpr auto copter_modes = numbered(copter_rows, message::copter_flight_modes);

constexpr std::array plane_rows{
    mode_of("MANUAL", Behaviour::manual, by_hand),
    auto_mode("CIRCLE", Behaviour::orbit),
    piloted_mode("STABILIZE", Behaviour::stabilized),
    piloted_mode("TRAINING", Behaviour::stabilized),
    piloted_mode("ACRO", Behaviour::acro),
    piloted_mode("FBWA", Behaviour::stabilized),
    piloted_mode("FBWB", Behaviour::altitude),
    piloted_mode("CRUISE", Behaviour::altitude),
    piloted_mode("AUTOTUNE", Behaviour::stabilized),
    auto_mode("AUTO", Behaviour::mission),
    auto_mode("RTL", Behaviour::return_home),
    auto_mode("LOITER", Behaviour::hold),
    auto_mode("TAKEOFF", Behaviour::takeoff),
    auto_mode("AVOID_ADSB", Behaviour::hold),
    auto_mode("GUIDED", Behaviour::offboard),
    absent_mode("INITIALISING"),
    absent_mode("QSTABILIZE"),
    absent_mode("QHOVER"),
    absent_mode("QLOITER"),
    absent_mode("QLAND"),
    absent_mode("QRTL"),
    absent_mode("QAUTOTUNE"),
    absent_mode("QACRO"),
    auto_mode("THERMAL", Behaviour::hold),
    absent_mode("LOITERALTQLAND"),
    auto_mode("AUTOLAND", Behaviour::land),
};
constexpr auto plane_modes = numbered(plane_rows, message::plane_flight_modes);

constexpr std::array rover_rows{
    mode_of("MANUAL", Behaviour::manual, by_hand), piloted_mode("ACRO", Behaviour::acro),
    piloted_mode("STEERING", Behaviour::acro),     auto_mode("HOLD", Behaviour::hold),
    auto_mode("LOITER", Behaviour::hold),          auto_mode("FOLLOW", Behaviour::follow),
    piloted_mode("SIMPLE", Behaviour::manual),     absent_mode("DOCK"),
    auto_mode("CIRCLE", Behaviour::orbit),         auto_mode("AUTO", Behaviour::mission),
    auto_mode("RTL", Behaviour::return_home),      auto_mode("SMART_RTL", Behaviour::return_home),
    auto_mode("GUIDED", Behaviour::offboard),      absent_mode("INITIALISING"),
};
constexpr auto rover_modes = numbered(rover_rows, message::rover_flight_modes);

}  // namespace

std::span<const ModeInfo> ardupilot_modes(Kind kind) noexcept {
    switch (kind) {
        case Kind::quad: return copter_modes;
        case Kind::plane: return plane_modes;
        default: return rover_modes;
    }
}

}  // namespace mavloom::flight
