// SPDX-License-Identifier: MIT
#include "mavloom/control/served.hpp"

#include <utility>

namespace mavloom::control {

Report report_of(std::function<std::string()> text) {
    return {.next_text = [text = std::move(text)]() mutable {
        const auto once = std::exchange(text, {});
        return once ? once() : std::string();
    }};
}

}  // namespace mavloom::control
