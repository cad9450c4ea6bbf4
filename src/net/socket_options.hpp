// SPDX-License-Identifier: MIT
// Socket options that UDP and TCP share. Private to module net. Any thread; allocates only error texts.
#pragma once

#include <cstdint>

#include "mavloom/base/result.hpp"
#include "mavloom/net/address.hpp"

namespace mavloom::net {

// Sets an option that is not essential: ignores the error if the kernel refuses it.
void set_option(int fd, int level, int name, int value) noexcept;
// Sets the receive buffer size: beyond net.core.rmem_max if permitted, else as large as allowed. Returns the actual
// size.
[[nodiscard]] std::uint64_t largest_receive_buffer(int fd, std::uint64_t bytes) noexcept;
[[nodiscard]] SetupResult<Address> local_address(int fd);

}  // namespace mavloom::net
