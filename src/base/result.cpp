// SPDX-License-Identifier: MIT
#include "mavloom/base/result.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <system_error>

namespace mavloom {

static SetupCode code_of(int err) {
    switch (err) {
        case ENOENT:
        case ENODEV:
        case ENXIO:
        case ENOTDIR: return SetupCode::not_found;
        case EACCES:
        case EPERM:
        case EROFS: return SetupCode::permission;
        case EADDRINUSE:
        case EBUSY:
        case EEXIST: return SetupCode::in_use;
        case ECONNREFUSED:
        case EHOSTUNREACH:
        case ENETUNREACH:
        case ETIMEDOUT: return SetupCode::unreachable;
        case ENOSPC:
        case EDQUOT:
        case ENOMEM:
        case EFBIG: return SetupCode::no_space;
        default: return SetupCode::system;
    }
}

tl::unexpected<SetupError> system_error(std::string_view what, int err) {
    return tl::unexpected<SetupError>(
        SetupError{code_of(err), err, fmt::format("{}: {}", what, std::generic_category().message(err))});
}

}  // namespace mavloom
