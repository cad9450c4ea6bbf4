// SPDX-License-Identifier: MIT
#include "mavloom/dialect/message_class.hpp"

#include <algorithm>
#include <iterator>

namespace mavloom::dialect {

namespace {

enum class Use : std::uint8_t { presence, control, parameters, missions, commands, text };

struct Essential {
    std::uint32_t id;
    Use use;
};

// By ascending id.
constexpr Essential essentials[] = {
    {0, Use::presence},       // HEARTBEAT
    {5, Use::control},        // CHANGE_OPERATOR_CONTROL
    {6, Use::control},        // CHANGE_OPERATOR_CONTROL_ACK
    {7, Use::control},        // AUTH_KEY
    {11, Use::control},       // SET_MODE
    {20, Use::parameters},    // PARAM_REQUEST_READ
    {21, Use::parameters},    // PARAM_REQUEST_LIST
    {22, Use::parameters},    // PARAM_VALUE
    {23, Use::parameters},    // PARAM_SET
    {37, Use::missions},      // MISSION_REQUEST_PARTIAL_LIST
    {38, Use::missions},      // MISSION_WRITE_PARTIAL_LIST
    {39, Use::missions},      // MISSION_ITEM
    {40, Use::missions},      // MISSION_REQUEST
    {41, Use::missions},      // MISSION_SET_CURRENT
    {43, Use::missions},      // MISSION_REQUEST_LIST
    {44, Use::missions},      // MISSION_COUNT
    {45, Use::missions},      // MISSION_CLEAR_ALL
    {46, Use::missions},      // MISSION_ITEM_REACHED
    {47, Use::missions},      // MISSION_ACK
    {50, Use::parameters},    // PARAM_MAP_RC
    {51, Use::missions},      // MISSION_REQUEST_INT
    {53, Use::missions},      // MISSION_CHECKSUM
    {73, Use::missions},      // MISSION_ITEM_INT
    {75, Use::commands},      // COMMAND_INT
    {76, Use::commands},      // COMMAND_LONG
    {77, Use::commands},      // COMMAND_ACK
    {80, Use::commands},      // COMMAND_CANCEL
    {253, Use::text},         // STATUSTEXT
    {320, Use::parameters},   // PARAM_EXT_REQUEST_READ
    {321, Use::parameters},   // PARAM_EXT_REQUEST_LIST
    {322, Use::parameters},   // PARAM_EXT_VALUE
    {323, Use::parameters},   // PARAM_EXT_SET
    {324, Use::parameters},   // PARAM_EXT_ACK
    {60041, Use::parameters}  // PARAM_VALUE_ARRAY
};

struct Meaning {
    std::uint32_t id;
    FrameMeaning meaning;
};

using enum FrameMeaning;

// By ascending id. Messages that are not listed are `latest`.
constexpr Meaning meanings[] = {
    {34, one_of_kind},     // RC_CHANNELS_SCALED
    {35, one_of_kind},     // RC_CHANNELS_RAW
    {67, one_of_kind},     // DATA_STREAM
    {100, one_of_kind},    // OPTICAL_FLOW
    {107, one_of_kind},    // HIL_SENSOR
    {112, event},          // CAMERA_TRIGGER
    {113, one_of_kind},    // HIL_GPS
    {114, one_of_kind},    // HIL_OPTICAL_FLOW
    {118, piece},          // LOG_ENTRY
    {120, piece},          // LOG_DATA
    {123, piece},          // GPS_INJECT_DATA
    {126, piece},          // SERIAL_CONTROL
    {127, one_of_kind},    // GPS_RTK
    {128, one_of_kind},    // GPS2_RTK
    {130, piece},          // DATA_TRANSMISSION_HANDSHAKE
    {131, piece},          // ENCAPSULATED_DATA
    {133, piece},          // TERRAIN_REQUEST
    {134, piece},          // TERRAIN_DATA
    {142, answer},         // RESOURCE_REQUEST
    {148, answer},         // AUTOPILOT_VERSION
    {149, one_of_many},    // LANDING_TARGET
    {169, piece},          // DATA16
    {170, piece},          // DATA32
    {171, piece},          // DATA64
    {172, piece},          // DATA96
    {180, event},          // CAMERA_FEEDBACK
    {184, piece},          // REMOTE_LOG_DATA_BLOCK
    {217, answer},         // GOPRO_GET_RESPONSE
    {219, answer},         // GOPRO_SET_RESPONSE
    {225, one_of_kind},    // EFI_STATUS
    {233, piece},          // GPS_RTCM_DATA
    {244, answer},         // MESSAGE_INTERVAL
    {246, one_of_many},    // ADSB_VEHICLE
    {247, one_of_many},    // COLLISION
    {248, piece},          // V2_EXTENSION
    {249, piece},          // MEMORY_VECT
    {259, one_of_kind},    // CAMERA_INFORMATION
    {260, one_of_kind},    // CAMERA_SETTINGS
    {262, one_of_kind},    // CAMERA_CAPTURE_STATUS
    {263, event},          // CAMERA_IMAGE_CAPTURED
    {266, piece},          // LOGGING_DATA
    {267, piece},          // LOGGING_DATA_ACKED
    {271, one_of_kind},    // CAMERA_FOV_STATUS
    {275, one_of_kind},    // CAMERA_TRACKING_IMAGE_STATUS
    {276, one_of_kind},    // CAMERA_TRACKING_GEO_STATUS
    {283, one_of_kind},    // GIMBAL_DEVICE_INFORMATION
    {301, one_of_many},    // AIS_VESSEL
    {311, one_of_many},    // UAVCAN_NODE_INFO
    {330, one_of_many},    // OBSTACLE_DISTANCE
    {331, one_of_many},    // ODOMETRY
    {339, one_of_kind},    // RAW_RPM
    {340, one_of_many},    // UTM_GLOBAL_POSITION
    {350, piece},          // DEBUG_FLOAT_ARRAY
    {385, piece},          // TUNNEL
    {386, piece},          // CAN_FRAME
    {387, piece},          // CANFD_FRAME
    {388, piece},          // CAN_FILTER_MODIFY
    {396, answer},         // COMPONENT_INFORMATION_BASIC
    {410, event},          // EVENT
    {411, event},          // CURRENT_EVENT_SEQUENCE
    {413, event},          // RESPONSE_EVENT_ERROR
    {414, event},          // GROUP_START
    {415, event},          // GROUP_END
    {435, answer},         // AVAILABLE_MODES
    {510, one_of_many},    // TARGET_ABSOLUTE
    {515, one_of_many},    // MANUAL_INPUT_STATUS
    {11001, answer},       // DEVICE_OP_READ_REPLY
    {11003, answer},       // DEVICE_OP_WRITE_REPLY
    {11005, answer},       // SECURE_COMMAND_REPLY
    {11034, answer},       // OSD_PARAM_CONFIG_REPLY
    {11036, answer},       // OSD_PARAM_SHOW_CONFIG_REPLY
    {11037, one_of_many},  // OBSTACLE_DISTANCE_3D
    {12900, one_of_many},  // OPEN_DRONE_ID_BASIC_ID
    {12901, one_of_many},  // OPEN_DRONE_ID_LOCATION
    {12902, one_of_many},  // OPEN_DRONE_ID_AUTHENTICATION
    {12903, one_of_many},  // OPEN_DRONE_ID_SELF_ID
    {12904, one_of_many},  // OPEN_DRONE_ID_SYSTEM
    {12905, one_of_many},  // OPEN_DRONE_ID_OPERATOR_ID
    {12915, one_of_many},  // OPEN_DRONE_ID_MESSAGE_PACK
    {12918, one_of_many},  // OPEN_DRONE_ID_ARM_STATUS
    {12919, one_of_many},  // OPEN_DRONE_ID_SYSTEM_UPDATE
    {50002, one_of_kind},  // HERELINK_VIDEO_STREAM_INFORMATION
    {52601, one_of_kind},  // LED_STRIP_STATE
    {60040, piece}         // FRSKY_PASSTHROUGH_ARRAY
};

template <class Entry, std::size_t n>
constexpr bool rises(const Entry (&table)[n]) {
    return std::is_sorted(table, table + n, [](const Entry& a, const Entry& b) { return a.id < b.id; });
}
static_assert(rises(essentials) && rises(meanings));

template <class Entry, std::size_t n>
const Entry* find(const Entry (&table)[n], MessageId id) noexcept {
    const Entry* const at = std::lower_bound(table, table + n, id.value,
                                             [](const Entry& e, std::uint32_t v) { return e.id < v; });
    return at != table + n && at->id == id.value ? at : nullptr;
}

std::string_view harm_of(Use use) noexcept {
    switch (use) {
        case Use::presence: return "the far side may assume that the sender is gone";
        case Use::control: return "a change of mode or of operator may get lost";
        case Use::parameters: return "reading and writing of parameters may fail";
        case Use::missions: return "upload and download of missions may fail";
        case Use::commands: return "commands and their answers may get lost";
        case Use::text: return "a message to the pilot may get lost";
    }
    return {};
}

}  // namespace

bool is_essential(MessageId id) noexcept { return find(essentials, id) != nullptr; }

MessageClass class_of(MessageId id, const wire::MessageInfo* info) noexcept {
    if (is_essential(id)) return MessageClass::essential;
    const bool has_target = info != nullptr && info->target_system_offset != wire::MessageInfo::no_target;
    return has_target ? MessageClass::targeted : MessageClass::telemetry;
}

FrameMeaning meaning_of(MessageId id) noexcept {
    const Meaning* const found = find(meanings, id);
    return found == nullptr ? latest : found->meaning;
}

bool can_be_thinned(MessageId id, const wire::MessageInfo* info) noexcept {
    const FrameMeaning meaning = meaning_of(id);
    const bool each_counts = meaning == piece || meaning == event || meaning == answer;
    return class_of(id, info) == MessageClass::telemetry && !each_counts;
}

std::string_view harm_of_thinning(MessageId id, const wire::MessageInfo* info) noexcept {
    if (const Essential* const found = find(essentials, id)) return harm_of(found->use);
    switch (meaning_of(id)) {
        case piece: return "a transfer fails if one piece is missing";
        case event: return "an event may get lost";
        case answer: return "an answer that a program waits for may get lost";
        default: break;
    }
    return can_be_thinned(id, info) ? std::string_view{} : "frames addressed to one system may get lost";
}

}  // namespace mavloom::dialect
