// SPDX-License-Identifier: MIT
#include "sim/store/plan_service.hpp"

#include "sim/parts.hpp"

namespace mavloom::sim {

std::span<const MessageId> PlanService::handled() const noexcept { return {}; }

void PlanService::receive(const Client& /*from*/, MessageId /*id*/, ByteView /*payload*/, Moment /*now*/) { (void)parts_; }

}  // namespace mavloom::sim
