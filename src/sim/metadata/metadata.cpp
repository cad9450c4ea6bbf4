// SPDX-License-Identifier: MIT
#include "sim/metadata/metadata.hpp"

#include "sim/firmware/firmware.hpp"

namespace mavloom::sim {

std::optional<GeneralMetadata> general_metadata(const Firmware& /*firmware*/) { return std::nullopt; }

}  // namespace mavloom::sim
