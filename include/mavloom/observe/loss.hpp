// SPDX-License-Identifier: MIT
// The loss of one sender on one link, as sequence numbers show it. Plain data.
#pragma once

#include <cstdint>
#include <string>

#include "mavloom/base/ids.hpp"

namespace mavloom::observe {

struct SenderLoss {
    LinkId link{};
    std::string link_name{};
    Source source{};
    // As in wire::SequenceStats, since the start.
    std::uint64_t received = 0, lost = 0, late = 0, duplicate = 0, resync = 0;
};

// Of the frames that were sent, 0 to 1. `Loss` has the counts of wire::SequenceStats.
template <class Loss>
[[nodiscard]] double loss_ratio(const Loss& loss) noexcept {
    const auto sent = loss.received - loss.duplicate + loss.lost;
    return sent == 0 ? 0 : static_cast<double>(loss.lost) / static_cast<double>(sent);
}

}  // namespace mavloom::observe
