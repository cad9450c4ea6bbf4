// SPDX-License-Identifier: MIT
// How a call on the data path can end without success. What is normal (would_block) stands beside what is not; none of them throws or
// allocates. Thread-safe: values only.
#pragma once

#include <cstdint>

#include "mavloom/base/result.hpp"

namespace mavloom::net {

enum class IoError : std::uint8_t {
    would_block,  // nothing to read, or no room to write, now
    refused,      // an earlier datagram met a closed port; the call did nothing and may be repeated
    unreachable,  // no route, or the host does not answer
    no_buffers,   // the kernel is short of memory for the moment
    too_long,     // the datagram is longer than the path takes
    closed,       // the far side ended the stream, or the socket has none any longer
    no_descriptors,
    other,
};

template <class T>
using IoResult = Result<T, IoError>;

[[nodiscard]] IoError io_error_of(int err) noexcept;

}  // namespace mavloom::net
