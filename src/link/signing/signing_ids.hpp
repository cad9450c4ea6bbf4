// SPDX-License-Identifier: MIT
// The link ids that endpoints sign with. Private to module link; single owner thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "link/open_endpoint.hpp"

namespace mavloom::link::detail {

// Decides which link id an endpoint signs with. A signature has 8 bits for it, and two endpoints that are open must not
// share one: the far side would take frames of one endpoint for replays. A reopened endpoint keeps the link id of its
// label, so that the far side sees the same link. Ids are given out from 255 downwards, because vehicles and ground
// stations mostly sign with 0 and small ids.
class SigningIds {
public:
    // Returns the link id for an endpoint that is about to be opened with id `fresh`: the first of these that exists
    // and that no open endpoint uses.
    // - the link id that this label had (an empty label had none)
    // - 255 - `fresh`, if it was never used
    // - any that was never used
    // - the one that was opened longest ago
    // Empty if open endpoints use all 256.
    [[nodiscard]] std::optional<std::uint8_t> choose(const std::string& label, EndpointId fresh,
                                                     const OpenEndpoints& endpoints) const;
    // Call when the endpoint was opened: `holder` now signs with `link_id`.
    void keep(const std::string& label, std::uint8_t link_id, EndpointId holder);

private:
    struct Use {
        std::string label;
        EndpointId holder;
        std::uint64_t number = 0;  // grows with every use of any link id; 0: never used
    };
    std::array<Use, 256> uses_;  // by link id
    std::uint64_t count_ = 0;
};

}  // namespace mavloom::link::detail
