// SPDX-License-Identifier: MIT
// The ports and names of a demo.
#pragma once

#include <cstdint>
#include <string>

#include "mavloom/base/result.hpp"

namespace mavloom::app::demo_parts {

struct Places {
    // UDP ports of 127.0.0.1. The usual ones are those of PX4's simulator, and of ground stations.
    std::uint16_t vehicle = 18570, router = 5057, listener = 5058, station = 14550;
    std::uint16_t relay = 0;    // from which the relay sends to the ground station
    std::string name = "demo";  // of the listener's ring

    [[nodiscard]] std::string router_name() const { return name + "-router"; }  // and that of its ring
    [[nodiscard]] std::string simulator_name() const { return name + "-sim"; }
};

// Free ports, and a name that no other demo has.
[[nodiscard]] SetupResult<Places> free_places();
// The usual ports and names. Only the relay's port is any free one.
[[nodiscard]] SetupResult<Places> usual_places();

// The error names the process that has the port.
[[nodiscard]] SetupResult<void> check_free(std::uint16_t port);

}  // namespace mavloom::app::demo_parts
