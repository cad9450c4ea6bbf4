// SPDX-License-Identifier: MIT
#include "mavloom/control/served.hpp"

#include <utility>

namespace mavloom::control {

Report report_of(Later<Lines> lines) {
    return report_of([lines = std::move(lines)] {
        std::string text;
        for (const auto& line : lines()) text.append(line).push_back('\n');
        return text;
    });
}

Report report_of(Later<std::string> text) {
    return {.next_text = [text = std::move(text)]() mutable {
        const auto once = std::exchange(text, {});
        return once ? once() : std::string();
    }};
}

}  // namespace mavloom::control
