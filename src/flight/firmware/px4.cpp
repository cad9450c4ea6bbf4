// SPDX-License-Identifier: MIT
#include "flight/firmware/tables.hpp"
#include "mavloom/msg/enums/mav_autopilot.hpp"
#include "mavloom/msg/enums/mav_mode_flag.hpp"
#include "mavloom/msg/enums/mav_protocol_capability.hpp"

namespace mavloom::flight {

namespace {

// The vehicle reports release 1.17.0 (major, minor, patch, type; 255 means release) and hash 0 of its sources.
constexpr VersionInfo px4_version{.flight = 0x011100ff, .middleware = 0x011100ff, .os = 0x060c00ff, .board = 1};

// In MAV_CMD_DO_SET_MODE and in the custom mode, PX4 numbers its modes by these main modes and sub modes.
constexpr std::uint32_t main_manual = 1, main_position = 3, main_auto = 4, main_stabilized = 7;
constexpr std::uint32_t sub_mission = 4;

class Px4 final : public Firmware {
public:
    explicit Px4(Kind kind) noexcept : Firmware(kind) {}
    Autopilot autopilot() const noexcept override { return Autopilot::px4; }
    std::uint8_t mav_autopilot() const noexcept override { return msg::MAV_AUTOPILOT_PX4; }
    std::uint64_t capabilities(const VehicleOptions& options) const noexcept override;
    const VersionInfo& version() const noexcept override { return px4_version; }
    const Texts& texts() const noexcept override { return px4_texts(); }
    std::span<const ModeInfo> modes() const noexcept override { return px4_modes(kind()); }
    const ModeInfo& boot_mode() const noexcept override { return *mode_for(Behaviour::hold); }
    const ModeInfo* mode_for(Behaviour behaviour) const noexcept override;
    const ModeInfo* requested_mode(std::uint8_t base_mode, std::uint32_t main,
                                   std::uint32_t sub) const noexcept override;
    std::span<const ParamInfo> parameters() const noexcept override { return px4_parameters(kind()); }
    bool is_bytewise() const noexcept override { return true; }
    Tuning tuning(const Parameters& parameters) const override { return px4_tuning(kind(), parameters); }
    bool has_home_in_mission() const noexcept override { return false; }

private:
    [[nodiscard]] const ModeInfo* numbered(std::uint32_t main, std::uint32_t sub) const noexcept {
        return find_mode(sub << 24 | main << 16);
    }
};

std::uint64_t Px4::capabilities(const VehicleOptions& options) const noexcept {
    using namespace msg;
    std::uint64_t all = MAV_PROTOCOL_CAPABILITY_MISSION_FLOAT | MAV_PROTOCOL_CAPABILITY_PARAM_FLOAT |
                        MAV_PROTOCOL_CAPABILITY_MISSION_INT | MAV_PROTOCOL_CAPABILITY_COMMAND_INT |
                        MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_BYTEWISE | MAV_PROTOCOL_CAPABILITY_FTP |
                        MAV_PROTOCOL_CAPABILITY_SET_ATTITUDE_TARGET |
                        MAV_PROTOCOL_CAPABILITY_SET_POSITION_TARGET_LOCAL_NED |
                        MAV_PROTOCOL_CAPABILITY_SET_POSITION_TARGET_GLOBAL_INT |
                        MAV_PROTOCOL_CAPABILITY_FLIGHT_TERMINATION | MAV_PROTOCOL_CAPABILITY_MAVLINK2 |
                        MAV_PROTOCOL_CAPABILITY_MISSION_FENCE | MAV_PROTOCOL_CAPABILITY_MISSION_RALLY;
    if (options.has_gimbal) all |= MAV_PROTOCOL_CAPABILITY_COMPONENT_IMPLEMENTS_GIMBAL_MANAGER;
    return all;
}

const ModeInfo* Px4::mode_for(Behaviour behaviour) const noexcept {
    if (behaviour == Behaviour::brake) behaviour = Behaviour::hold;
    if (behaviour == Behaviour::hold) return numbered(main_auto, 3);  // "Guided Course" holds, too
    for (const ModeInfo& mode : modes())
        if (mode.behaviour == behaviour) return &mode;
    return nullptr;
}

// Without the flag for custom modes, the other flags of the base mode decide. The mission is the auto mode without a
// sub mode. A client may also send the whole custom mode as `main`.
const ModeInfo* Px4::requested_mode(std::uint8_t base_mode, std::uint32_t main, std::uint32_t sub) const noexcept {
    if ((base_mode & base_custom) == 0) {
        if ((base_mode & base_auto) != 0) return numbered(main_auto, sub_mission);
        if ((base_mode & base_manual_input) == 0) return nullptr;
        if ((base_mode & base_guided) != 0) return numbered(main_position, 0);
        return numbered((base_mode & base_stabilize) != 0 ? main_stabilized : main_manual, 0);
    }
    const ModeInfo* const mode = main > 0xff                     ? find_mode(main)
                                 : main == main_auto && sub == 0 ? numbered(main_auto, sub_mission)
                                 : sub <= 0xff                   ? numbered(main, sub)
                                                                 : nullptr;
    return mode != nullptr && mode->is_selectable() ? mode : nullptr;
}

// Texts and texts of events that PX4 1.17 sends. The tab at their ends is missing here: PX4 marks by it a text that it
// also sends as an event.
constexpr Texts px4_texts_table{
    .armed = "Armed by external command",
    .disarmed = "Disarmed by external command",
    .disarmed_by_landing = "Disarmed by landing",
    .disarmed_without_takeoff = "Disarmed by auto preflight disarming",
    .disarmed_by_crash = "Disarmed by failure detector",
    .takeoff_detected = "Takeoff detected",
    .landing_detected = "Landing detected",
    .refusals = {.position = "Navigation error: No valid position estimate"},
    .not_ready = "Arming denied: Resolve system health failures first",
    .no_position = "Navigation error: No valid position estimate",
    .not_landed = "Disarming denied: not landed",
    .mission_finished_landed = "Mission finished, landed",
    .mission_finished_hold = "Mission finished, loitering",
    .no_mission = "Mission start denied! No valid mission",
    .executing_mission = "Executing Mission",
    .climb_to = "Climb to {} meters above home",
    .return_ordered = "Returning to launch",
    .return_begins = "RTL: start return at {} m ({} m above destination)",
    .return_lands = "RTL: land at destination",
    .battery_low = "Low battery level, return advised",
    .battery_critical = "Critical battery level, land now",
    .battery_emergency = "Emergency battery level, land immediately",
    .gcs_lost = "Connection to ground control station lost",
    .gcs_regained = "GCS connection regained",
    .offboard_lost = "No offboard signal",
    .manual_lost = "Manual control lost",
    .fence_breached = "Geofence violation",
    .unknown_mode = "Unsupported auto mode",
    .mode_refused = "Switching to mode '{}' is currently not possible",
    .takeoff_too_low = "Already higher than takeoff altitude (not descending)",
    .offboard_without_setpoints = "Switching to mode 'Offboard' is currently not possible",
};

}  // namespace

const Texts& px4_texts() noexcept { return px4_texts_table; }

const Firmware& px4_firmware(Kind kind) {
    static const Px4 quad(Kind::quad), plane(Kind::plane), rover(Kind::rover);
    return kind == Kind::quad ? quad : kind == Kind::plane ? plane : rover;
}

}  // namespace mavloom::flight
