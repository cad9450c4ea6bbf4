// SPDX-License-Identifier: MIT
#include "sim/command/requests.hpp"

#include <algorithm>
#include <cmath>

#include "mavloom/msg/autopilot_version.hpp"
#include "mavloom/msg/available_modes.hpp"
#include "mavloom/msg/component_information.hpp"
#include "mavloom/msg/component_metadata.hpp"
#include "mavloom/msg/enums/tune_format.hpp"
#include "mavloom/msg/gimbal_device_information.hpp"
#include "mavloom/msg/gimbal_manager_information.hpp"
#include "mavloom/msg/mission_current.hpp"
#include "mavloom/msg/protocol_version.hpp"
#include "mavloom/msg/supported_tunes.hpp"
#include "sim/metadata/metadata.hpp"
#include "sim/parts.hpp"
#include "sim/payload/gimbal.hpp"

namespace mavloom::sim {

namespace {

using namespace msg;

// The text without its terminator if it fills the field.
template <std::size_t Size>
void copy_text(std::string_view text, std::array<char, Size>& field) noexcept {
    std::ranges::copy(text.substr(0, Size), field.begin());
}

Result send_autopilot_version(Parts& parts, LinkId link, double /*index*/) {
    const VersionInfo& version = parts.firmware.version();
    AutopilotVersion message{.capabilities = parts.firmware.capabilities(parts.options),
                             .flight_sw_version = version.flight,
                             .middleware_sw_version = version.middleware,
                             .os_sw_version = version.os,
                             .board_version = version.board,
                             .flight_custom_version = version.custom,
                             .middleware_custom_version = version.custom,
                             .vendor_id = version.vendor,
                             .product_id = version.product,
                             .uid = unique_id(parts.options)};
    store_le(message.uid2.data(), message.uid);
    parts.radio.send(link, message);
    return Result::accepted;
}

Result send_protocol_version(Parts& parts, LinkId link, double /*index*/) {
    parts.radio.send(link, ProtocolVersion{.version = 200, .min_version = 100, .max_version = 203});
    return Result::accepted;
}

// PX4 names only the modes that are no standard modes.
void send_mode(Parts& parts, LinkId link, const ModeInfo& mode, std::uint8_t number, std::uint8_t of) {
    AvailableModes message{.number_modes = of,
                           .mode_index = number,
                           .standard_mode = mode.standard_mode,
                           .custom_mode = mode.custom_mode,
                           .properties = mode.properties};
    if (!parts.firmware.is_px4() || mode.standard_mode == 0) copy_text(mode.name, message.mode_name);
    parts.radio.send(link, message);
}

// One mode by its number from 1 on, or all of them.
Result send_available_modes(Parts& parts, LinkId link, double index) {
    const auto modes = parts.firmware.modes();
    const auto count = static_cast<std::uint8_t>(std::ranges::count_if(modes, &ModeInfo::is_listed));
    if (!(index >= 0 && index <= count) || index != std::floor(index)) return Result::denied;
    std::uint8_t number = 0;
    for (const ModeInfo& mode : modes) {
        if (!mode.is_listed) continue;
        ++number;
        if (index == 0 || index == number) send_mode(parts, link, mode, number, count);
    }
    return Result::accepted;
}

std::uint32_t boot_ms(const Parts& parts) {
    return static_cast<std::uint32_t>(parts.view().since_boot / std::chrono::milliseconds{1});
}

Result send_component_metadata(Parts& parts, LinkId link, double /*index*/) {
    const auto metadata = general_metadata(parts.firmware);
    if (!metadata) return Result::unsupported;
    ComponentMetadata message{.time_boot_ms = boot_ms(parts), .file_crc = metadata->file_crc};
    copy_text(metadata->uri, message.uri);
    parts.radio.send(link, message);
    return Result::accepted;
}

// The older form of COMPONENT_METADATA.
Result send_component_information(Parts& parts, LinkId link, double /*index*/) {
    const auto metadata = general_metadata(parts.firmware);
    if (!metadata) return Result::unsupported;
    ComponentInformation message{.time_boot_ms = boot_ms(parts), .general_metadata_file_crc = metadata->file_crc};
    copy_text(metadata->uri, message.general_metadata_uri);
    parts.radio.send(link, message);
    return Result::accepted;
}

Result send_supported_tunes(Parts& parts, LinkId link, double /*index*/) {
    parts.radio.send(link, SupportedTunes{.format = TUNE_FORMAT_QBASIC1_1});
    return Result::accepted;
}

struct Request {
    MessageId message;
    Result (*send)(Parts& parts, LinkId link, double index);
};

constexpr std::array requests{
    Request{AutopilotVersion::id, send_autopilot_version},
    Request{ProtocolVersion::id, send_protocol_version},
    Request{ComponentInformation::id, send_component_information},
    Request{ComponentMetadata::id, send_component_metadata},
    Request{AvailableModes::id, send_available_modes},
    Request{SupportedTunes::id, send_supported_tunes},
};

}  // namespace

Result send_requested(Parts& parts, LinkId link, MessageId message, double index) {
    const auto request = std::ranges::find(requests, message, &Request::message);
    if (request != requests.end()) return request->send(parts, link, index);
    const bool is_of_gimbal = message == GimbalManagerInformation::id || message == GimbalDeviceInformation::id;
    if (is_of_gimbal && !parts.gimbal) return Result::unsupported;
    // PX4 sends MISSION_CURRENT by itself, outside of its streams, and denies a request.
    if (message == MissionCurrent::id && parts.firmware.is_px4()) return Result::denied;
    return parts.streams.send_once(parts.view(), link, message) ? Result::accepted : Result::denied;
}

std::uint64_t unique_id(const VehicleOptions& options) noexcept {
    std::uint64_t z = options.seed * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (z ^ (z >> 31)) + options.system.value;
}

}  // namespace mavloom::sim
