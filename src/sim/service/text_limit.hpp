// SPDX-License-Identifier: MIT
// Limits the texts about messages that a client may send at any rate: one a second. Private to module sim.
#pragma once

#include <optional>

#include "mavloom/base/clock.hpp"
#include "mavloom/sim/flight.hpp"

namespace mavloom::sim {

class TextLimit {
public:
    // True if there may be a text now; it then counts as sent.
    [[nodiscard]] bool spend(FlightTime now) noexcept {
        if (last_ && now - *last_ < std::chrono::seconds{1}) return false;
        last_ = now;
        return true;
    }

private:
    std::optional<FlightTime> last_;
};

}  // namespace mavloom::sim
