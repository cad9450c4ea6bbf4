// SPDX-License-Identifier: MIT
// ArduPilot's file @PARAM/param.pck: all parameters in one file, so that a client reads them by FTP in a second.
// Private to module sim; a pure function. Source: ArduPilot's developer documentation, "AP_Filesystem".
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "flight/firmware/parameters.hpp"
#include "mavloom/sim/flight.hpp"

namespace mavloom::sim {

// `path` may end with a query: ?withdefaults=1, ?start=INDEX, ?count=NUMBER, joined by &. Empty: not the path of this
// file.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> parameter_pack(const Parameters& parameters,
                                                                      std::string_view path);

}  // namespace mavloom::sim
