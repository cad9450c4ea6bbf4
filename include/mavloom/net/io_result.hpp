// SPDX-License-Identifier: MIT
// Error codes of reads and writes on the data path. They include normal outcomes such as would_block. Plain values: any
// thread, no exceptions, no allocation.
#pragma once

#include <cstdint>

#include "mavloom/base/result.hpp"

namespace mavloom::net {

enum class IoError : std::uint8_t {
    would_block,  // nothing to read now, or no room to write
    // The peer of an earlier datagram has closed its port. This call did nothing; repeat it.
    refused,
    unreachable,  // no route, or the host does not answer; may concern an earlier datagram, like `refused`
    no_buffers,   // the kernel is short of memory at the moment
    too_long,     // the datagram is longer than the path allows
    closed,       // the far side ended the stream, or the socket is not connected any more
    no_descriptors,
    other,
};

template <class T>
using IoResult = Result<T, IoError>;

[[nodiscard]] IoError io_error_of(int err) noexcept;

}  // namespace mavloom::net
