// SPDX-License-Identifier: MIT
#include "sim/service/guard.hpp"

#include "sim/parts.hpp"

namespace mavloom::sim {

bool Guard::admits(const wire::FrameView& frame, WallTime /*utc*/) {
    last_was_signed_ = frame.is_signed();
    return true;
}

std::span<const MessageId> Guard::handled() const noexcept { return {}; }

void Guard::receive(const Client& /*from*/, MessageId /*id*/, ByteView /*payload*/, Moment /*now*/) { (void)parts_; }

}  // namespace mavloom::sim
