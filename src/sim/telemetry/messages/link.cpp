// SPDX-License-Identifier: MIT
#include "mavloom/msg/link_node_status.hpp"
#include "mavloom/msg/ping.hpp"
#include "mavloom/msg/system_time.hpp"
#include "mavloom/msg/timesync.hpp"
#include "sim/telemetry/projections.hpp"

namespace mavloom::sim {

// PX4 omits the message while it does not know the date.
bool write_system_time(const View& view, ByteSpan payload) {
    if (!view.has_utc) return false;
    const auto utc = view.utc.time_since_epoch() / std::chrono::microseconds{1};
    return put(msg::SystemTime{.time_unix_usec = static_cast<std::uint64_t>(utc), .time_boot_ms = boot_ms(view)},
               payload);
}

// A request: the target is nobody.
bool write_ping(const View& view, ByteSpan payload) {
    return put(msg::Ping{.time_usec = boot_us(view), .seq = view.number}, payload);
}

// A request: tc1 is 0.
bool write_timesync(const View& view, ByteSpan payload) {
    return put(msg::Timesync{.ts1 = view.since_boot.count()}, payload);
}

bool write_link_node_status(const View& view, ByteSpan payload) {
    return put(msg::LinkNodeStatus{.timestamp = boot_us(view),
                                   .tx_rate = view.traffic.sent_s,
                                   .rx_rate = view.traffic.received_s,
                                   .messages_sent = view.traffic.sent,
                                   .messages_received = view.traffic.received},
               payload);
}

}  // namespace mavloom::sim
