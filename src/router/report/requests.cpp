// SPDX-License-Identifier: MIT
// The requests of `mavloom ctl`; see report.hpp.
#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "mavloom/router/report.hpp"
#include "router/report/json_line.hpp"

namespace mavloom::router {

namespace {

constexpr std::array commands{"links", "routes", "stats", "add", "remove"};

Report one_line(const Json& object) {
    return control::report_of([line = line_of(object)] { return line + '\n'; });
}

Report failed(std::string_view why) { return one_line({{"ok", false}, {"error", why}}); }

Report done() { return one_line({{"ok", true}}); }

Report add(Router& router, const std::string& url) {
    const auto endpoint = parse_router_endpoint(url);
    if (!endpoint) return failed(endpoint.error().text);
    if (const auto added = router.add(*endpoint); !added) return failed(added.error().text);
    router.notify(config::LogLevel::info, endpoint->label() + ": added by ctl");
    return done();
}

// Removes an endpoint, a recording or a link by its name.
Report remove(Router& router, const std::string& name) {
    if (!router.remove(name))
        return failed(fmt::format(
            "there is no endpoint {}, and no link of that name that could be closed; `links` lists them", name));
    router.notify(config::LogLevel::info, name + ": removed by ctl");
    return done();
}

std::string text_at(const Json& request, const char* key) {
    const auto at = request.find(key);
    return at != request.end() && at->is_string() ? at->get<std::string>() : std::string();
}

}  // namespace

SetupResult<endpoint::Endpoint> parse_router_endpoint(std::string_view text) {
    auto endpoint = endpoint::parse_endpoint(text);
    if (!endpoint) return endpoint;
    const bool has_port = endpoint->scheme != endpoint::Scheme::tlog && endpoint->scheme != endpoint::Scheme::serial &&
                          endpoint->scheme != endpoint::Scheme::shm;  // Router::add rejects shm://
    if (has_port && endpoint->address.port == 0)
        return setup_error(
            SetupCode::usage,
            fmt::format("{}: other programs must know a router's port; choose one from 1 to 65535", endpoint->label()));
    return endpoint;
}

Report answer_request(Router& router, std::string_view request) {
    const auto parsed = Json::parse(request, nullptr, false);
    if (!parsed.is_object()) return failed("a request is one JSON object per line, as in {\"cmd\":\"links\"}");
    const auto command = text_at(parsed, "cmd");
    if (command == "links") return report_links(router);
    if (command == "routes") return report_routes(router);
    if (command == "stats") return report_stats(router);
    if (command == "add") return add(router, text_at(parsed, "url"));
    if (command == "remove") return remove(router, text_at(parsed, "name"));
    return failed(fmt::format("there is no command '{}'; there are {}", command, fmt::join(commands, ", ")));
}

Report Router::answer(std::string_view request) { return answer_request(*this, request); }

Report Router::metrics() { return report_metrics(*this); }

}  // namespace mavloom::router
