// SPDX-License-Identifier: MIT
#include <array>

#include "flight/firmware/tables.hpp"
#include "mavloom/msg/enums/mav_autopilot.hpp"
#include "mavloom/msg/enums/mav_protocol_capability.hpp"
#include "mavloom/msg/enums/mav_type.hpp"

namespace mavloom::flight {

namespace {

// Release 4.6.0; 255 means release.
constexpr VersionInfo ardupilot_version{.flight = 0x040600ff, .middleware = 0, .os = 0, .board = 0};

class ArduPilot final : public Firmware {
public:
    explicit ArduPilot(Kind kind) noexcept : kind_(kind) {}
    Autopilot autopilot() const noexcept override { return Autopilot::ardupilot; }
    std::uint8_t mav_autopilot() const noexcept override { return msg::MAV_AUTOPILOT_ARDUPILOTMEGA; }
    std::uint8_t mav_type() const noexcept override {
        constexpr std::array types{msg::MAV_TYPE_QUADROTOR, msg::MAV_TYPE_FIXED_WING, msg::MAV_TYPE_GROUND_ROVER};
        return static_cast<std::uint8_t>(types[static_cast<std::size_t>(kind_)]);
    }
    std::uint64_t capabilities(const VehicleOptions& options) const noexcept override;
    const VersionInfo& version() const noexcept override { return ardupilot_version; }
    const Texts& texts() const noexcept override { return ardupilot_texts(kind_); }
    std::span<const ModeInfo> modes() const noexcept override { return ardupilot_modes(kind_); }
    const ModeInfo& boot_mode() const noexcept override { return modes().front(); }
    const ModeInfo* mode_for(Behaviour behaviour) const noexcept override;
    const ModeInfo* requested_mode(std::uint8_t base_mode, std::uint32_t main,
                                   std::uint32_t sub) const noexcept override;
    std::span<const ParamInfo> parameters() const noexcept override { return ardupilot_parameters(kind_); }
    bool is_bytewise() const noexcept override { return false; }
    Tuning tuning(const Parameters& parameters) const override { return ardupilot_tuning(kind_, parameters); }
    bool has_home_in_mission() const noexcept override { return true; }

private:
    Kind kind_;
};

std::uint64_t ArduPilot::capabilities(const VehicleOptions& options) const noexcept {
    using namespace msg;
    std::uint64_t all = MAV_PROTOCOL_CAPABILITY_MISSION_FLOAT | MAV_PROTOCOL_CAPABILITY_PARAM_FLOAT |
                        MAV_PROTOCOL_CAPABILITY_MISSION_INT | MAV_PROTOCOL_CAPABILITY_COMMAND_INT |
                        MAV_PROTOCOL_CAPABILITY_FTP | MAV_PROTOCOL_CAPABILITY_SET_ATTITUDE_TARGET |
                        MAV_PROTOCOL_CAPABILITY_SET_POSITION_TARGET_LOCAL_NED |
                        MAV_PROTOCOL_CAPABILITY_SET_POSITION_TARGET_GLOBAL_INT |
                        MAV_PROTOCOL_CAPABILITY_FLIGHT_TERMINATION | MAV_PROTOCOL_CAPABILITY_MAVLINK2 |
                        MAV_PROTOCOL_CAPABILITY_MISSION_FENCE | MAV_PROTOCOL_CAPABILITY_MISSION_RALLY |
                        MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_C_CAST;
    if (options.has_gimbal) all |= MAV_PROTOCOL_CAPABILITY_COMPONENT_IMPLEMENTS_GIMBAL_MANAGER;
    return all;
}

// A copter that shall hold goes to LOITER, and one without a position comes down in LAND.
const ModeInfo* ArduPilot::mode_for(Behaviour behaviour) const noexcept {
    if (kind_ == Kind::quad && behaviour == Behaviour::hold) return find_mode("LOITER");
    if (kind_ == Kind::quad && behaviour == Behaviour::descend) return find_mode("LAND");
    if (kind_ != Kind::quad && behaviour == Behaviour::brake) behaviour = Behaviour::hold;
    for (const ModeInfo& mode : modes())
        if (mode.behaviour == behaviour) return &mode;
    return nullptr;
}

// ArduPilot knows custom modes only.
const ModeInfo* ArduPilot::requested_mode(std::uint8_t base_mode, std::uint32_t main,
                                          std::uint32_t /*sub*/) const noexcept {
    if ((base_mode & base_custom) == 0) return nullptr;
    const ModeInfo* const mode = find_mode(main);
    return mode != nullptr && mode->is_selectable() ? mode : nullptr;
}

constexpr Texts ardupilot_texts_of(std::string_view banner) {
    return {
        .banner = banner,
        .armed = "Arming motors",
        .disarmed = "Disarming motors",
        .disarmed_by_landing = "Disarming motors",
        .disarmed_without_takeoff = "Disarming motors",
        .not_ready = "PreArm: Vehicle is not ready",
        .no_position = "PreArm: Need a position",
        .not_in_mode = "Arm: this mode does not allow it",
        .not_landed = "Disarm refused: not landed",
        .mission_finished_hold = "Mission complete",
        .no_mission = "Auto refused: no mission",
        .battery_low = "Battery 1 is low",
        .battery_critical = "Battery 1 is low",
        .battery_emergency = "Battery 1 is critical",
        .gcs_lost = "GCS failsafe on",
        .gcs_regained = "GCS failsafe off",
        .manual_lost = "Radio failsafe on",
        .fence_breached = "Fence breached",
        .unknown_mode = "Unknown mode number",
        .mode_refused = "Mode change to {} refused",
        .takeoff_too_low = "Takeoff altitude is too low",
    };
}

constexpr std::array ardupilot_texts_table{ardupilot_texts_of("ArduCopter V4.6.0 (mavloom sim)"),
                                           ardupilot_texts_of("ArduPlane V4.6.0 (mavloom sim)"),
                                           ardupilot_texts_of("ArduRover V4.6.0 (mavloom sim)")};

}  // namespace

const Texts& ardupilot_texts(Kind kind) noexcept { return ardupilot_texts_table[static_cast<std::size_t>(kind)]; }

const Firmware& ardupilot_firmware(Kind kind) {
    static const ArduPilot quad(Kind::quad), plane(Kind::plane), rover(Kind::rover);
    return kind == Kind::quad ? quad : kind == Kind::plane ? plane : rover;
}

}  // namespace mavloom::flight
