// SPDX-License-Identifier: MIT
// shm:// where it is sent to: the inlet of the router that writes the ring. Private to module link; one owner thread.
#pragma once

#include <memory>

#include "link/core.hpp"

namespace mavloom::link::detail {

[[nodiscard]] SetupResult<std::unique_ptr<OpenEndpoint>> open_shm(Opening opening);

}  // namespace mavloom::link::detail
