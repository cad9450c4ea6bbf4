// SPDX-License-Identifier: MIT
// The messages that describe the vehicle's state. Each is a projection: a pure function from the state to a payload, so
// that all messages of one instant agree. Private to module sim.
//
// Sources: MAVLink common.xml for units and scales; recordings of PX4 1.17 for what the definitions leave open.
#pragma once

#include <span>
#include <string_view>

#include "flight/firmware/firmware.hpp"
#include "flight/firmware/known_by.hpp"
#include "flight/flight.hpp"
#include "mavloom/base/bytes.hpp"
#include "mavloom/base/clock.hpp"
#include "mavloom/sim/flight.hpp"
#include "mavloom/wire/message_table.hpp"

namespace mavloom::sim {

// The traffic of a link, for LINK_NODE_STATUS.
struct LinkTraffic {
    std::uint32_t sent = 0, received = 0;      // frames
    std::uint32_t sent_s = 0, received_s = 0;  // bytes per second
};

// Everything that a projection may read.
struct View {
    const VehicleOptions& options;
    const Firmware& firmware;
    const Parameters& parameters;
    const Flight& flight;
    const class Gimbal* gimbal = nullptr;        // null: none is simulated
    const class ServoOutputs* servos = nullptr;  // what clients set; null: nothing
    FlightTime since_boot{};
    WallTime utc{};  // the epoch: unknown
    bool has_utc = false;
    bool is_calibrating = false;
    LinkTraffic traffic{};     // of the link that the message goes to
    std::uint32_t number = 0;  // messages that this stream sent before
};

// Milliseconds and microseconds since boot, as most messages have them.
[[nodiscard]] inline std::uint32_t boot_ms(const View& view) noexcept {
    return static_cast<std::uint32_t>(view.since_boot / std::chrono::milliseconds{1});
}
[[nodiscard]] inline std::uint64_t boot_us(const View& view) noexcept {
    return static_cast<std::uint64_t>(view.since_boot / std::chrono::microseconds{1});
}

struct Projection {
    wire::MessageInfo info;
    std::string_view name;
    // Writes the payload of `info.max_length` bytes. False: there is nothing to report now. Null: a service sends the
    // message by itself when something happens, or the vehicle has no data for it; clients may set its interval.
    bool (*write)(const View& view, ByteSpan payload);
    KnownBy known_by = KnownBy::both;
};

// All projections by ascending id.
[[nodiscard]] std::span<const Projection> projections() noexcept;
// Null if the firmware does not know the message.
[[nodiscard]] const Projection* find_projection(MessageId id, bool is_px4) noexcept;

}  // namespace mavloom::sim
