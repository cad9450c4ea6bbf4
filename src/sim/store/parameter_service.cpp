// SPDX-License-Identifier: MIT
#include "sim/store/parameter_service.hpp"

#include "sim/parts.hpp"

namespace mavloom::sim {

std::span<const MessageId> ParameterService::handled() const noexcept { return {}; }

void ParameterService::receive(const Client& /*from*/, MessageId /*id*/, ByteView /*payload*/, Moment /*now*/) { (void)parts_; }

}  // namespace mavloom::sim
