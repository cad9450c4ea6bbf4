// SPDX-License-Identifier: MIT
#include "link/open_endpoint.hpp"

#include <algorithm>

#include "link/core/core.hpp"
#include "mavloom/endpoint/grammar.hpp"

namespace mavloom::link::detail {

bool Opening::is_required() const noexcept { return endpoint.options.required && !core.has_begun(); }

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
        return e && e->info.local_port == port && e->info.endpoint.row().carrier == endpoint::Carrier::udp;
    });
}

}  // namespace mavloom::link::detail
