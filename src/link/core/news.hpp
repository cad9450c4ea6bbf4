// SPDX-License-Identifier: MIT
// Notifies the handler of links that come and go, and of events. Private to module link; single owner thread.
//
// Inside a turn the handler hears of a change at once. Outside a turn, links that come up and events reach it at the
// start of the next turn; a link that goes down is not reported.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "link/core/link_table.hpp"

namespace mavloom::link::detail {

class News {
public:
    void begin_turn(LinkHandler& handler, const LinkTable& links);
    void end_turn() noexcept { handler_ = nullptr; }
    // Null outside a turn.
    [[nodiscard]] LinkHandler* handler() const noexcept { return handler_; }

    void set_up(Link& link);
    void set_down(Link& link, std::string_view why);
    void notice(EndpointId endpoint, std::string text);

private:
    LinkHandler* handler_ = nullptr;
    std::vector<std::pair<EndpointId, std::string>> notices_;  // since the last turn, as `came_up_`
    std::vector<LinkId> came_up_;
};

}  // namespace mavloom::link::detail
