// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>

#include "flight/firmware/tables.hpp"

namespace mavloom::flight {

namespace {

// Values of MAV_STANDARD_MODE.
constexpr std::uint8_t standard_none = 0, standard_position = 1, standard_orbit = 2, standard_altitude = 4,
                       standard_return = 5, standard_mission = 6, standard_land = 7, standard_takeoff = 8;

constexpr std::uint8_t automatic = base_custom | base_stabilize | base_guided | base_auto;
constexpr std::uint8_t piloted = base_custom | base_stabilize | base_manual_input;
constexpr std::uint8_t direct = base_custom | base_manual_input;
constexpr std::uint8_t stabilized = base_custom | base_stabilize;

constexpr ModeInfo px4_mode(std::string_view name, std::uint32_t main, std::uint32_t sub, Behaviour behaviour,
                            std::uint8_t base_mode, std::uint8_t standard_mode = standard_none,
                            std::uint32_t properties = mode_advanced) {
    return {.name = name,
            .custom_mode = sub << 24 | main << 16,
            .behaviour = behaviour,
            .base_mode = base_mode,
            .standard_mode = standard_mode,
            .properties = properties};
}
constexpr ModeInfo external_mode(std::uint32_t sub) {
    return px4_mode("(Mode not available)", 4, sub, Behaviour::unavailable, stabilized, standard_none,
                    mode_not_selectable);
}

using Px4Modes = std::array<ModeInfo, 28>;

// In the order in which PX4 1.17 lists them.
constexpr Px4Modes px4_quad_modes{
    px4_mode("Manual", 1, 0, Behaviour::manual, piloted),
    px4_mode("Altitude", 2, 0, Behaviour::altitude, piloted, standard_altitude, 0),
    px4_mode("Position", 3, 0, Behaviour::position, piloted, standard_position, 0),
    px4_mode("Mission", 4, 4, Behaviour::mission, automatic, standard_mission),
    px4_mode("Hold", 4, 3, Behaviour::hold, automatic),
    px4_mode("Return", 4, 5, Behaviour::return_home, automatic, standard_return),
    px4_mode("Position Slow", 3, 2, Behaviour::position, piloted),
    px4_mode("Guided Course", 4, 19, Behaviour::hold, automatic),
    px4_mode("Altitude Cruise", 11, 0, Behaviour::altitude, piloted),
    px4_mode("Acro", 5, 0, Behaviour::acro, direct),
    px4_mode("Descend", 4, 20, Behaviour::descend, automatic, standard_none, mode_advanced | mode_not_selectable),
    px4_mode("Termination", 10, 0, Behaviour::terminated, base_custom, standard_none,
             mode_advanced | mode_not_selectable),
    px4_mode("Offboard", 6, 0, Behaviour::offboard, stabilized),
    px4_mode("Stabilized", 7, 0, Behaviour::stabilized, piloted),
    px4_mode("Takeoff", 4, 2, Behaviour::takeoff, automatic, standard_takeoff),
    px4_mode("Land", 4, 6, Behaviour::land, automatic, standard_land),
    px4_mode("Follow Target", 4, 8, Behaviour::follow, automatic),
    px4_mode("Precision Landing", 4, 9, Behaviour::land, automatic),
    px4_mode("Orbit", 3, 1, Behaviour::orbit, stabilized, standard_orbit),
    px4_mode("VTOL Takeoff", 4, 10, Behaviour::unavailable, automatic),
    external_mode(11),
    external_mode(12),
    external_mode(13),
    external_mode(14),
    external_mode(15),
    external_mode(16),
    external_mode(17),
    external_mode(18),
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
