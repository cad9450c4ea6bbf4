// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <iterator>

#include "flight/firmware/tables.hpp"
#include "mavloom/msg/enums/mav_autopilot.hpp"
#include "mavloom/msg/enums/mav_cmd.hpp"
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
    std::string_view item_name(std::uint16_t command) const noexcept override;

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

// The names that ArduPilot 4.6 gives to the commands of a mission in its texts.
struct ItemName {
    std::uint16_t command;
    std::string_view name;
};
constexpr ItemName item_names[] = {
    {msg::MAV_CMD_NAV_WAYPOINT, "WP"},
    {msg::MAV_CMD_NAV_LOITER_UNLIM, "LoitUnlim"},
    {msg::MAV_CMD_NAV_LOITER_TURNS, "LoitTurns"},
    {msg::MAV_CMD_NAV_LOITER_TIME, "LoitTime"},
    {msg::MAV_CMD_NAV_RETURN_TO_LAUNCH, "RTL"},
    {msg::MAV_CMD_NAV_LAND, "Land"},
    {msg::MAV_CMD_NAV_TAKEOFF, "Takeoff"},
    {msg::MAV_CMD_NAV_CONTINUE_AND_CHANGE_ALT, "ContinueAndChangeAlt"},
    {msg::MAV_CMD_NAV_LOITER_TO_ALT, "LoitAltitude"},
    {msg::MAV_CMD_NAV_SPLINE_WAYPOINT, "SplineWP"},
    {msg::MAV_CMD_NAV_ALTITUDE_WAIT, "AltitudeWait"},
    {msg::MAV_CMD_NAV_VTOL_TAKEOFF, "VTOLTakeoff"},
    {msg::MAV_CMD_NAV_VTOL_LAND, "VTOLLand"},
    {msg::MAV_CMD_NAV_GUIDED_ENABLE, "GuidedEnable"},
    {msg::MAV_CMD_NAV_DELAY, "Delay"},
    {msg::MAV_CMD_NAV_PAYLOAD_PLACE, "PayloadPlace"},
    {msg::MAV_CMD_CONDITION_DELAY, "CondDelay"},
    {msg::MAV_CMD_CONDITION_DISTANCE, "CondDist"},
    {msg::MAV_CMD_CONDITION_YAW, "CondYaw"},
    {msg::MAV_CMD_DO_CHANGE_SPEED, "ChangeSpeed"},
    {msg::MAV_CMD_DO_SET_HOME, "SetHome"},
    {msg::MAV_CMD_DO_SET_RELAY, "SetRelay"},
    {msg::MAV_CMD_DO_REPEAT_RELAY, "RepeatRelay"},
    {msg::MAV_CMD_DO_SET_SERVO, "SetServo"},
    {msg::MAV_CMD_DO_REPEAT_SERVO, "RepeatServo"},
    {msg::MAV_CMD_DO_LAND_START, "LandStart"},
    {msg::MAV_CMD_DO_GO_AROUND, "Go Around"},
    {msg::MAV_CMD_DO_PAUSE_CONTINUE, "PauseContinue"},
    {msg::MAV_CMD_DO_SET_REVERSE, "SetReverse"},
    {msg::MAV_CMD_DO_CONTROL_VIDEO, "CtrlVideo"},
    {msg::MAV_CMD_DO_SET_ROI, "SetROI"},
    {msg::MAV_CMD_DO_DIGICAM_CONFIGURE, "DigiCamCfg"},
    {msg::MAV_CMD_DO_DIGICAM_CONTROL, "DigiCamCtrl"},
    {msg::MAV_CMD_DO_MOUNT_CONTROL, "MountControl"},
    {msg::MAV_CMD_DO_SET_CAM_TRIGG_DIST, "SetCamTrigDst"},
    {msg::MAV_CMD_DO_FENCE_ENABLE, "FenceEnable"},
    {msg::MAV_CMD_DO_PARACHUTE, "Parachute"},
    {msg::MAV_CMD_DO_INVERTED_FLIGHT, "InvertedFlight"},
    {msg::MAV_CMD_DO_GRIPPER, "Gripper"},
    {msg::MAV_CMD_DO_AUTOTUNE_ENABLE, "AutoTuneEnable"},
    {msg::MAV_CMD_DO_GUIDED_LIMITS, "GuidedLimits"},
    {msg::MAV_CMD_DO_ENGINE_CONTROL, "EngineControl"},
    {msg::MAV_CMD_DO_VTOL_TRANSITION, "VTOLTransition"},
    {msg::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, "GimbalPitchYaw"},
    {msg::MAV_CMD_DO_WINCH, "Winch"},
};

// A jump is not announced like the other items.
std::string_view ArduPilot::item_name(std::uint16_t command) const noexcept {
    if (command == msg::MAV_CMD_DO_JUMP) return {};
    const auto* const at = std::ranges::find(item_names, command, &ItemName::command);
    return at == std::end(item_names) ? "?" : at->name;
}

constexpr Texts common_texts{
    .armed = "Throttle armed",
    .disarmed = "Throttle disarmed",
    .disarmed_by_landing = "Throttle disarmed",
    .disarmed_without_takeoff = "Throttle disarmed",
    .not_ready = "PreArm: Vehicle is not ready",
    .no_position = "PreArm: Need a position",
    .not_in_mode = "Arm: this mode does not allow it",
    .not_landed = "Disarm refused: not landed",
    .no_mission = "Auto refused: no mission",
    .mission_received = "Flight plan received",
    .rally_received = "Rally points received",
    .item_begins = "Mission: {} {}",
    .item_jumps = "Mission: {} Jump {}/{}",
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

constexpr Texts copter_texts = [] {
    Texts texts = common_texts;
    texts.banner = "ArduCopter V4.6.0 (mavloom sim)";
    texts.armed = "Arming motors";
    texts.disarmed = texts.disarmed_by_landing = texts.disarmed_without_takeoff = "Disarming motors";
    texts.command_done = texts.loiter_time_done = "Reached command #{}";
    return texts;
}();
constexpr Texts plane_texts = [] {
    Texts texts = common_texts;
    texts.banner = "ArduPlane V4.6.0 (mavloom sim)";
    texts.waypoint_reached = "Reached waypoint #{} dist {}m";
    texts.waypoint_passed = "Passed waypoint #{} dist {}m";
    texts.turns_done = "Loiter orbits complete";
    texts.loiter_time_done = "Loiter time complete";
    texts.loiter_altitude_done = "Loiter to alt complete";
    texts.takeoff_done = "Takeoff complete at {}m";
    texts.mission_finished_hold = "Mission complete, changing mode to RTL";
    return texts;
}();
constexpr Texts rover_texts = [] {
    Texts texts = common_texts;
    texts.banner = "ArduRover V4.6.0 (mavloom sim)";
    texts.waypoint_reached = texts.waypoint_passed = "Reached waypoint #{}";
    texts.waypoint_held = "Reached waypoint #{}. Loiter for {} seconds";
    texts.loiter_time_done = "Finished active loiter";
    texts.mission_finished_hold = texts.mission_finished_landed = "Mission Complete";
    return texts;
}();

}  // namespace

const Texts& ardupilot_texts(Kind kind) noexcept {
    return kind == Kind::quad ? copter_texts : kind == Kind::plane ? plane_texts : rover_texts;
}

const Firmware& ardupilot_firmware(Kind kind) {
    static const ArduPilot quad(Kind::quad), plane(Kind::plane), rover(Kind::rover);
    return kind == Kind::quad ? quad : kind == Kind::plane ? plane : rover;
}

}  // namespace mavloom::flight
