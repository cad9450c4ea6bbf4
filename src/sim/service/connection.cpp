// SPDX-License-Identifier: MIT
#include "sim/service/connection.hpp"

#include <algorithm>
#include <array>

#include "mavloom/msg/enums/mav_type.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/ping.hpp"
#include "mavloom/msg/radio_status.hpp"
#include "mavloom/msg/timesync.hpp"

namespace mavloom::sim {

namespace {

constexpr std::array connection_ids{msg::Heartbeat::id, msg::Timesync::id, msg::Ping::id, msg::RadioStatus::id};
constexpr Source radio_source{SystemId{51}, ComponentId{68}};

}  // namespace

std::span<const MessageId> Connection::handled() const noexcept { return connection_ids; }

void Connection::receive(const Client& from, MessageId id, ByteView payload, Moment now) {
    if (id == msg::Heartbeat::id) return on_heartbeat(from, payload, now);
    if (id == msg::Timesync::id) return on_timesync(from, payload, now);
    if (id == msg::Ping::id) return on_ping(from, payload);
    on_radio_status(from, payload, now);
}

void Connection::on_heartbeat(const Client& from, ByteView payload, Moment now) {
    if (msg::Heartbeat::decode(payload).type != msg::MAV_TYPE_GCS) return;
    flight_.on_ground_station_heard();
    announcer_.greet(from.link, now.flight);
}

// A request has tc1 = 0. It is answered at once with the vehicle's time since boot, as PX4 does.
void Connection::on_timesync(const Client& from, ByteView payload, Moment now) {
    const auto request = msg::Timesync::decode(payload);
    if (request.tc1 != 0) return;
    radio_.send(from.link, msg::Timesync{.tc1 = (now.flight - booted_).count(),
                                         .ts1 = request.ts1,
                                         .target_system = from.id.system.value,
                                         .target_component = from.id.component.value});
}

// A request has no target.
void Connection::on_ping(const Client& from, ByteView payload) {
    auto ping = msg::Ping::decode(payload);
    if (ping.target_system != 0 || ping.target_component != 0) return;
    ping.target_system = from.id.system.value;
    ping.target_component = from.id.component.value;
    radio_.send(from.link, ping);
}

// A telemetry radio reports how full its buffer is (txbuf, percent free). PX4's rule: slow down below 35 %, quickly
// below 25 %, speed up again above 50 %. Radios have the source 51/68, as the firmware of SiK sets it.
void Connection::on_radio_status(const Client& from, ByteView payload, Moment now) {
    if (from.id != radio_source) return;
    const auto free = msg::RadioStatus::decode(payload).txbuf;
    const double factor = free < 25 ? 0.8 : free < 35 ? 0.975 : free > 50 ? 1.025 : 1.0;
    streams_.scale_share(from.link, factor, now.flight);
}

}  // namespace mavloom::sim
