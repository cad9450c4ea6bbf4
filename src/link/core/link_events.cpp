// SPDX-License-Identifier: MIT
#include "link/core/link_events.hpp"

namespace mavloom::link::detail {

void LinkEvents::begin_turn(LinkHandler& handler, const LinkTable& links) {
    handler_ = &handler;
    if (!notices_.empty()) {
        for (auto& [endpoint, text] : std::exchange(notices_, {})) handler.on_notice(endpoint, text);
    }
    if (came_up_.empty()) return;
    for (const LinkId id : std::exchange(came_up_, {})) {
        Link* const link = links.find(id);
        if (link == nullptr || !link->up || std::exchange(link->reported_up, true)) continue;
        handler.on_link_up(link->id, link->endpoint, link->name);
    }
}

void LinkEvents::mark_up(Link& link) {
    if (std::exchange(link.up, true)) return;
    if (handler_ == nullptr) return came_up_.push_back(link.id);
    link.reported_up = true;
    handler_->on_link_up(link.id, link.endpoint, link.name);
}

void LinkEvents::mark_down(Link& link, std::string_view why) {
    if (!std::exchange(link.up, false)) return;
    if (std::exchange(link.reported_up, false) && handler_ != nullptr)
        handler_->on_link_down(link.id, link.endpoint, why);
}

void LinkEvents::notice(EndpointId endpoint, std::string text) {
    if (handler_ != nullptr) handler_->on_notice(endpoint, text);
    else notices_.emplace_back(endpoint, std::move(text));
}

}  // namespace mavloom::link::detail
