// SPDX-License-Identifier: MIT
#include "router/endpoints.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "mavloom/base/counted.hpp"
#include "mavloom/dialect/rates.hpp"
#include "mavloom/fault/faults.hpp"

namespace mavloom::router {

namespace {

// A list of terms, and the name of its option.
struct Terms {
    std::string_view option;
    const endpoint::FilterTerms& terms;
};

SetupResult<dialect::Filter> make_filter(const dialect::Dialect& dialect, Terms allow, Terms block) {
    dialect::Filter filter;
    if (auto done = filter.allow(dialect, allow.terms); !done)
        return tl::unexpected(std::move(done.error()).within(allow.option));
    if (auto done = filter.block(dialect, block.terms); !done)
        return tl::unexpected(std::move(done.error()).within(block.option));
    return filter;
}

}  // namespace

SetupResult<void> RoutedEndpoints::add(const endpoint::Endpoint& endpoint) {
    if (auto good = check_group(endpoint); !good) return good;
    for (const auto& existing : endpoints_)
        if (auto good = endpoint::check_not_called(endpoint, existing->endpoint); !good) return good;
    auto policy = policy_of(endpoint);
    if (!policy) return tl::unexpected(std::move(policy.error()).within(endpoint.label()));
    const auto id = fault::add(links_, endpoint);
    if (!id) return tl::unexpected(id.error());
    policy->endpoint = id->value + 1;  // 0 has a meaning of its own
    keep(endpoints_.emplace_back(), {.id = *id,
                                     .endpoint = endpoint,
                                     .policy = std::move(*policy),
                                     .verifies = !endpoint.options.verify_key_file.empty()});
    groups_.note_mode(endpoint.options);
    return {};
}

SetupResult<void> RoutedEndpoints::add_inlet(const config::RingConfig& config, const std::filesystem::path& socket) {
    const auto id = links_.add_inlet(config.name, socket, config.inlet_mode.value_or(config.mode) & 0666u);
    if (!id) return tl::unexpected(id.error());
    endpoint::Endpoint endpoint;
    endpoint.scheme = endpoint::Scheme::shm;
    endpoint.path = config.name;
    keep(inlet_, {.id = *id, .endpoint = std::move(endpoint), .is_inlet = true});
    return {};
}

void RoutedEndpoints::keep(std::unique_ptr<RoutedEndpoint>& place, RoutedEndpoint endpoint) {
    place = std::make_unique<RoutedEndpoint>(std::move(endpoint));
    by_id_.resize(std::max<std::size_t>(by_id_.size(), place->id.value + 1));
    by_id_[place->id.value] = place.get();
}

void RoutedEndpoints::remove(const RoutedEndpoint& endpoint) {
    const auto group = endpoint.endpoint.options.group;
    links_.remove(endpoint.id);
    by_id_[endpoint.id.value] = nullptr;
    std::erase_if(endpoints_, [&](const auto& e) { return e.get() == &endpoint; });
    const auto is_member = [&](const auto& e) { return e->endpoint.options.group == group; };
    if (std::ranges::none_of(endpoints_, is_member)) groups_.forget_mode(group);
}

void RoutedEndpoints::remove_inlet() {
    if (!inlet_) return;
    links_.remove(inlet_->id);
    by_id_[inlet_->id.value] = nullptr;
    inlet_.reset();
}

const RoutedEndpoint* RoutedEndpoints::find(std::string_view label) const {
    const auto at = std::ranges::find_if(endpoints_, [&](const auto& e) { return e->endpoint.label() == label; });
    return at == endpoints_.end() ? nullptr : at->get();
}

bool RoutedEndpoints::has(const endpoint::Endpoint& endpoint) const {
    return std::ranges::any_of(endpoints_, [&](const auto& e) { return e->endpoint == endpoint; });
}

bool RoutedEndpoints::is_as_wanted(const RoutedEndpoint& open, std::span<const endpoint::Endpoint> wanted) const {
    return std::ranges::find(wanted, open.endpoint) != wanted.end() &&
           groups_.mode_of(open.endpoint.options) == open.policy.group_mode && !links_.has_other_keys(open.id);
}

std::optional<link::EndpointId> RoutedEndpoints::inlet() const noexcept {
    return inlet_ ? std::optional(inlet_->id) : std::nullopt;
}

SetupResult<route::LinkPolicy> RoutedEndpoints::policy_of(const endpoint::Endpoint& endpoint) {
    const auto& o = endpoint.options;
    route::LinkPolicy policy;
    auto in = make_filter(dialect_, {"in_allow", o.in_allow}, {"in_block", o.in_block});
    if (!in) return tl::unexpected(std::move(in.error()));
    auto out = make_filter(dialect_, {"out_allow", o.out_allow}, {"out_block", o.out_block});
    if (!out) return tl::unexpected(std::move(out.error()));
    auto rates = dialect::Rates::compile(dialect_, o.max_rate);
    if (!rates) return tl::unexpected(std::move(rates.error()).within("max_rate"));
    for (const auto& warning : dialect::rate_warnings(dialect_, o.max_rate))
        notice_(config::LogLevel::warning, fmt::format("{}: max_rate={}", endpoint.label(), warning));
    policy.in = std::move(*in);
    policy.out = std::move(*out);
    policy.max_rate = std::move(*rates);
    policy.max_bytes_per_s = o.max_bytes_per_s;
    policy.tap = o.tap;
    policy.is_private = o.is_private;
    policy.learns_first = o.learns_first;
    policy.group = groups_.id_of(o.group);
    policy.group_mode = groups_.mode_of(o);
    policy.group_order = endpoints_.empty() ? 0 : endpoints_.back()->policy.group_order + 1;
    return policy;
}

// Checks the endpoint's mode against the open endpoints of its group.
SetupResult<void> RoutedEndpoints::check_group(const endpoint::Endpoint& endpoint) const {
    const auto& o = endpoint.options;
    const auto is_member = [&](const auto& e) { return !o.group.empty() && e->endpoint.options.group == o.group; };
    const auto member = std::ranges::find_if(endpoints_, is_member);
    if (member == endpoints_.end() || groups_.mode_of(o) == (*member)->policy.group_mode) return {};
    return other_mode(endpoint, (*member)->policy.group_mode);
}

std::vector<route::GroupOrder> RoutedEndpoints::order_as(std::span<const endpoint::Endpoint> wanted) {
    std::ranges::stable_sort(endpoints_, {}, [&](const auto& e) {
        return std::ranges::find(wanted, e->endpoint.label(), &endpoint::Endpoint::label) - wanted.begin();
    });
    for (std::uint32_t order = 0; const auto& e : endpoints_) e->policy.group_order = order++;
    std::vector<route::GroupOrder> orders;
    for (const auto& link : links_.links()) orders.push_back({link.id, of(link.endpoint).policy.group_order});
    return orders;
}

void RoutedEndpoints::refill_lines() {
    for (RoutedEndpoint* const endpoint : by_id_) {
        if (endpoint == nullptr) continue;
        if (const auto more = endpoint->lines.refill(); more != 0)
            notice_(config::LogLevel::info,
                    fmt::format("{}: links came or went {}", endpoint->endpoint.label(), counted(more, "more time")));
    }
}

}  // namespace mavloom::router
