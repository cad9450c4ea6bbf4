// SPDX-License-Identifier: MIT
#include "sim/store/plan_items.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mavloom/msg/enums/mav_cmd.hpp"
#include "mavloom/msg/enums/mav_frame.hpp"
#include "mavloom/msg/enums/mav_mission_result.hpp"

namespace mavloom::sim {

namespace {

using namespace msg;
using Int32 = std::numeric_limits<std::int32_t>;

// Commands that both firmwares execute or skip in a mission.
constexpr std::array<std::uint16_t, 38> common_commands{MAV_CMD_NAV_WAYPOINT,
                                                        MAV_CMD_NAV_LOITER_UNLIM,
                                                        MAV_CMD_NAV_LOITER_TURNS,
                                                        MAV_CMD_NAV_LOITER_TIME,
                                                        MAV_CMD_NAV_RETURN_TO_LAUNCH,
                                                        MAV_CMD_NAV_LAND,
                                                        MAV_CMD_NAV_TAKEOFF,
                                                        MAV_CMD_NAV_LOITER_TO_ALT,
                                                        MAV_CMD_NAV_VTOL_TAKEOFF,
                                                        MAV_CMD_NAV_VTOL_LAND,
                                                        MAV_CMD_NAV_DELAY,
                                                        MAV_CMD_CONDITION_DELAY,
                                                        MAV_CMD_DO_JUMP,
                                                        MAV_CMD_DO_CHANGE_SPEED,
                                                        MAV_CMD_DO_SET_HOME,
                                                        MAV_CMD_DO_LAND_START,
                                                        MAV_CMD_DO_SET_ROI_LOCATION,
                                                        MAV_CMD_DO_SET_ROI_WPNEXT_OFFSET,
                                                        MAV_CMD_DO_SET_ROI_NONE,
                                                        MAV_CMD_DO_SET_ROI,
                                                        MAV_CMD_DO_MOUNT_CONFIGURE,
                                                        MAV_CMD_DO_MOUNT_CONTROL,
                                                        MAV_CMD_DO_SET_CAM_TRIGG_DIST,
                                                        MAV_CMD_DO_GRIPPER,
                                                        MAV_CMD_DO_AUTOTUNE_ENABLE,
                                                        MAV_CMD_DO_DIGICAM_CONTROL,
                                                        MAV_CMD_SET_CAMERA_MODE,
                                                        MAV_CMD_SET_CAMERA_ZOOM,
                                                        MAV_CMD_SET_CAMERA_FOCUS,
                                                        MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW,
                                                        MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE,
                                                        MAV_CMD_IMAGE_START_CAPTURE,
                                                        MAV_CMD_IMAGE_STOP_CAPTURE,
                                                        MAV_CMD_VIDEO_START_CAPTURE,
                                                        MAV_CMD_VIDEO_STOP_CAPTURE,
                                                        MAV_CMD_DO_TRIGGER_CONTROL,
                                                        MAV_CMD_DO_VTOL_TRANSITION,
                                                        MAV_CMD_DO_WINCH};
constexpr std::array<std::uint16_t, 6> px4_commands{
    MAV_CMD_CONDITION_GATE, MAV_CMD_DO_SET_ACTUATOR,      MAV_CMD_DO_SET_CAM_TRIGG_INTERVAL,
    MAV_CMD_OBLIQUE_SURVEY, MAV_CMD_COMPONENT_ARM_DISARM, MAV_CMD_NAV_ROI};
constexpr std::array<std::uint16_t, 24> ardupilot_commands{MAV_CMD_NAV_CONTINUE_AND_CHANGE_ALT,
                                                           MAV_CMD_NAV_SPLINE_WAYPOINT,
                                                           MAV_CMD_NAV_ALTITUDE_WAIT,
                                                           MAV_CMD_NAV_GUIDED_ENABLE,
                                                           MAV_CMD_NAV_PAYLOAD_PLACE,
                                                           MAV_CMD_CONDITION_DISTANCE,
                                                           MAV_CMD_CONDITION_YAW,
                                                           MAV_CMD_DO_SET_RELAY,
                                                           MAV_CMD_DO_REPEAT_RELAY,
                                                           MAV_CMD_DO_SET_SERVO,
                                                           MAV_CMD_DO_REPEAT_SERVO,
                                                           MAV_CMD_DO_RETURN_PATH_START,
                                                           MAV_CMD_DO_SET_REVERSE,
                                                           MAV_CMD_DO_DIGICAM_CONFIGURE,
                                                           MAV_CMD_DO_FENCE_ENABLE,
                                                           MAV_CMD_DO_PARACHUTE,
                                                           MAV_CMD_DO_INVERTED_FLIGHT,
                                                           MAV_CMD_DO_SET_RESUME_REPEAT_DIST,
                                                           MAV_CMD_DO_SPRAYER,
                                                           MAV_CMD_DO_SEND_SCRIPT_MESSAGE,
                                                           MAV_CMD_DO_AUX_FUNCTION,
                                                           MAV_CMD_DO_GUIDED_LIMITS,
                                                           MAV_CMD_DO_ENGINE_CONTROL,
                                                           MAV_CMD_JUMP_TAG};

// Commands that mean nothing without a place.
constexpr std::array<std::uint16_t, 6> place_commands{MAV_CMD_NAV_WAYPOINT,        MAV_CMD_NAV_LOITER_UNLIM,
                                                      MAV_CMD_NAV_LOITER_TURNS,    MAV_CMD_NAV_LOITER_TO_ALT,
                                                      MAV_CMD_NAV_SPLINE_WAYPOINT, MAV_CMD_CONDITION_GATE};

bool contains(std::span<const std::uint16_t> commands, std::uint16_t command) noexcept {
    return std::ranges::find(commands, command) != commands.end();
}

bool has_position_frame(std::uint8_t frame) noexcept {
    constexpr std::array<std::uint8_t, 6> frames{MAV_FRAME_GLOBAL,
                                                 MAV_FRAME_GLOBAL_RELATIVE_ALT,
                                                 MAV_FRAME_GLOBAL_INT,
                                                 MAV_FRAME_GLOBAL_RELATIVE_ALT_INT,
                                                 MAV_FRAME_GLOBAL_TERRAIN_ALT,
                                                 MAV_FRAME_GLOBAL_TERRAIN_ALT_INT};
    return std::ranges::find(frames, frame) != frames.end();
}

// The variant of a global frame that belongs to MISSION_ITEM_INT, or to MISSION_ITEM.
std::uint8_t variant_of(std::uint8_t frame, bool is_int) noexcept {
    switch (frame) {
        case MAV_FRAME_GLOBAL:
        case MAV_FRAME_GLOBAL_INT: return is_int ? MAV_FRAME_GLOBAL_INT : MAV_FRAME_GLOBAL;
        case MAV_FRAME_GLOBAL_RELATIVE_ALT:
        case MAV_FRAME_GLOBAL_RELATIVE_ALT_INT:
            return is_int ? MAV_FRAME_GLOBAL_RELATIVE_ALT_INT : MAV_FRAME_GLOBAL_RELATIVE_ALT;
        case MAV_FRAME_GLOBAL_TERRAIN_ALT:
        case MAV_FRAME_GLOBAL_TERRAIN_ALT_INT:
            return is_int ? MAV_FRAME_GLOBAL_TERRAIN_ALT_INT : MAV_FRAME_GLOBAL_TERRAIN_ALT;
        default: return frame;
    }
}

// Items without a place carry plain numbers in x and y.
double scale_of(std::uint8_t frame) noexcept { return has_position_frame(frame) ? 1e7 : 1; }

bool is_set(std::int32_t coordinate) noexcept { return coordinate != Int32::min() && coordinate != Int32::max(); }

std::int32_t to_integer(float coordinate, double scale) noexcept {
    if (std::isnan(coordinate)) return Int32::max();
    const double scaled = std::round(double{coordinate} * scale);
    return static_cast<std::int32_t>(std::clamp(scaled, double{Int32::min()}, double{Int32::max()}));
}

float to_float(std::int32_t coordinate, double scale) noexcept {
    return is_set(coordinate) ? static_cast<float>(coordinate / scale) : std::numeric_limits<float>::quiet_NaN();
}

template <class Message>
PlanItem common_part(const Message& message) noexcept {
    PlanItem item;
    item.command = message.command;
    item.frame = message.frame;
    item.autocontinue = message.autocontinue;
    item.params = {message.param1, message.param2, message.param3, message.param4};
    item.z = message.z;
    return item;
}

template <class Message>
Message message_of(const PlanItem& item) noexcept {
    Message message;
    message.command = item.command;
    message.autocontinue = item.autocontinue;
    message.param1 = item.params[0];
    message.param2 = item.params[1];
    message.param3 = item.params[2];
    message.param4 = item.params[3];
    message.z = item.z;
    return message;
}

bool is_known(const PlanItem& item, PlanType type, bool is_px4) noexcept {
    if (type == PlanType::fence)
        return item.command >= MAV_CMD_NAV_FENCE_RETURN_POINT && item.command <= MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION;
    if (type == PlanType::rally) return item.command == MAV_CMD_NAV_RALLY_POINT;
    return contains(common_commands, item.command) ||
           (is_px4 ? contains(px4_commands, item.command) : contains(ardupilot_commands, item.command));
}

std::uint8_t check_place(const PlanItem& item, PlanType type) noexcept {
    constexpr std::int32_t north = 90'0000000, east = 180'0000000;
    const bool required = type != PlanType::mission;
    const auto fits = [&](std::int32_t value, std::int32_t most) {
        return is_set(value) ? value >= -most && value <= most : !required;
    };
    if (!fits(item.x, north)) return MAV_MISSION_INVALID_PARAM5_X;
    if (!fits(item.y, east)) return MAV_MISSION_INVALID_PARAM6_Y;
    return MAV_MISSION_ACCEPTED;
}

std::uint8_t check_numbers(const PlanItem& item) noexcept {
    for (std::size_t i = 0; i < item.params.size(); ++i)
        if (std::isinf(item.params[i])) return static_cast<std::uint8_t>(MAV_MISSION_INVALID_PARAM1 + i);
    const bool needs_height = has_position_frame(item.frame) && contains(place_commands, item.command);
    return std::isinf(item.z) || (needs_height && std::isnan(item.z)) ? MAV_MISSION_INVALID_PARAM7
                                                                      : MAV_MISSION_ACCEPTED;
}

// Rules of single commands. A comparison with NaN is false.
std::uint8_t check_params(const PlanItem& item, std::uint16_t count) noexcept {
    const float first = item.params[0];
    const auto demand = [](bool holds, std::uint8_t otherwise) { return holds ? std::uint8_t{0} : otherwise; };
    switch (item.command) {
        case MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION:
        case MAV_CMD_NAV_FENCE_POLYGON_VERTEX_EXCLUSION: return demand(first >= 3, MAV_MISSION_ERROR);
        case MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION:
        case MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION: return demand(first > 0, MAV_MISSION_INVALID_PARAM1);
        case MAV_CMD_DO_CHANGE_SPEED: return demand(first >= 0 && first <= 3, MAV_MISSION_INVALID_PARAM1);
        case MAV_CMD_CONDITION_DELAY: return demand(!(first < 0), MAV_MISSION_INVALID_PARAM1);
        case MAV_CMD_DO_JUMP:
            if (!(first >= 0 && first < count)) return MAV_MISSION_INVALID_PARAM1;
            return demand(!std::isnan(item.params[1]), MAV_MISSION_INVALID_PARAM2);
        default: return MAV_MISSION_ACCEPTED;
    }
}

}  // namespace

std::optional<PlanType> plan_type(std::uint8_t mission_type) noexcept {
    return mission_type < plan_types ? std::optional(static_cast<PlanType>(mission_type)) : std::nullopt;
}

PlanItem item_of(const msg::MissionItemInt& message) noexcept {
    PlanItem item = common_part(message);
    item.x = message.x;
    item.y = message.y;
    return item;
}

PlanItem item_of(const msg::MissionItem& message) noexcept {
    PlanItem item = common_part(message);
    item.x = to_integer(message.x, scale_of(message.frame));
    item.y = to_integer(message.y, scale_of(message.frame));
    return item;
}

msg::MissionItemInt int_form(const PlanItem& item, bool is_px4) noexcept {
    auto message = message_of<msg::MissionItemInt>(item);
    message.frame = variant_of(item.frame, is_px4);
    message.x = item.x;
    message.y = item.y;
    return message;
}

msg::MissionItem float_form(const PlanItem& item) noexcept {
    auto message = message_of<msg::MissionItem>(item);
    message.frame = variant_of(item.frame, false);
    message.x = to_float(item.x, scale_of(item.frame));
    message.y = to_float(item.y, scale_of(item.frame));
    return message;
}

std::uint8_t check_item(const PlanItem& item, PlanType type, std::uint16_t count, bool is_px4) noexcept {
    if (!is_known(item, type, is_px4)) return MAV_MISSION_UNSUPPORTED;
    const bool needs_place = type != PlanType::mission || contains(place_commands, item.command);
    if (!has_position_frame(item.frame) && (needs_place || item.frame != MAV_FRAME_MISSION))
        return MAV_MISSION_UNSUPPORTED_FRAME;
    if (const auto result = check_numbers(item); result != MAV_MISSION_ACCEPTED) return result;
    if (has_position_frame(item.frame))
        if (const auto result = check_place(item, type); result != MAV_MISSION_ACCEPTED) return result;
    return check_params(item, count);
}

}  // namespace mavloom::sim
