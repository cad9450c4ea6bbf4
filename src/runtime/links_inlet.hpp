// SPDX-License-Identifier: MIT
// The way back from programs of this machine that read the ring: a Unix datagram socket, each sender a link. Private to module runtime; one owner
// thread.
#pragma once

#include <filesystem>

#include "runtime/links_core.hpp"

namespace mavloom::runtime::detail {

// Takes over a socket whose router is gone. The socket is removed with the endpoint, if it is still this one.
[[nodiscard]] SetupResult<std::unique_ptr<OpenEndpoint>> open_inlet(Opening opening, const std::filesystem::path& path,
                                                                    unsigned mode);

}  // namespace mavloom::runtime::detail
