// SPDX-License-Identifier: MIT
// The requests of `mavloom ctl`; see report.hpp.
#include <fmt/format.h>

#include <array>

#include "control/fault_request.hpp"
#include "control/json_request.hpp"
#include "mavloom/router/report.hpp"

namespace mavloom::router {

namespace {

Report add(Router& router, const std::string& url) {
    const auto endpoint = parse_router_endpoint(url);
    if (!endpoint) return control::failed(endpoint.error().text);
    if (const auto added = router.add(*endpoint); !added) return control::failed(added.error().text);
    router.notify(config::LogLevel::info, endpoint->label() + ": added by ctl");
    return control::succeeded();
}

// Removes an endpoint, a recording or a link by its name.
Report remove(Router& router, const std::string& name) {
    if (!router.remove(name)) return control::nothing_to_remove(name);
    router.notify(config::LogLevel::info, name + ": removed by ctl");
    return control::succeeded();
}

Report set_faults(Router& router, const control::Json& request) {
    return control::set_faults(router.links(), request,
                               [&](const std::string& text) { router.notify(config::LogLevel::info, text); });
}

using Command = control::Command<Router>;

constexpr std::array commands{
    Command{"links", [](Router& r, const control::Json&) { return report_links(r); }},
    Command{"routes", [](Router& r, const control::Json&) { return report_routes(r); }},
    Command{"stats", [](Router& r, const control::Json&) { return report_stats(r); }},
    Command{"add", [](Router& r, const control::Json& request) { return add(r, control::text_at(request, "url")); }},
    Command{"remove",
            [](Router& r, const control::Json& request) { return remove(r, control::text_at(request, "name")); }},
    Command{"fault", set_faults},
};

}  // namespace

SetupResult<endpoint::Endpoint> parse_router_endpoint(std::string_view text) {
    auto endpoint = endpoint::parse_endpoint(text);
    if (!endpoint) return endpoint;
    if (endpoint->has_address() && endpoint->address.port == 0)
        return setup_error(
            SetupCode::usage,
            fmt::format("{}: other programs must know a router's port; choose one from 1 to 65535", endpoint->label()));
    return endpoint;
}

Report answer_request(Router& router, std::string_view request) {
    return control::answer_request(router, request, commands);
}

Report Router::answer(std::string_view request) { return answer_request(*this, request); }

Report Router::metrics() { return report_metrics(*this); }

}  // namespace mavloom::router
