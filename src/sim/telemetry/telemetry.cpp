// SPDX-License-Identifier: MIT
#include "sim/telemetry/telemetry.hpp"

#include <algorithm>
#include <array>

#include "mavloom/msg/heartbeat.hpp"
#include "sim/radio/radio.hpp"

namespace mavloom::sim {

namespace {

template <class Message>
bool put(const Message& message, ByteSpan payload) noexcept {
    (void)message.encode(payload);
    return true;
}

bool heartbeat(const View& view, ByteSpan payload) {
    const Flight& flight = view.flight;
    const std::uint8_t armed = flight.armed() ? base_armed : 0;
    return put(msg::Heartbeat{.type = view.firmware.mav_type(),
                              .autopilot = view.firmware.mav_autopilot(),
                              .base_mode = static_cast<std::uint8_t>(flight.mode().base_mode | armed),
                              .custom_mode = flight.mode().custom_mode,
                              .system_status = static_cast<std::uint8_t>(flight.system_status()),
                              .mavlink_version = 3},
               payload);
}

constexpr std::array table{
    Projection{info_of<msg::Heartbeat>, msg::Heartbeat::name, heartbeat},
};

}  // namespace

std::span<const Projection> projections() noexcept { return table; }

const Projection* find_projection(MessageId id) noexcept {
    const auto at = std::ranges::lower_bound(table, id, {}, [](const Projection& p) { return p.info.id; });
    return at == table.end() || at->info.id != id ? nullptr : &*at;
}

}  // namespace mavloom::sim
