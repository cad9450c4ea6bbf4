// SPDX-License-Identifier: MIT
#include "sim/store/log_service.hpp"

#include "sim/parts.hpp"

namespace mavloom::sim {

std::span<const MessageId> LogService::handled() const noexcept { return {}; }

void LogService::receive(const Client& /*from*/, MessageId /*id*/, ByteView /*payload*/, Moment /*now*/) {
    (void)parts_;
}

Result LogService::start_stream(const Client& /*to*/, Moment /*now*/) { return Result::unsupported; }

Result LogService::stop_stream(const Client& /*to*/) { return Result::unsupported; }

}  // namespace mavloom::sim
