// SPDX-License-Identifier: MIT
// The endpoints that a router has open, with the rules for their links. Private to module router; single owner thread.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "mavloom/config/config.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/route/engine.hpp"
#include "router/groups.hpp"
#include "router/notice.hpp"

namespace mavloom::router {

struct RoutedEndpoint {
    link::EndpointId id;
    endpoint::Endpoint endpoint;
    route::LinkPolicy policy{};
    bool verifies = false;
    bool is_inlet = false;
    LineBudget lines{};  // limits log lines about its links
};

class RoutedEndpoints {
public:
    // `dialect` and `links` must outlive the object. `notice` receives warnings about rates.
    RoutedEndpoints(const dialect::Dialect& dialect, link::Links& links, Notice notice)
        : dialect_(dialect), links_(links), notice_(std::move(notice)) {}

    // Opens an endpoint. Fails if Links::add fails, or if a filter, a rate or the group's mode is wrong.
    [[nodiscard]] SetupResult<void> add(const endpoint::Endpoint& endpoint);
    // Opens the inlet of a ring. `find` and `all` do not return it.
    [[nodiscard]] SetupResult<void> add_inlet(const config::RingConfig& config, const std::filesystem::path& socket);
    // Closes the endpoint and its links.
    void remove(const RoutedEndpoint& endpoint);
    void remove_inlet();

    // The endpoint of a link that exists.
    [[nodiscard]] RoutedEndpoint& of(link::EndpointId id) const noexcept { return *by_id_[id.value]; }
    // Null if no endpoint has this label.
    [[nodiscard]] const RoutedEndpoint* find(std::string_view label) const;
    [[nodiscard]] bool has(const endpoint::Endpoint& endpoint) const;
    // True if the open endpoint matches `wanted`: same options, same group mode, and unchanged contents of its key
    // files.
    [[nodiscard]] bool is_as_wanted(const RoutedEndpoint& open, std::span<const endpoint::Endpoint> wanted) const;
    [[nodiscard]] std::span<const std::unique_ptr<RoutedEndpoint>> all() const noexcept { return endpoints_; }
    [[nodiscard]] std::optional<link::EndpointId> inlet() const noexcept;
    [[nodiscard]] Groups& groups() noexcept { return groups_; }

    // Puts the endpoints into the order of `wanted`, and returns the new order of their links. Groups of mode `primary`
    // prefer links in the order of the configuration, not in the order of opening.
    [[nodiscard]] std::vector<route::GroupOrder> order_as(std::span<const endpoint::Endpoint> wanted);
    // Refills the budgets of log lines, and logs how many lines were suppressed.
    void refill_lines();

private:
    [[nodiscard]] SetupResult<route::LinkPolicy> policy_of(const endpoint::Endpoint& endpoint);
    [[nodiscard]] SetupResult<void> check_group(const endpoint::Endpoint& endpoint) const;
    void keep(std::unique_ptr<RoutedEndpoint>& place, RoutedEndpoint endpoint);

    const dialect::Dialect& dialect_;
    link::Links& links_;
    Notice notice_;
    Groups groups_;
    std::vector<std::unique_ptr<RoutedEndpoint>> endpoints_;
    std::unique_ptr<RoutedEndpoint> inlet_;  // null if there is none
    std::vector<RoutedEndpoint*> by_id_;     // by EndpointId; null if removed
};

}  // namespace mavloom::router
