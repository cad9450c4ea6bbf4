// SPDX-License-Identifier: MIT
#include "observe/parts.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "mavloom/msg/command_int.hpp"
#include "mavloom/msg/command_long.hpp"

namespace mavloom::observe {

namespace {

constexpr ComponentId autopilot{1};  // MAV_COMP_ID_AUTOPILOT1

struct Context {
    Parts& parts;
    const LatestRow& row;
    Vehicle* sender;
    const Moment& at;
};

// Updates what is shown of the sender.
template <class Message>
void show(const Context& in, const Message& message) {
    if (in.sender != nullptr) VehicleTable::take(*in.sender, message);
}
void add_trip(const Context& in, RoundTrip Vehicle::*trip, std::optional<Nanoseconds> taken) {
    if (in.sender != nullptr && taken) (in.sender->*trip).add(*taken);
}

void take(const Context& in, const msg::Heartbeat& message) {
    if (auto* const sender = in.parts.vehicles.find_or_add(in.at.source, in.at.now)) {
        VehicleTable::take(*sender, message, in.row.payload());
        sender->last_heartbeat = in.at.time;
    }
    judge(in.parts.alarms, in.at, message);
}
void take(const Context& in, const msg::SysStatus& message) {
    show(in, message);
    in.parts.health.judge(in.parts.alarms, in.at, message, in.parts.dialect);
    const bool has_battery_status = in.sender != nullptr && in.sender->battery_id;
    if (!has_battery_status) judge_battery(in.parts.alarms, in.at, message);
}
void take(const Context& in, const msg::BatteryStatus& message) {
    show(in, message);
    judge(in.parts.alarms, in.at, message);
}
void take(const Context& in, const msg::GpsRawInt& message) { show(in, message); }
void take(const Context& in, const msg::GlobalPositionInt& message) { show(in, message); }
void take(const Context& in, const msg::SystemTime& message) { in.parts.clocks.judge(in.parts.alarms, in.at, message); }
void take(const Context& in, const msg::Statustext& message) { in.parts.texts.judge(in.parts.alarms, in.at, message); }
void take(const Context& in, const msg::EkfStatusReport& message) { judge(in.parts.alarms, in.at, message); }
void take(const Context& in, const msg::EstimatorStatus& message) { judge(in.parts.alarms, in.at, message); }
void take(const Context& in, const msg::Timesync& message) {
    add_trip(in, &Vehicle::timesync, in.parts.round_trips.take(in.at.source, message, in.at.time));
}
void take(const Context& in, const msg::Ping& message) {
    add_trip(in, &Vehicle::ping, in.parts.round_trips.take(in.at.source, message, in.at.time));
}
void take(const Context& in, const msg::CommandAck& message) {
    add_trip(in, &Vehicle::command, in.parts.round_trips.take(in.at.source, message, in.at.time));
}
void take(const Context& in, const msg::CommandLong& message) {
    in.parts.round_trips.command(in.at.source, SystemId{message.target_system}, message.command, in.at.time);
}
void take(const Context& in, const msg::CommandInt& message) {
    in.parts.round_trips.command(in.at.source, SystemId{message.target_system}, message.command, in.at.time);
}

struct Handler {
    MessageId id;
    std::uint8_t crc_extra;
    void (*take)(const Context&);
};

template <class Message>
constexpr Handler handler_for() {
    return {Message::id, Message::crc_extra, [](const Context& in) { take(in, Message::decode(in.row.payload())); }};
}

constexpr std::array handlers{
    handler_for<msg::Heartbeat>(),
    handler_for<msg::SysStatus>(),
    handler_for<msg::BatteryStatus>(),
    handler_for<msg::GpsRawInt>(),
    handler_for<msg::GlobalPositionInt>(),
    handler_for<msg::SystemTime>(),
    handler_for<msg::Statustext>(),
    handler_for<msg::EkfStatusReport>(),
    handler_for<msg::EstimatorStatus>(),
    handler_for<msg::Timesync>(),
    handler_for<msg::Ping>(),
    handler_for<msg::CommandAck>(),
    handler_for<msg::CommandLong>(),
    handler_for<msg::CommandInt>(),
};
// Of other messages, only the clock is read. As in wire::SequenceTracker, only an autopilot's clocks all are one.
constexpr std::uint8_t clock_only = handlers.size() + 1;

bool has_clock(const LatestRow& row) noexcept {
    return row.traffic.source.component == autopilot &&
           row.message->wire.boot_time_offset != wire::MessageInfo::no_boot_time;
}

// Bytes that the sender cut off are 0.
void take_clock(const Context& in) {
    std::array<std::uint8_t, sizeof(std::uint32_t)> bytes{};
    const auto payload = in.row.payload();
    const std::size_t offset = in.row.message->wire.boot_time_offset;
    if (offset < payload.size())
        std::memcpy(bytes.data(), payload.data() + offset, std::min(bytes.size(), payload.size() - offset));
    in.parts.clocks.boot_time(in.parts.alarms, in.at, load_le<std::uint32_t>(bytes.data()));
}

}  // namespace

std::uint8_t handler_of(const LatestRow& row) noexcept {
    if (row.message == nullptr) return 0;
    const auto& info = row.message->wire;
    const auto at = std::ranges::find_if(
        handlers, [&](const Handler& one) { return one.id == info.id && one.crc_extra == info.crc_extra; });
    if (at != handlers.end()) return static_cast<std::uint8_t>(at - handlers.begin() + 1);
    return has_clock(row) ? clock_only : 0;
}

void handle(Parts& parts, const LatestRow& row, Vehicle* sender, const Moment& at) {
    const Context context{parts, row, sender, at};
    if (row.tag <= handlers.size()) handlers[row.tag - 1u].take(context);
    else take_clock(context);
}

}  // namespace mavloom::observe
