// SPDX-License-Identifier: MIT
// shm:// as a destination: sends to the inlet of the router that writes the ring. Private to module link; single
// owner thread.
#pragma once

#include <memory>

#include "link/core/core.hpp"

namespace mavloom::link::detail {

[[nodiscard]] SetupResult<std::unique_ptr<OpenEndpoint>> open_shm(Opening opening);

}  // namespace mavloom::link::detail
