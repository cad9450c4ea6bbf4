// SPDX-License-Identifier: MIT
// What a program that shows traffic counted itself, all at one moment. Plain data.
#pragma once

#include <cstdint>
#include <vector>

#include "mavloom/observe/hop.hpp"
#include "mavloom/observe/loss.hpp"

namespace mavloom::observe {

struct OwnCounts {
    std::uint64_t frames = 0;            // that arrived, on all links together
    std::vector<SenderLoss> on_links{};  // what each sender lost on its link
    std::vector<NamedCount> losses{};    // what the program itself lost
    std::vector<HopLink> links{};
};

}  // namespace mavloom::observe
