// SPDX-License-Identifier: MIT
// How `shm list` and `shm stat` print a ring: as JSON, as one line, or with all details. Pure functions.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "mavloom/shm/ring_info.hpp"

namespace mavloom::app::shm_parts {

using Json = nlohmann::ordered_json;

[[nodiscard]] Json json_of(const shm::RingStatus& ring);
// One JSON object and a newline.
[[nodiscard]] std::string line_of(const Json& object);
// One line: size, writer, number of readers and records.
[[nodiscard]] std::string text_of(const shm::RingStatus& ring);
// The same, with the file, the counters and a line for each reader.
[[nodiscard]] std::string details_of(const shm::RingStatus& ring);

}  // namespace mavloom::app::shm_parts
