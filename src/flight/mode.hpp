// SPDX-License-Identifier: MIT
// Flight modes: what each firmware calls them, and what the vehicle does in them. Private to flight; plain values.
#pragma once

#include <cstdint>
#include <string_view>

namespace mavloom::flight {

// The vehicle's behaviour, independent of the firmware's name for it.
enum class Behaviour : std::uint8_t {
    manual,      // sticks to actuators
    acro,        // sticks to body rates
    stabilized,  // sticks to attitude and thrust
    altitude,    // sticks to attitude; height is held
    position,    // sticks to velocity; position is held
    hold,        // stays, or loiters
    mission,
    return_home,
    takeoff,
    land,
    orbit,
    follow,
    offboard,     // follows a client's set-points; for ArduPilot, Guided
    brake,        // stops as fast as possible, then holds
    descend,      // comes down without a position
    terminated,   // motors off until the next boot
    unavailable,  // is listed but cannot be selected
};

// MAV_MODE_FLAG bits of HEARTBEAT.base_mode.
enum BaseMode : std::uint8_t {
    base_custom = 1,
    base_auto = 4,
    base_guided = 8,
    base_stabilize = 16,
    base_manual_input = 64,
    base_armed = 128,
};

// MAV_MODE_PROPERTY bits.
enum ModeProperty : std::uint32_t { mode_advanced = 1, mode_not_selectable = 2, mode_auto = 4 };

struct ModeInfo {
    std::string_view name;          // for people: "Hold", "GUIDED"
    std::uint32_t custom_mode = 0;  // HEARTBEAT.custom_mode
    Behaviour behaviour = Behaviour::unavailable;
    std::uint8_t base_mode = base_custom;  // without base_armed
    std::uint8_t standard_mode = 0;        // MAV_STANDARD_MODE
    std::uint32_t properties = 0;          // MAV_MODE_PROPERTY
    bool is_listed = true;                 // AVAILABLE_MODES reports it

    // True if clients may ask for it.
    [[nodiscard]] constexpr bool is_selectable() const noexcept {
        return behaviour != Behaviour::unavailable && (properties & mode_not_selectable) == 0;
    }
};

// True if the behaviour needs a valid position.
[[nodiscard]] constexpr bool needs_position(Behaviour behaviour) noexcept {
    using enum Behaviour;
    switch (behaviour) {
        case position:
        case hold:
        case mission:
        case return_home:
        case takeoff:
        case orbit:
        case follow:
        case brake: return true;
        default: return false;
    }
}

// True if a pilot's sticks steer the vehicle.
[[nodiscard]] constexpr bool needs_sticks(Behaviour behaviour) noexcept { return behaviour <= Behaviour::position; }

}  // namespace mavloom::flight
