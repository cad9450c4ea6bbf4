// SPDX-License-Identifier: MIT
// The messages that a person or a protocol waits for: class 0 of DESIGN.md rule 2. Queues drop them last, `max_bytes` and the `*` of
// `max_rate` spare them.
// Pure functions; nothing allocates.
#pragma once

#include "mavloom/base/ids.hpp"

namespace mavloom::route {

// HEARTBEAT, STATUSTEXT, commands, acknowledgements, missions, parameters, change of operator and of mode.
[[nodiscard]] bool is_essential(MessageId id) noexcept;

}  // namespace mavloom::route
