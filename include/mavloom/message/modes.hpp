// SPDX-License-Identifier: MIT
// Names of flight modes: the only table of them. HEARTBEAT has a number, `custom_mode`, whose meaning depends on the
// autopilot and the type of vehicle.
//
// Sources: PX4's src/modules/commander/px4_custom_mode.h and src/lib/modes/ui.hpp; ArduPilot's enums COPTER_MODE,
// PLANE_MODE, ROVER_MODE, SUB_MODE and TRACKER_MODE; pymavlink's mode mappings; QGroundControl's FirmwarePlugins; the
// names that mavros and MAVSDK use. Constants and pure functions, safe from any thread; nothing allocates.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "mavloom/base/bytes.hpp"

namespace mavloom::dialect {
struct Message;
}

namespace mavloom::message {

struct FlightMode {
    std::uint32_t number = 0;   // HEARTBEAT.custom_mode
    std::string_view name;      // the name that is printed: for PX4 as in QGroundControl, for ArduPilot its own
    std::string_view others{};  // other programs' names, separated by '|'. Case and the characters " _-.:" do not
                                // matter: AUTO.LOITER stands for auto_loiter and auto:loiter, too. Which PX4 mode
                                // is which of ArduPilot's: as in MAVSDK.
};

[[nodiscard]] constexpr std::uint32_t px4_mode_number(std::uint32_t main, std::uint32_t sub = 0) noexcept {
    return sub << 24 | main << 16;
}

// clang-format off
inline constexpr auto px4_flight_modes = std::to_array<FlightMode>({
    {px4_mode_number(1), "Manual"},
    {px4_mode_number(2), "Altitude", "ALTCTL|ALT_HOLD|ALTITUDE_HOLD"},
    {px4_mode_number(3), "Position", "POSCTL|POSHOLD|POSITION_HOLD"},
    {px4_mode_number(3, 1), "Orbit"},
    {px4_mode_number(3, 2), "Position Slow"},
    {px4_mode_number(4, 1), "Ready", "AUTO.READY"},
    {px4_mode_number(4, 2), "Takeoff", "AUTO.TAKEOFF"},
    {px4_mode_number(4, 3), "Hold", "AUTO.LOITER|LOITER"},
    {px4_mode_number(4, 4), "Mission", "AUTO.MISSION|AUTO"},
    {px4_mode_number(4, 5), "Return", "AUTO.RTL|RTL|RETURN_TO_LAUNCH"},
    {px4_mode_number(4, 6), "Land", "AUTO.LAND"},
    {px4_mode_number(4, 7), "Return to Groundstation", "AUTO.RTGS|RTGS"},
    {px4_mode_number(4, 8), "Follow Target", "AUTO.FOLLOW_TARGET|FOLLOWME|FOLLOW"},
    {px4_mode_number(4, 9), "Precision Landing", "AUTO.PRECLAND|PRECISION_LAND"},
    {px4_mode_number(4, 10), "VTOL Takeoff", "AUTO.VTOL_TAKEOFF"},
    {px4_mode_number(4, 11), "External 1", "EXT1"},
    {px4_mode_number(4, 12), "External 2", "EXT2"},
    {px4_mode_number(4, 13), "External 3", "EXT3"},
    {px4_mode_number(4, 14), "External 4", "EXT4"},
    {px4_mode_number(4, 15), "External 5", "EXT5"},
    {px4_mode_number(4, 16), "External 6", "EXT6"},
    {px4_mode_number(4, 17), "External 7", "EXT7"},
    {px4_mode_number(4, 18), "External 8", "EXT8"},
    {px4_mode_number(4, 19), "Guided Course"},
    {px4_mode_number(4, 20), "Descend"},
    {px4_mode_number(5), "Acro"},
    {px4_mode_number(6), "Offboard"},
    {px4_mode_number(7), "Stabilized", "STAB|STABILIZE"},
    {px4_mode_number(8), "Rattitude"},
    {px4_mode_number(9), "Simple"},
    {px4_mode_number(10), "Termination"},
    {px4_mode_number(11), "Altitude Cruise"},
});

inline constexpr auto copter_flight_modes = std::to_array<FlightMode>({
    {0, "STABILIZE", "STABILIZED"}, {1, "ACRO"}, {2, "ALT_HOLD", "ALTITUDE_HOLD|ALTITUDE|ALTCTL"},
    {3, "AUTO", "MISSION|AUTO.MISSION"}, {4, "GUIDED"}, {5, "LOITER", "HOLD|AUTO.LOITER"},
    {6, "RTL", "RETURN|RETURN_TO_LAUNCH"}, {7, "CIRCLE"}, {8, "POSITION"}, {9, "LAND", "AUTO.LAND"},
    {10, "OF_LOITER"}, {11, "DRIFT"}, {13, "SPORT"}, {14, "FLIP"}, {15, "AUTOTUNE"},
    {16, "POSHOLD", "POSITION_HOLD|POSCTL"}, {17, "BRAKE"}, {18, "THROW"}, {19, "AVOID_ADSB"}, {20, "GUIDED_NOGPS"},
    {21, "SMART_RTL"}, {22, "FLOWHOLD"}, {23, "FOLLOW", "FOLLOWME|FOLLOW_TARGET|AUTO.FOLLOW_TARGET"}, {24, "ZIGZAG"},
    {25, "SYSTEMID"}, {26, "AUTOROTATE"}, {27, "AUTO_RTL"}, {28, "TURTLE"}, {29, "RATE_ACRO"},
});

inline constexpr auto plane_flight_modes = std::to_array<FlightMode>({
    {0, "MANUAL"}, {1, "CIRCLE"}, {2, "STABILIZE", "STABILIZED"}, {3, "TRAINING"}, {4, "ACRO"},
    {5, "FBWA", "FLY_BY_WIRE_A"}, {6, "FBWB", "FLY_BY_WIRE_B"}, {7, "CRUISE"}, {8, "AUTOTUNE"},
    {10, "AUTO", "MISSION|AUTO.MISSION"}, {11, "RTL", "RETURN|RETURN_TO_LAUNCH|AUTO.RTL"},
    {12, "LOITER", "HOLD|AUTO.LOITER"}, {13, "TAKEOFF", "AUTO.TAKEOFF"}, {14, "AVOID_ADSB"}, {15, "GUIDED"},
    {16, "INITIALISING", "INITIALIZING"},
    {17, "QSTABILIZE", "QUADPLANE_STABILIZE"}, {18, "QHOVER", "QUADPLANE_HOVER"}, {19, "QLOITER", "QUADPLANE_LOITER"},
    {20, "QLAND", "QUADPLANE_LAND"}, {21, "QRTL", "QUADPLANE_RTL"}, {22, "QAUTOTUNE", "QUADPLANE_AUTOTUNE"},
    {23, "QACRO", "QUADPLANE_ACRO"}, {24, "THERMAL"}, {25, "LOITERALTQLAND", "LOITER2QLAND|LOITER_TO_QLAND"},
    {26, "AUTOLAND"},
});

inline constexpr auto rover_flight_modes = std::to_array<FlightMode>({
    {0, "MANUAL"}, {1, "ACRO"}, {2, "LEARNING"}, {3, "STEERING"}, {4, "HOLD", "AUTO.LOITER"}, {5, "LOITER"}, {6, "FOLLOW"},
    {7, "SIMPLE"}, {8, "DOCK"}, {9, "CIRCLE"}, {10, "AUTO", "MISSION"}, {11, "RTL", "RETURN"}, {12, "SMART_RTL"},
    {15, "GUIDED"}, {16, "INITIALISING", "INITIALIZING"},
});

inline constexpr auto sub_flight_modes = std::to_array<FlightMode>({
    {0, "STABILIZE"}, {1, "ACRO"}, {2, "ALT_HOLD", "DEPTH_HOLD"}, {3, "AUTO", "MISSION"}, {4, "GUIDED"}, {7, "CIRCLE"},
    {9, "SURFACE"}, {16, "POSHOLD", "POSITION_HOLD"}, {19, "MANUAL"}, {20, "MOTORDETECT", "MOTOR_DETECTION"},
    {21, "SURFTRAK"},
});

inline constexpr auto tracker_flight_modes = std::to_array<FlightMode>({
    {0, "MANUAL"}, {1, "STOP"}, {2, "SCAN"}, {4, "GUIDED"}, {10, "AUTO"}, {16, "INITIALISING", "INITIALIZING"},
});

inline constexpr auto blimp_flight_modes = std::to_array<FlightMode>({
    {0, "LAND"}, {1, "MANUAL"}, {2, "VELOCITY"}, {3, "LOITER"}, {4, "RTL", "RETURN"}, {5, "AUTO", "MISSION"},
    {6, "HOLD"},
});
// clang-format on

// The modes of a vehicle by its HEARTBEAT: MAV_AUTOPILOT and MAV_TYPE. Empty if its modes are not known, for example
// for a ground station.
[[nodiscard]] std::span<const FlightMode> flight_modes(std::uint8_t autopilot, std::uint8_t type) noexcept;

// The name of a mode; empty if it is not known.
[[nodiscard]] std::string_view mode_name(std::span<const FlightMode> modes, std::uint32_t number) noexcept;
// The number of the mode that has this name, in any of the vocabularies above.
[[nodiscard]] std::optional<std::uint32_t> mode_number(std::span<const FlightMode> modes,
                                                       std::string_view name) noexcept;

// True for HEARTBEAT, the message that has a mode.
[[nodiscard]] bool has_mode(const dialect::Message& message) noexcept;
// The name of the mode in the payload of a HEARTBEAT; empty if the sender has no mode with a name.
[[nodiscard]] std::string_view heartbeat_mode(ByteView payload) noexcept;

// For tables that are keyed by these names: the number of a mode by its printed name. A wrong name does not compile.
[[nodiscard]] consteval std::uint32_t number_of_mode(std::span<const FlightMode> modes, std::string_view name) {
    return std::ranges::find(modes, name, &FlightMode::name)->number;
}

}  // namespace mavloom::message
