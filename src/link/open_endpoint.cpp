// SPDX-License-Identifier: MIT
#include "link/open_endpoint.hpp"

#include <algorithm>
#include <ranges>

#include "mavloom/endpoint/grammar.hpp"

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

bool OpenEndpoints::has_udp_port(std::uint16_t port) const {
    return std::ranges::any_of(endpoints_, [&](const auto& e) {
        return e && e->info.local_port == port &&
               (endpoint::set_of(e->info.endpoint.scheme) & endpoint::udp_schemes) != 0;
    });
}

std::optional<std::uint8_t> SigningIds::choose(const std::string& label, EndpointId fresh,
                                               const OpenEndpoints& endpoints) const {
    const Use* best = nullptr;
    const auto id_of = [&](const Use* use) { return static_cast<std::uint8_t>(use - uses_.data()); };
    for (const Use& use : uses_ | std::views::reverse) {
        if (use.number != 0 && endpoints.find(use.holder) != nullptr) continue;
        if (use.number != 0 && !label.empty() && use.label == label) return id_of(&use);
        if (best == nullptr || use.number < best->number) best = &use;
    }
    if (fresh.value < uses_.size())
        if (const Use* const own = &uses_[uses_.size() - 1 - fresh.value]; own->number == 0) return id_of(own);
    return best == nullptr ? std::nullopt : std::optional(id_of(best));
}

void SigningIds::keep(const std::string& label, std::uint8_t link_id, EndpointId holder) {
    uses_[link_id] = {label, holder, ++count_};
}

}  // namespace mavloom::link::detail
