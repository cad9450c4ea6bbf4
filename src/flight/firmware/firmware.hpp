// SPDX-License-Identifier: MIT
// The differences between PX4 and ArduPilot, and between kinds of vehicles: modes, parameters, numbers and texts.
// Private to flight and sim. A Firmware is immutable and shared by all vehicles; any thread may read it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "flight/firmware/parameters.hpp"
#include "flight/mode.hpp"
#include "flight/tuning.hpp"
#include "mavloom/flight/options.hpp"

namespace mavloom::flight {

struct VersionInfo {
    std::uint32_t flight = 0;  // AUTOPILOT_VERSION.flight_sw_version
    std::uint32_t middleware = 0, os = 0, board = 0;
    std::array<std::uint8_t, 8> custom{};
    std::uint16_t vendor = 0, product = 0;
};

// The texts by which a vehicle refuses to arm, where it has one for the reason. `{}` stands for the mode's name.
struct Refusals {
    std::string_view booting{}, position{}, home{}, battery{}, mode{}, mission{};
    std::string_view compass_runs{}, compass_calibrated{}, accelerometer_runs{}, accelerometer_calibrated{};
};

// The texts that a vehicle sends. `{}` stands for a number or a mode's name. Where a firmware sends nothing, the text
// is empty.
struct Texts {
    std::string_view banner{};  // name and version, for a client that connects
    std::string_view armed{}, disarmed{}, disarmed_by_landing{}, disarmed_without_takeoff{}, disarmed_by_crash{};
    std::string_view takeoff_detected{}, landing_detected{};
    Refusals refusals{};
    std::string_view not_ready{}, no_position{}, not_landed{};
    std::string_view mission_finished_landed{}, mission_finished_hold{}, no_mission{};
    std::string_view executing_mission{}, climb_to{};
    std::string_view mission_received{}, rally_received{};  // for the client that uploaded them
    std::string_view item_begins{}, item_jumps{};           // number and name; number, jumps done and jumps wanted
    std::string_view waypoint_reached{}, waypoint_passed{}, waypoint_held{};  // number and distance, or seconds to wait
    std::string_view command_done{}, turns_done{}, loiter_time_done{}, loiter_altitude_done{}, takeoff_done{};
    std::string_view return_ordered{}, return_begins{}, return_lands{};
    std::string_view battery_low{}, battery_critical{}, battery_emergency{}, battery_acts{};  // volts and mAh
    std::string_view gcs_lost{}, gcs_regained{}, offboard_lost{}, manual_lost{};  // the mode that the vehicle enters
    std::string_view fence_breached{}, fence_cleared{};                           // the fences
    std::string_view unknown_mode{}, mode_refused{}, takeoff_too_low{}, offboard_without_setpoints{};
};

class Firmware {
public:
    // The firmware of a kind of vehicle.
    [[nodiscard]] static const Firmware& of(Autopilot autopilot, Kind kind);

    virtual ~Firmware() = default;

    [[nodiscard]] virtual Autopilot autopilot() const noexcept = 0;
    [[nodiscard]] bool is_px4() const noexcept { return autopilot() == Autopilot::px4; }
    [[nodiscard]] virtual std::uint8_t mav_autopilot() const noexcept = 0;  // MAV_AUTOPILOT
    [[nodiscard]] Kind kind() const noexcept { return kind_; }
    [[nodiscard]] std::uint8_t mav_type() const noexcept;  // MAV_TYPE; of a multicopter, that of a quadrotor
    // MAV_TYPE of a vehicle with this body.
    [[nodiscard]] std::uint8_t mav_type_of(const CopterBody& body) const noexcept;
    [[nodiscard]] virtual std::uint64_t capabilities(const VehicleOptions& options) const noexcept = 0;
    [[nodiscard]] virtual const VersionInfo& version() const noexcept = 0;
    [[nodiscard]] virtual const Texts& texts() const noexcept = 0;

    // All modes in the order of AVAILABLE_MODES.
    [[nodiscard]] virtual std::span<const ModeInfo> modes() const noexcept = 0;
    [[nodiscard]] virtual const ModeInfo& boot_mode() const noexcept = 0;
    // The mode that the vehicle enters for a behaviour, in a fail-safe or on an order such as NAV_LAND. Null if this
    // kind of vehicle has no such mode.
    [[nodiscard]] virtual const ModeInfo* mode_for(Behaviour behaviour) const noexcept = 0;
    [[nodiscard]] const ModeInfo* find_mode(std::uint32_t custom_mode) const noexcept;
    [[nodiscard]] const ModeInfo* find_mode(std::string_view name) const noexcept;  // case does not matter
    // The mode that DO_SET_MODE or SET_MODE asks for. Null if there is no such mode.
    [[nodiscard]] virtual const ModeInfo* requested_mode(std::uint8_t base_mode, std::uint32_t main,
                                                         std::uint32_t sub) const noexcept = 0;

    // Definitions, sorted by name.
    [[nodiscard]] virtual std::span<const ParamInfo> parameters() const noexcept = 0;
    // True: PARAM_VALUE.param_value holds the bytes of an integer (PX4). False: it holds the integer as a float
    // (ArduPilot).
    [[nodiscard]] virtual bool is_bytewise() const noexcept = 0;
    // The parameter that holds the system id. A change takes effect after a reboot.
    [[nodiscard]] std::string_view system_parameter() const noexcept {
        return is_px4() ? "MAV_SYS_ID" : "SYSID_THISMAV";
    }
    [[nodiscard]] virtual Tuning tuning(const Parameters& parameters) const = 0;
    // ArduPilot keeps home as item 0 of the mission.
    [[nodiscard]] virtual bool has_home_in_mission() const noexcept = 0;
    // The name that Texts::item_begins has for a MAV_CMD.
    [[nodiscard]] virtual std::string_view item_name(std::uint16_t /*command*/) const noexcept { return {}; }

protected:
    explicit Firmware(Kind kind) noexcept : kind_(kind) {}

private:
    Kind kind_;
};

}  // namespace mavloom::flight
