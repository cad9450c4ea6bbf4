// SPDX-License-Identifier: MIT
#include "sim/service/gimbal.hpp"

#include "sim/parts.hpp"

namespace mavloom::sim {

std::span<const MessageId> Gimbal::handled() const noexcept { return {}; }

void Gimbal::receive(const Client& /*from*/, MessageId /*id*/, ByteView /*payload*/, Moment /*now*/) { (void)parts_; }

}  // namespace mavloom::sim
