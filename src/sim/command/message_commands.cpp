// SPDX-License-Identifier: MIT
// Commands about messages: intervals and requests, with the forms that older clients send. Source: MAVLink guide,
// "Requesting and Rate-Controlling Messages".
#include <algorithm>
#include <cmath>

#include "mavloom/msg/autopilot_version.hpp"
#include "mavloom/msg/enums/mav_cmd.hpp"
#include "mavloom/msg/flight_information.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/home_position.hpp"
#include "mavloom/msg/message_interval.hpp"
#include "mavloom/msg/protocol_version.hpp"
#include "sim/command/commands.hpp"
#include "sim/command/requests.hpp"
#include "sim/parts.hpp"

namespace mavloom::sim {

namespace {

using namespace msg;

constexpr MessageId no_message{0xffffffff};

MessageId asked_message(const Command& command) noexcept {
    constexpr float ids = 1 << 24;
    const float id = command.param(1);
    return id >= 0 && id < ids ? MessageId{static_cast<std::uint32_t>(id)} : no_message;
}

// Microseconds on the wire: negative is off, 0 the default. Empty here: the default.
std::optional<Nanoseconds> asked_interval(float microseconds) noexcept {
    constexpr float shortest = 1, longest = 2e9f;  // the longest that MESSAGE_INTERVAL can report
    if (microseconds == 0) return std::nullopt;
    if (microseconds < 0) return Nanoseconds{0};
    return Nanoseconds{std::llround(double{std::clamp(microseconds, shortest, longest)} * 1e3)};
}

// PX4 answers FAILED for a message that it does not stream, ArduPilot DENIED.
Outcome set_message_interval(Parts& parts, const Command& command, Moment now) {
    if (std::isnan(command.param(2))) return Result::denied;
    const auto interval = asked_interval(command.param(2));
    if (parts.streams.set_interval(command.from.link, asked_message(command), interval, now.flight))
        return Result::accepted;
    return parts.firmware.is_px4() ? Result::failed : Result::denied;
}

// -1: the message is off; 0: the vehicle does not stream it.
std::int32_t microseconds_of(const std::optional<Nanoseconds>& interval) noexcept {
    if (!interval) return 0;
    return interval->count() == 0 ? -1 : static_cast<std::int32_t>(*interval / std::chrono::microseconds{1});
}

Outcome get_message_interval(Parts& parts, const Command& command, Moment /*now*/) {
    const MessageId message = asked_message(command);
    if (message.value > 0xffff) return Result::denied;
    const auto interval = parts.streams.interval(command.from.link, message);
    parts.radio.send(command.from.link, MessageInterval{.message_id = static_cast<std::uint16_t>(message.value),
                                                        .interval_us = microseconds_of(interval)});
    return Result::accepted;
}

// The message goes out before the acknowledgement; clients that get it afterwards start a timer of a second.
Outcome request_message(Parts& parts, const Command& command, Moment /*now*/) {
    const double index = std::isnan(command.param(2)) ? 0 : double{command.param(2)};
    return send_requested(parts, command.from.link, asked_message(command), index);
}

template <class Message>
Outcome request(Parts& parts, const Command& command, Moment /*now*/) {
    return send_requested(parts, command.from.link, Message::id, 0);
}

constexpr std::array message_rows{
    CommandRow{MAV_CMD_GET_HOME_POSITION, request<HomePosition>},
    CommandRow{MAV_CMD_GET_MESSAGE_INTERVAL, get_message_interval},
    CommandRow{MAV_CMD_SET_MESSAGE_INTERVAL, set_message_interval},
    CommandRow{MAV_CMD_REQUEST_MESSAGE, request_message},
    CommandRow{MAV_CMD_REQUEST_PROTOCOL_VERSION, request<ProtocolVersion>},
    CommandRow{MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES, request<AutopilotVersion>},
    CommandRow{MAV_CMD_REQUEST_FLIGHT_INFORMATION, request<FlightInformation>},
};

}  // namespace

std::span<const CommandRow> message_commands() noexcept { return message_rows; }

}  // namespace mavloom::sim
