// SPDX-License-Identifier: MIT
#include "sim/service/calibration.hpp"

#include "sim/parts.hpp"

namespace mavloom::sim {

std::span<const MessageId> CalibrationService::handled() const noexcept { return {}; }

void CalibrationService::receive(const Client& /*from*/, MessageId /*id*/, ByteView /*payload*/, Moment /*now*/) { (void)parts_; }

}  // namespace mavloom::sim
