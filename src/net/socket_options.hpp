// SPDX-License-Identifier: MIT
// Socket options that UDP and TCP share. Private to module net.
#pragma once

#include <cstdint>

#include "mavloom/base/result.hpp"
#include "mavloom/net/address.hpp"

namespace mavloom::net {

// Options that make things better where the kernel has them; a refusal is no error.
void set_option(int fd, int level, int name, int value) noexcept;
// Asks beyond net.core.rmem_max where permitted, else for the most allowed; returns what the kernel now has.
[[nodiscard]] std::uint64_t largest_receive_buffer(int fd, std::uint64_t bytes) noexcept;
[[nodiscard]] SetupResult<Address> local_address(int fd);

}  // namespace mavloom::net
