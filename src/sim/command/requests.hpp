// SPDX-License-Identifier: MIT
// Messages that the vehicle sends only when a client asks for them (REQUEST_MESSAGE): versions, modes, metadata.
// Private to module sim; tables without state. Every streamed message can be requested too.
#pragma once

#include "sim/command/commands.hpp"

namespace mavloom::sim {

// Sends the message to the link of the command. `index` is the command's second parameter, 0 if the client gave none.
// Returns `denied` if there is nothing to send, and `unsupported` if the vehicle has no such message.
[[nodiscard]] Result send_requested(Parts& parts, LinkId link, MessageId message, double index);

// The vehicle's unique number, AUTOPILOT_VERSION.uid: differs between systems and seeds.
[[nodiscard]] std::uint64_t unique_id(const VehicleOptions& options) noexcept;

}  // namespace mavloom::sim
