// SPDX-License-Identifier: MIT
#include "mavloom/message/modes.hpp"

#include <array>

#include "mavloom/base/text.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/msg/enums/mav_autopilot.hpp"
#include "mavloom/msg/enums/mav_mode_flag.hpp"
#include "mavloom/msg/enums/mav_type.hpp"
#include "mavloom/msg/heartbeat.hpp"

namespace mavloom::message {

namespace {

using Modes = std::span<const FlightMode>;

struct Vehicle {
    std::uint8_t type;  // MAV_TYPE
    Modes modes;
};

// The types that ArduPilot sends.
constexpr auto ardupilot_vehicles = std::to_array<Vehicle>({
    {msg::MAV_TYPE_FIXED_WING, plane_flight_modes},
    {msg::MAV_TYPE_QUADROTOR, copter_flight_modes},
    {msg::MAV_TYPE_COAXIAL, copter_flight_modes},
    {msg::MAV_TYPE_HELICOPTER, copter_flight_modes},
    {msg::MAV_TYPE_ANTENNA_TRACKER, tracker_flight_modes},
    {msg::MAV_TYPE_AIRSHIP, blimp_flight_modes},
    {msg::MAV_TYPE_GROUND_ROVER, rover_flight_modes},
    {msg::MAV_TYPE_SURFACE_BOAT, rover_flight_modes},
    {msg::MAV_TYPE_SUBMARINE, sub_flight_modes},
    {msg::MAV_TYPE_HEXAROTOR, copter_flight_modes},
    {msg::MAV_TYPE_OCTOROTOR, copter_flight_modes},
    {msg::MAV_TYPE_TRICOPTER, copter_flight_modes},
    {msg::MAV_TYPE_VTOL_TAILSITTER_DUOROTOR, plane_flight_modes},
    {msg::MAV_TYPE_VTOL_TAILSITTER_QUADROTOR, plane_flight_modes},
    {msg::MAV_TYPE_VTOL_TILTROTOR, plane_flight_modes},
    {msg::MAV_TYPE_VTOL_FIXEDROTOR, plane_flight_modes},
    {msg::MAV_TYPE_VTOL_TAILSITTER, plane_flight_modes},
    {msg::MAV_TYPE_VTOL_TILTWING, plane_flight_modes},
    {msg::MAV_TYPE_DODECAROTOR, copter_flight_modes},
    {msg::MAV_TYPE_DECAROTOR, copter_flight_modes},
});

constexpr std::string_view ignored = " _-.:";

// Returns the first character that counts, in lower case, and removes everything up to it. Returns 0 at the end.
char next_letter(std::string_view& name) noexcept {
    while (!name.empty()) {
        const char c = name.front();
        name.remove_prefix(1);
        if (ignored.find(c) != std::string_view::npos) continue;
        return lower(c);
    }
    return 0;
}

bool same_name(std::string_view a, std::string_view b) noexcept {
    while (true) {
        const char letter = next_letter(a);
        if (letter != next_letter(b)) return false;
        if (letter == 0) return true;
    }
}

bool has_name(const FlightMode& mode, std::string_view name) noexcept {
    if (same_name(mode.name, name)) return true;
    for (std::string_view others = mode.others; !others.empty();) {
        const auto end = std::min(others.find('|'), others.size());
        if (same_name(others.substr(0, end), name)) return true;
        others.remove_prefix(std::min(end + 1, others.size()));
    }
    return false;
}

}  // namespace

Modes flight_modes(std::uint8_t autopilot, std::uint8_t type) noexcept {
    if (autopilot == msg::MAV_AUTOPILOT_PX4) return px4_flight_modes;
    if (autopilot != msg::MAV_AUTOPILOT_ARDUPILOTMEGA) return {};
    const auto* const vehicle = std::ranges::find(ardupilot_vehicles, type, &Vehicle::type);
    return vehicle == ardupilot_vehicles.end() ? Modes{} : vehicle->modes;
}

std::string_view mode_name(Modes modes, std::uint32_t number) noexcept {
    const auto mode = std::ranges::find(modes, number, &FlightMode::number);
    return mode == modes.end() ? std::string_view{} : mode->name;
}

std::optional<std::uint32_t> mode_number(Modes modes, std::string_view name) noexcept {
    const auto mode = std::ranges::find_if(modes, [&](const FlightMode& m) { return has_name(m, name); });
    if (mode == modes.end()) return std::nullopt;
    return mode->number;
}

// The checksum's seed covers the types and names of the fields, so another definition of this id has another one.
bool has_mode(const dialect::Message& message) noexcept {
    return message.id() == msg::Heartbeat::id && message.wire.crc_extra == msg::Heartbeat::crc_extra;
}

std::string_view heartbeat_mode(ByteView payload) noexcept {
    const auto beat = msg::Heartbeat::decode(payload);
    if ((beat.base_mode & msg::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED) == 0) return {};
    return mode_name(flight_modes(beat.autopilot, beat.type), beat.custom_mode);
}

}  // namespace mavloom::message
