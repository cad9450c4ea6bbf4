// SPDX-License-Identifier: MIT
#include "mavloom/net/io_result.hpp"

#include <cerrno>

namespace mavloom::net {

IoError io_error_of(int err) noexcept {
    switch (err) {
        case EAGAIN:
        case EINTR: return IoError::would_block;
        case ECONNREFUSED: return IoError::refused;
        case ENETUNREACH:
        case EHOSTUNREACH:
        case ENETDOWN:
        case EHOSTDOWN: return IoError::unreachable;
        case ENOBUFS:
        case ENOMEM: return IoError::no_buffers;
        case EMSGSIZE: return IoError::too_long;
        case ECONNRESET:
        case EPIPE:
        case ENOTCONN:
        case EDESTADDRREQ:
        case ETIMEDOUT:
        case ECONNABORTED: return IoError::closed;
        case EMFILE:
        case ENFILE: return IoError::no_descriptors;
        default: return IoError::other;
    }
}

}  // namespace mavloom::net
