// SPDX-License-Identifier: MIT
#include <algorithm>
#include <iterator>

#include "flight/firmware/tables.hpp"
#include "mavloom/msg/enums/mav_autopilot.hpp"
#include "mavloom/msg/enums/mav_cmd.hpp"
#include "mavloom/msg/enums/mav_protocol_capability.hpp"

namespace mavloom::flight {

namespace {

// Release 4.6.0; 255 means release.
constexpr VersionInfo ardupilot_version{.flight = 0x040600ff, .middleware = 0, .os = 0, .board = 0};

class ArduPilot final : public Firmware {
public:
    explicit ArduPilot(Kind kind) noexcept : Firmware(kind) {}
    Autopilot autopilot() const noexcept override { return Autopilot::ardupilot; }
    std::uint8_t mav_autopilot() const noexcept override { return msg::MAV_AUTOPILOT_ARDUPILOTMEGA; }
    std::uint64_t capabilities(const VehicleOptions& options) const noexcept override;
    const VersionInfo& version() const noexcept override { return ardupilot_version; }
    const Texts& texts() const noexcept override { return ardupilot_texts(kind()); }
    std::span<const ModeInfo> modes() const noexcept override { return ardupilot_modes(kind()); }
    const ModeInfo& boot_mode() const noexcept override { return modes().front(); }
    const ModeInfo* mode_for(Behaviour behaviour) const noexcept override;
    const ModeInfo* requested_mode(std::uint8_t base_mode, std::uint32_t main,
                                   std::uint32_t sub) const noexcept override;
    std::span<const ParamInfo> parameters() const noexcept override { return ardupilot_parameters(kind()); }
    bool is_bytewise() const noexcept override { return false; }
    Tuning tuning(const Parameters& parameters) const override { return ardupilot_tuning(kind(), parameters); }
    bool has_home_in_mission() const noexcept override { return true; }
    std::string_view item_name(std::uint16_t command) const noexcept override;
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
    if (kind() == Kind::quad && behaviour == Behaviour::hold) return find_mode("LOITER");
    if (kind() == Kind::quad && behaviour == Behaviour::descend) return find_mode("LAND");
    if (kind() != Kind::quad && behaviour == Behaviour::brake) behaviour = Behaviour::hold;
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

// Sources: AP_Arming, AP_BattMonitor, AC_Fence and AP_Vehicle of ArduPilot 4.6; for the kinds of vehicles, the files of
// arming, modes and fail-safes.
constexpr Texts common_texts{
    .armed = "Throttle armed",
    .disarmed = "Throttle disarmed",
    .disarmed_by_landing = "Throttle disarmed",
    .disarmed_without_takeoff = "Throttle disarmed",
    .disarmed_by_crash = "Crash: Disarming",
    .refusals = {.booting = "PreArm: AHRS: EKF3 still initialising",
                 .position = "PreArm: GPS 1: Bad fix",
                 .home = "PreArm: AHRS: waiting for home",
                 .battery = "PreArm: Battery 1 low capacity failsafe",
                 .mode = "PreArm: {} mode not armable",
                 .mission = "PreArm: Mode requires mission",
                 .compass_runs = "PreArm: Compass calibration running",
                 .compass_calibrated = "PreArm: Compass calibrated requires reboot",
                 .accelerometer_runs = "PreArm: 3D Accel calibration needed",
                 .accelerometer_calibrated = "PreArm: Accels calibrated requires reboot"},
    .not_ready = "PreArm: Vehicle is not ready",
    .mission_received = "Flight plan received",
    .rally_received = "Rally points received",
    .item_begins = "Mission: {} {}",
    .item_jumps = "Mission: {} Jump {}/{}",
    .battery_low = "Battery 1 is low {}V used {} mAh",
    .battery_critical = "Battery 1 is low {}V used {} mAh",
    .battery_emergency = "Battery 1 is critical {}V used {} mAh",
    .gcs_lost = "GCS Failsafe",
    .gcs_regained = "GCS Failsafe Cleared",
    .manual_lost = "Radio Failsafe",
    .fence_breached = "{} breached",
    .fence_cleared = "Fence breach cleared",
    .unknown_mode = "No such mode {}",
    .mode_refused = "Flight mode change failed",
};

constexpr Texts copter_texts = [] {
    Texts texts = common_texts;
    texts.banner = "ArduCopter V4.6.0 (mavloom sim)";
    texts.armed = "Arming motors";
    texts.disarmed = texts.disarmed_by_landing = texts.disarmed_without_takeoff = "Disarming motors";
    texts.refusals.mode = "Arm: {} mode not armable";
    texts.mode_refused = "Mode change to {} failed: init failed";
    texts.battery_acts = "Battery Failsafe";
    texts.command_done = texts.loiter_time_done = "Reached command #{}";
    return texts;
}();
constexpr Texts plane_texts = [] {
    Texts texts = common_texts;
    texts.banner = "ArduPlane V4.6.0 (mavloom sim)";
    texts.gcs_lost = "GCS Failsafe On: {}";
    texts.gcs_regained = "GCS Failsafe Off";
    texts.manual_lost = "RC Long Failsafe On: {}";
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
    texts.refusals.mode = "PreArm: Mode not armable";
    texts.no_mission = "No Mission. Can't set AUTO.";
    texts.fence_breached = texts.fence_cleared = {};
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
