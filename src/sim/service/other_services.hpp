// SPDX-License-Identifier: MIT
// The services that no other part calls directly. Private to module sim.
#pragma once

#include <memory>
#include <vector>

#include "sim/service/service.hpp"

namespace mavloom::sim {

struct Parts;

[[nodiscard]] std::vector<std::unique_ptr<Service>> make_other_services(Parts& parts);

}  // namespace mavloom::sim
