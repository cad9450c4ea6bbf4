// SPDX-License-Identifier: MIT
#include "link/open_endpoint.hpp"

#include <algorithm>

namespace mavloom::link::detail {

net::BlockQueue::Limits queue_limits(const endpoint::EndpointOptions& options) {
    net::BlockQueue::Limits limits;
    limits.max_bytes = static_cast<std::size_t>(options.queue_bytes);
    if (options.queue_age) limits.max_age.fill(*options.queue_age);
    return limits;
}

void OpenEndpoint::count_gone(const Link& link) noexcept {
    counters.gone.add(link.counters);
    counters.gone_queued.add(link.queue.blocks());
}

void OpenEndpoints::remove(EndpointId id) noexcept {
    if (find(id) != nullptr) endpoints_[id.value].reset();
}

bool OpenEndpoints::has(const std::string& label) const {
    return std::ranges::any_of(endpoints_, [&](const auto& e) { return e && e->info.endpoint.label() == label; });
}

bool OpenEndpoints::any_low_latency() const {
    return std::ranges::any_of(endpoints_, [](const auto& e) { return e && e->info.endpoint.options.low_latency; });
}

EndpointId SigningIds::id_for(const std::string& label, EndpointId fresh, const OpenEndpoints& endpoints) const {
    const auto before = by_label_.find(label);
    return before != by_label_.end() && endpoints.find(before->second.holder) == nullptr ? before->second.id : fresh;
}

void SigningIds::keep(const std::string& label, EndpointId signs_as, EndpointId holder) {
    const bool took_over = signs_as != holder;  // the id of an endpoint that was removed
    const auto at = by_label_.try_emplace(label, Held{signs_as, holder}).first;
    if (took_over) at->second.holder = holder;
}

}  // namespace mavloom::link::detail
