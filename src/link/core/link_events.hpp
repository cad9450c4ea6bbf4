// SPDX-License-Identifier: MIT
// Notifies the handler of links that come up or go down, and of other events. Private to module link; single owner
// thread.
//
// Inside a turn, it notifies the handler at once. If an event occurs or a link comes up between two turns, it notifies
// the handler at the start of the next turn. It does not report a link that goes down between turns.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "link/core/link_table.hpp"

namespace mavloom::link::detail {

class LinkEvents {
public:
    void begin_turn(LinkHandler& handler, const LinkTable& links);
    void end_turn() noexcept { handler_ = nullptr; }
    // Null outside a turn.
    [[nodiscard]] LinkHandler* handler() const noexcept { return handler_; }

    void mark_up(Link& link);
    void mark_down(Link& link, std::string_view why);
    void notice(EndpointId endpoint, std::string text);

private:
    LinkHandler* handler_ = nullptr;
    std::vector<std::pair<EndpointId, std::string>> notices_;  // since the last turn, like `came_up_`
    std::vector<LinkId> came_up_;
};

}  // namespace mavloom::link::detail
