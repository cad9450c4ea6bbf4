// SPDX-License-Identifier: MIT
#include "sim/service/events.hpp"

#include "sim/parts.hpp"

namespace mavloom::sim {

std::span<const MessageId> EventService::handled() const noexcept { return {}; }

void EventService::receive(const Client& /*from*/, MessageId /*id*/, ByteView /*payload*/, Moment /*now*/) {
    (void)parts_;
}

}  // namespace mavloom::sim
