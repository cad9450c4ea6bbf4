// SPDX-License-Identifier: MIT
// shm:// where it is sent to: the inlet of the router that writes the ring. Private to module runtime; one owner thread.
#pragma once

#include <memory>

#include "runtime/links_core.hpp"

namespace mavloom::runtime::detail {

[[nodiscard]] SetupResult<std::unique_ptr<OpenEndpoint>> open_shm(Opening opening);

}  // namespace mavloom::runtime::detail
