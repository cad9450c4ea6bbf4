// SPDX-License-Identifier: MIT
// Receives frames from local programs that read the ring: a Unix datagram socket on which each sender is a link.
// Private to module link; single owner thread.
#pragma once

#include <filesystem>

#include "link/core/core.hpp"

namespace mavloom::link::detail {

inline constexpr std::string_view inlet_suffix = "in";  // suffix of the socket's name in the run folder

// Opens the inlet and replaces a socket whose router is gone. Closing the endpoint removes the socket, if the path
// still leads to it.
[[nodiscard]] Opened open_inlet(Opening opening, const std::filesystem::path& path, unsigned mode);

}  // namespace mavloom::link::detail
