// SPDX-License-Identifier: MIT
#include "sim/service/other_services.hpp"

#include "sim/parts.hpp"

namespace mavloom::sim {

std::vector<std::unique_ptr<Service>> make_other_services(Parts& /*parts*/) { return {}; }

}  // namespace mavloom::sim
