// SPDX-License-Identifier: MIT
#include "top/routes.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <tuple>

namespace mavloom::app {

namespace {

bool is_up_to(const nlohmann::json& object, const char* name, std::uint64_t most) {
    const auto at = object.find(name);
    return at != object.end() && at->is_number_unsigned() && at->get<std::uint64_t>() <= most;
}

// Longer ones are none, and would not fit into nanoseconds.
bool is_age(const nlohmann::json& seconds) {
    return seconds.is_number() && seconds.get<double>() >= 0 && seconds.get<double>() <= 1e9;
}

bool is_route(const nlohmann::json& json) {
    return json.is_object() && is_up_to(json, "sys", 255) && is_up_to(json, "comp", 255) &&
           is_up_to(json, "frames", UINT64_MAX) && json.contains("link") && json["link"].is_string() &&
           is_age(json.value("age_s", nlohmann::json()));
}

view::Route route_of(const std::string& router, const std::string& line) {
    const auto json = nlohmann::json::parse(line, nullptr, false);
    if (!is_route(json)) return {.router = router, .error = "the router's answer is not understood"};
    return {.router = router,
            .source = {SystemId{json["sys"].get<std::uint8_t>()}, ComponentId{json["comp"].get<std::uint8_t>()}},
            .link = json["link"].get<std::string>(),
            .age = std::chrono::duration_cast<Nanoseconds>(std::chrono::duration<double>(json["age_s"].get<double>())),
            .frames = json["frames"].get<std::uint64_t>()};
}

}  // namespace

std::vector<view::Route> routes_to_show(std::span<const web::RoutesOf> routers) {
    std::vector<view::Route> all;
    for (const auto& router : routers) {
        if (!router.error.empty()) all.push_back({.router = router.router, .error = router.error});
        for (const auto& line : router.routes) all.push_back(route_of(router.router, line));
    }
    std::ranges::stable_sort(all, {}, [](const auto& route) { return std::tuple(route.router, route.source); });
    return all;
}

}  // namespace mavloom::app
