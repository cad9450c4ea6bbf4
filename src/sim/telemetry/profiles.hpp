// SPDX-License-Identifier: MIT
// Which messages a link gets by default, and how often. Private to module sim; tables without state.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "mavloom/base/ids.hpp"
#include "mavloom/sim/flight.hpp"

namespace mavloom::sim {

// The condition of a row. A client that requests the message gets it without this condition.
enum class When : std::uint8_t {
    always,
    armed,   // while the vehicle is armed
    wind,    // a wind is simulated, or the vehicle measures it
    remote,  // a remote control is simulated
    gimbal,  // a gimbal is simulated
    once,    // until it was sent once
};

// One row of a profile. Rows for messages that the firmware does not know have no effect.
struct StreamRate {
    MessageId message;
    double hz = 0;
    When when = When::always;
};

// The rows of a profile, in no particular order.
[[nodiscard]] std::span<const StreamRate> rates_of(Profile profile) noexcept;

// Whether the condition can hold for this vehicle. `armed` and `once` change during its life and count as holding.
[[nodiscard]] bool holds(When when, const VehicleOptions& options) noexcept;

// A group of messages that REQUEST_DATA_STREAM switches together (MAV_DATA_STREAM), as ArduPilot has them.
struct StreamGroup {
    std::uint8_t id;
    std::string_view parameter;  // sets the group's rate, in Hz
    std::span<const MessageId> messages;
};
[[nodiscard]] std::span<const StreamGroup> stream_groups() noexcept;

}  // namespace mavloom::sim
