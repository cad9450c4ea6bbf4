// SPDX-License-Identifier: MIT
// The sender of a request. All protocol state belongs to a client, so that several clients of one vehicle do not
// disturb each other. Private to module sim; a plain value.
#pragma once

#include <compare>

#include "mavloom/base/ids.hpp"

namespace mavloom::sim {

struct Client {
    LinkId link;
    Source id;  // system and component of the request
    friend constexpr auto operator<=>(const Client&, const Client&) = default;
};

// Component ids that a vehicle uses (MAV_COMPONENT).
inline constexpr ComponentId autopilot_component{1};

}  // namespace mavloom::sim
