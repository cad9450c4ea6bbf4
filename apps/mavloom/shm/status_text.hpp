// SPDX-License-Identifier: MIT
// Formats the status of a ring for `shm list` and `shm stat`. Pure functions that return a new string.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "mavloom/shm/ring_info.hpp"

namespace mavloom::app::shm_parts {

using Json = nlohmann::ordered_json;

[[nodiscard]] Json json_of(const shm::RingStatus& ring);
// Returns the JSON object and a newline.
[[nodiscard]] std::string line_of(const Json& object);
// Returns one line: size, writer, number of readers and records.
[[nodiscard]] std::string text_of(const shm::RingStatus& ring);
// Returns the line of `text_of`, followed by the file, the counters and a line for each reader.
[[nodiscard]] std::string details_of(const shm::RingStatus& ring);

}  // namespace mavloom::app::shm_parts
