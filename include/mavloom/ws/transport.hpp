// SPDX-License-Identifier: MIT
// MAVLink over WebSocket: the schemes wsin and wsout. Each binary message holds whole frames.
#pragma once

namespace mavloom::ws {

// From now on, endpoints of the program may have these schemes. Safe from any thread, any number of times.
void register_transports() noexcept;

}  // namespace mavloom::ws
