// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>

#include "flight/firmware/tables.hpp"
#include "mavloom/message/modes.hpp"

namespace mavloom::flight {

namespace {

// Values of MAV_STANDARD_MODE.
constexpr std::uint8_t standard_none = 0, standard_position = 1, standard_orbit = 2, standard_altitude = 4,
                       standard_return = 5, standard_mission = 6, standard_land = 7, standard_takeoff = 8;

constexpr std::uint8_t automatic = base_custom | base_stabilize | base_guided | base_auto;
constexpr std::uint8_t piloted = base_custom | base_stabilize | base_manual_input;
constexpr std::uint8_t direct = base_custom | base_manual_input;
constexpr std::uint8_t stabilized = base_custom | base_stabilize;

consteval ModeInfo px4_mode(std::string_view name, Behaviour behaviour, std::uint8_t base_mode,
                            std::uint8_t standard_mode = standard_none, std::uint32_t properties = mode_advanced) {
    return {.name = name,
            .custom_mode = message::number_of_mode(message::px4_flight_modes, name),
            .behaviour = behaviour,
            .base_mode = base_mode,
            .standard_mode = standard_mode,
            .properties = properties};
}
// PX4 lists these modes under this name until a ROS 2 program registers one.
consteval ModeInfo external_mode(std::string_view name) {
    ModeInfo mode = px4_mode(name, Behaviour::unavailable, stabilized, standard_none, mode_not_selectable);
    mode.name = "(Mode not available)";
    return mode;
}

using Px4Modes = std::array<ModeInfo, 28>;

// In the order in which PX4 1.17 lists them.
constexpr Px4Modes px4_quad_modes{
    px4_mode("Manual", Behaviour::manual, piloted),
    px4_mode("Altitude", Behaviour::altitude, piloted, standard_altitude, 0),
    px4_mode("Position", Behaviour::position, piloted, standard_position, 0),
    px4_mode("Mission", Behaviour::mission, automatic, standard_mission),
    px4_mode("Hold", Behaviour::hold, automatic),
    px4_mode("Return", Behaviour::return_home, automatic, standard_return),
    px4_mode("Position Slow", Behaviour::position, piloted),
    px4_mode("Guided Course", Behaviour::hold, automatic),
    px4_mode("Altitude Cruise", Behaviour::altitude, piloted),
    px4_mode("Acro", Behaviour::acro, direct),
    px4_mode("Descend", Behaviour::descend, automatic, standard_none, mode_advanced | mode_not_selectable),
    px4_mode("Termination", Behaviour::terminated, base_custom, standard_none, mode_advanced | mode_not_selectable),
    px4_mode("Offboard", Behaviour::offboard, stabilized),
    px4_mode("Stabilized", Behaviour::stabilized, piloted),
    px4_mode("Takeoff", Behaviour::takeoff, automatic, standard_takeoff),
    px4_mode("Land", Behaviour::land, automatic, standard_land),
    px4_mode("Follow Target", Behaviour::follow, automatic),
    px4_mode("Precision Landing", Behaviour::land, automatic),
    px4_mode("Orbit", Behaviour::orbit, stabilized, standard_orbit),
    px4_mode("VTOL Takeoff", Behaviour::unavailable, automatic),
    external_mode("External 1"),
    external_mode("External 2"),
    external_mode("External 3"),
    external_mode("External 4"),
    external_mode("External 5"),
    external_mode("External 6"),
    external_mode("External 7"),
    external_mode("External 8"),
};

// PX4 lists the same modes for all kinds of vehicles; their behaviours differ.
constexpr Px4Modes with_behaviour(Px4Modes modes, std::string_view name, Behaviour behaviour, std::uint8_t base_mode) {
    const auto at = std::ranges::find(modes, name, &ModeInfo::name);
    at->behaviour = behaviour;
    at->base_mode = base_mode;
    return modes;
}
constexpr Px4Modes without(Px4Modes modes, std::initializer_list<std::string_view> names) {
    for (const std::string_view name : names)
        std::ranges::find(modes, name, &ModeInfo::name)->behaviour = Behaviour::unavailable;
    return modes;
}
constexpr Px4Modes px4_plane_modes = without(with_behaviour(px4_quad_modes, "Manual", Behaviour::manual, direct),
                                             {"Position Slow", "Follow Target", "Precision Landing"});
constexpr Px4Modes px4_rover_modes = without(
    with_behaviour(px4_quad_modes, "Manual", Behaviour::manual, direct),
    {"Altitude", "Position Slow", "Altitude Cruise", "Takeoff", "Land", "Follow Target", "Precision Landing", "Orbit"});

}  // namespace

std::span<const ModeInfo> px4_modes(Kind kind) noexcept {
    return kind == Kind::quad ? px4_quad_modes : kind == Kind::plane ? px4_plane_modes : px4_rover_modes;
}

}  // namespace mavloom::flight
