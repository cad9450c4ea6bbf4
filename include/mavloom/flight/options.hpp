// SPDX-License-Identifier: MIT
// The properties of a simulated vehicle: kind, autopilot, home, seed and others. Plain values with defaults. Nothing
// here reports errors: module simserve checks what users type. docs/guide/sim.md describes every key.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/flight/body.hpp"
#include "mavloom/flight/noise_options.hpp"

namespace mavloom::flight {

enum class Kind : std::uint8_t { quad, plane, rover };
enum class Autopilot : std::uint8_t { px4, ardupilot };
// How the vehicle moves: `flight` simulates it; `random` sends random values that still agree with each other.
enum class Motion : std::uint8_t { flight, random };
// Which messages a link gets by default, and how often (docs/guide/sim.md, "Streams").
enum class Profile : std::uint8_t { lite, normal, px4_normal, px4_onboard, ardupilot, original };

inline constexpr std::string_view kind_names[] = {"quad", "plane", "rover"};
inline constexpr std::string_view autopilot_names[] = {"px4", "ardupilot"};
inline constexpr std::string_view motion_names[] = {"flight", "random"};
inline constexpr std::string_view profile_names[] = {"lite",        "default",   "px4-normal",
                                                     "px4-onboard", "ardupilot", "original"};

struct Home {
    double latitude_deg = 47.397742;  // the start position of PX4's built-in simulator
    double longitude_deg = 8.545594;
    double altitude_m = 489.4;  // above mean sea level; the ground is flat at this height
    double heading_deg = 0;     // clockwise from north
};
// Returns the place that is this far north and east of `home`, along the geodesic.
[[nodiscard]] Home moved(const Home& home, double north_m, double east_m);

// A steady wind with gusts. `direction_deg` is the direction in which the air moves.
struct Wind {
    double speed_m_s = 0;
    double direction_deg = 0;  // clockwise from north
    double gust_m_s = 0;       // standard deviation of the gusts
};

struct BatteryOptions {
    double capacity_mah = 5000;
    std::uint8_t cells = 4;
    double hover_minutes = 20;  // time from full to empty at hover current
    double start_percent = 100;
};

// Caps on what clients may store, so that no client exhausts the memory. A request beyond a cap gets the protocol's own
// error for that case.
struct Limits {
    std::size_t mission_items = 1000;
    std::size_t fence_items = 64;
    std::size_t rally_items = 32;
    std::size_t files = 64;
    std::size_t file_bytes = 256 * 1024;  // all files that clients wrote to one vehicle, together
    std::size_t clients = 64;             // clients of one vehicle with a transfer in progress
    std::size_t file_sessions = 8;        // of one client
    std::size_t flight_logs = 32;         // logs of flights; the oldest one goes first; 0 keeps none
    std::size_t log_records = 3000;       // of all logs of flights together, 88 bytes each
    // Changed parameters that all logs of flights have together, 8 bytes each. The newest log has all of its own.
    std::size_t log_parameters = 3000;
};

struct VehicleOptions {
    Kind kind = Kind::quad;
    Autopilot autopilot = Autopilot::px4;
    Motion motion = Motion::flight;
    SystemId system{1};
    Home home{};
    Wind wind{};
    BatteryOptions battery{};
    Limits limits{};
    std::uint64_t seed = 1;
    bool has_noise = true;
    NoiseOptions noise{};  // if it has any
    bool has_gimbal = false;
    bool has_manual_control = false;  // simulates a remote control; without one, clients may still send MANUAL_CONTROL
    std::size_t traffic = 0;          // simulated aircraft that ADSB_VEHICLE reports
    std::size_t logs = 2;             // recorded logs that can be downloaded
    // Time from boot until GPS, position and home are valid.
    Nanoseconds ready_after = std::chrono::milliseconds{2500};
    // It wakes with each step that may change what it reports, so that no stream decides when a change is reported. The
    // same inputs then give the same bytes on a link, whatever other links there are.
    bool wakes_for_changes = false;
    Body body{};
    WallTime utc_at_start{};  // UTC at flight time 0; the epoch means that UTC is unknown
};

}  // namespace mavloom::flight
