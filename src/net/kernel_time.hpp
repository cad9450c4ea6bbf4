// SPDX-License-Identifier: MIT
// Finds the kernel's time of arrival (SO_TIMESTAMPNS) beside a received datagram. Private to module net. Any thread;
// allocates nothing.
#pragma once

#include <sys/socket.h>

#include <chrono>
#include <cstring>
#include <ctime>

#include "mavloom/base/clock.hpp"

namespace mavloom::net {

// Returns time 0 if the first control message is not a time.
[[nodiscard]] inline WallTime kernel_time(const msghdr& header) noexcept {
    const cmsghdr* const control = CMSG_FIRSTHDR(&header);
    if (control == nullptr || control->cmsg_level != SOL_SOCKET || control->cmsg_type != SCM_TIMESTAMPNS) return {};
    timespec time;
    std::memcpy(&time, CMSG_DATA(control), sizeof time);
    return WallTime{std::chrono::seconds(time.tv_sec) + Nanoseconds(time.tv_nsec)};
}

}  // namespace mavloom::net
