// SPDX-License-Identifier: MIT
// Component metadata: JSON files from which ground stations learn the names and ranges of parameters, the texts of
// events and the outputs of actuators. Private to module sim.
//
// All vehicles of a firmware share the files. They are made at their first use and never change; any thread may use
// them. PX4 serves them by MAVLink FTP, ArduPilot has none. Source: MAVLink guide, "Component Metadata Protocol".
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "mavloom/base/bytes.hpp"
#include "mavloom/sim/flight.hpp"

namespace mavloom::flight {
class Firmware;
}

namespace mavloom::sim {

// The general file, which lists the others, as COMPONENT_METADATA and COMPONENT_INFORMATION report it.
struct GeneralMetadata {
    std::string_view uri;        // mftp://...
    std::uint32_t file_crc = 0;  // of the JSON before compression, as in PX4
};

// Empty if this firmware has no metadata. REQUEST_MESSAGE for it is then UNSUPPORTED.
[[nodiscard]] std::optional<GeneralMetadata> general_metadata(const Firmware& firmware);

// The paths of the files, without leading slash.
[[nodiscard]] std::span<const std::string_view> metadata_paths(const Firmware& firmware) noexcept;
// The file as it is transferred: JSON, compressed by xz. `index` is the position in `metadata_paths`.
[[nodiscard]] ByteView metadata_file(const Firmware& firmware, std::size_t index);

}  // namespace mavloom::sim
