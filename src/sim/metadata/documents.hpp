// SPDX-License-Identifier: MIT
// The texts of the metadata files, before compression. Private to src/sim/metadata; pure functions. They follow the
// schemas in the MAVLink guide, "Component Metadata Protocol".
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "mavloom/sim/flight.hpp"

namespace mavloom::flight {
class Firmware;
}

namespace mavloom::sim {

// COMP_METADATA_TYPE
enum class MetadataType : std::uint8_t { general = 0, parameter = 1, events = 4, actuators = 5 };

struct ListedMetadata {
    MetadataType type;
    std::string_view path;
    std::uint32_t file_crc = 0;  // of the compressed file
};

[[nodiscard]] std::string general_document(std::span<const ListedMetadata> files);
[[nodiscard]] std::string parameter_document(const Firmware& firmware);
[[nodiscard]] std::string event_document(const Firmware& firmware);
[[nodiscard]] std::string actuator_document(const Firmware& firmware);

}  // namespace mavloom::sim
