// SPDX-License-Identifier: MIT
#include "sim/parts.hpp"
#include "sim/command/commands.hpp"

namespace mavloom::sim {

std::span<const CommandRow> maintenance_commands() noexcept { return {}; }

}  // namespace mavloom::sim
