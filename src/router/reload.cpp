// SPDX-License-Identifier: MIT
// Router: endpoints and recordings that are added, removed and replaced while it runs.
#include <fmt/format.h>

#include <algorithm>

#include "mavloom/link/silence_watch.hpp"
#include "mavloom/router/router.hpp"
#include "router/endpoints.hpp"
#include "router/forwarder.hpp"
#include "router/recordings.hpp"

namespace mavloom::router {

// Whether silence on the endpoint is worth a report. A server may wait for clients as long as it likes.
static bool expects_frames(const endpoint::Endpoint& endpoint) noexcept {
    return !endpoint.options.tap && !endpoint.accepts_clients();
}

SetupResult<void> Router::add(const endpoint::Endpoint& endpoint) {
    if (endpoint.is_recording()) return recordings_->add(endpoint);
    if (endpoint.options.heartbeat.value_or(false) && !has_heartbeat_)
        return setup_error(SetupCode::usage, fmt::format("{}: {}", endpoint.label(), config::heartbeat_needs_id));
    auto added = endpoints_->add(endpoint);
    if (added && expects_frames(endpoint)) silence_->add(endpoints_->all().back()->id, endpoint, mono_now());
    return added;
}

bool Router::remove(std::string_view label) {
    if (recordings_->remove(label)) return true;
    const RoutedEndpoint* const endpoint = endpoints_->find(label);
    if (endpoint == nullptr) return close_link(label);
    for (const auto& link : links_->links())
        if (link.endpoint == endpoint->id) forget_link(link.id);
    forwarder_->close_endpoint(*endpoint);
    silence_->remove(endpoint->id);
    endpoints_->remove(*endpoint);
    return true;
}

bool Router::close_link(std::string_view name) {
    const auto links = links_->links();
    const auto link = std::ranges::find(links, name, &link::LinkInfo::name);
    if (link == links.end() || !links_->close(link->id)) return false;
    forwarder_->close_link(link->id);
    forget_link(link->id);
    return true;
}

SetupResult<Router::GroupModes> Router::group_modes_of(std::span<const endpoint::Endpoint> endpoints) {
    return Groups::modes_of(endpoints);
}

SetupResult<void> Router::learn_group_modes(std::span<const endpoint::Endpoint> endpoints) {
    auto modes = Groups::modes_of(endpoints);
    if (!modes) return tl::unexpected(std::move(modes.error()));
    endpoints_->groups().set_modes(std::move(*modes));
    return {};
}

void Router::apply(const std::vector<endpoint::Endpoint>& endpoints) {
    const auto modes = Groups::modes_of(endpoints).value();
    std::vector<endpoint::Endpoint> gone;
    endpoints_->groups().set_modes(modes);
    remove_unwanted(endpoints, gone);
    endpoints_->groups().set_modes(modes);  // a group that became empty has lost its mode
    add_missing(endpoints, gone);
    forwarder_->set_group_orders(endpoints_->order_as(endpoints));
}

// Adds what it removed to `gone`.
void Router::remove_unwanted(std::span<const endpoint::Endpoint> wanted, std::vector<endpoint::Endpoint>& gone) {
    for (const auto& open : endpoints_->all())
        if (!endpoints_->is_as_wanted(*open, wanted)) gone.push_back(open->endpoint);
    for (const auto& recording : recordings_->endpoints())
        if (std::ranges::find(wanted, recording) == wanted.end()) gone.push_back(recording);
    for (const auto& endpoint : gone) {
        remove(endpoint.label());
        notice_(config::LogLevel::info, fmt::format("{}: removed", endpoint.label()));
    }
}

void Router::add_missing(std::span<const endpoint::Endpoint> wanted, std::span<const endpoint::Endpoint> gone) {
    for (const auto& endpoint : wanted) {
        if (endpoints_->has(endpoint) || recordings_->has(endpoint)) continue;
        if (const auto added = add(endpoint)) {
            notice_(config::LogLevel::info, fmt::format("{}: added", endpoint.label()));
        } else {
            notice_(config::LogLevel::error, fmt::format("left out: {}", added.error().text));
            put_back(gone, endpoint.label());
        }
    }
}

// Reopens an endpoint with its former options if its new options failed.
void Router::put_back(std::span<const endpoint::Endpoint> gone, const std::string& label) {
    const auto before = std::ranges::find(gone, label, &endpoint::Endpoint::label);
    if (before != gone.end() && add(*before))
        notice_(config::LogLevel::info, fmt::format("{}: continues with its former options", label));
}

}  // namespace mavloom::router
