// SPDX-License-Identifier: MIT
// Filter: selects frames by message id, system and component. A plain value.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "mavloom/wire/frame.hpp"

namespace mavloom::feed {

// An absent condition accepts every frame. An empty list of ids accepts none.
struct Filter {
    std::optional<std::vector<MessageId>> ids{};
    std::optional<std::uint8_t> system{}, component{};

    [[nodiscard]] bool takes(const wire::FrameView& frame) const noexcept {
        return (!system || frame.system().value == *system) && (!component || frame.component().value == *component) &&
               (!ids || std::ranges::find(*ids, frame.id()) != ids->end());
    }
};

}  // namespace mavloom::feed
