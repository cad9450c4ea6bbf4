// SPDX-License-Identifier: MIT
// The way back from programs of this machine that read the ring: a Unix datagram socket, each sender a link. Private to module link; one owner
// thread.
#pragma once

#include <filesystem>

#include "link/core.hpp"

namespace mavloom::link::detail {

// Takes over a socket whose router is gone. The socket is removed with the endpoint, if it is still this one.
inline constexpr std::string_view inlet_suffix = "in";  // of the socket's name in the run folder

[[nodiscard]] SetupResult<std::unique_ptr<OpenEndpoint>> open_inlet(Opening opening, const std::filesystem::path& path,
                                                                    unsigned mode);

}  // namespace mavloom::link::detail
