// SPDX-License-Identifier: MIT
#include "plan.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <span>

#include "command.hpp"
#include "mavloom/base/shown.hpp"
#include "mavloom/router/report.hpp"
#include "mavloom/router/router.hpp"

namespace mavloom::app {

namespace {

// Reads the configuration file and applies the overrides of the command line.
SetupResult<config::Config> read_config(const RouteOptions& options, const dialect::Dialect& dialect) {
    const auto environment = config::environment_of(environ);
    const auto overrides = options.overrides();
    auto config = options.config.empty() ? config::parse_config("", "", environment, overrides)
                                         : config::load_config(options.config, environment, overrides);
    if (!config) return config;
    if (auto checked = config::check_for_router(*config, options.config, dialect); !checked)
        return tl::unexpected(std::move(checked.error()));
    return config;
}

SetupResult<void> check_recordings(std::span<const endpoint::Endpoint> endpoints) {
    std::set<std::filesystem::path> recordings;
    for (const auto& e : endpoints)
        if (e.is_recording() && !recordings.insert(endpoint::canonical_path(e.path)).second)
            return setup_error(SetupCode::usage,
                               fmt::format("another recording already writes to {}", in_quotes(e.path)));
    return {};
}

// True for `flight.tlog`, without scheme and options, if such a file exists and is not empty.
bool is_existing_flight(const std::string& text, const endpoint::Endpoint& endpoint) {
    std::error_code none;
    return endpoint.is_recording() && text == endpoint.path && std::filesystem::is_regular_file(text, none) &&
           std::filesystem::file_size(text, none) > 0;
}

// `route flight.tlog udpout://...` probably means `replay`. It would record, and rename the flight first.
SetupResult<void> check_not_replayed(std::span<const std::string> texts, const Plan& plan) {
    for (std::size_t i = 0; i < texts.size(); ++i) {
        const auto& flight = plan.from_command_line[i];
        if (!is_existing_flight(texts[i], flight)) continue;
        const auto all = plan.endpoints();
        const auto is_other = [&](const endpoint::Endpoint& e) { return e.path != flight.path; };
        const auto others = static_cast<std::size_t>(std::ranges::count_if(all, is_other));
        const auto called = std::ranges::find_if(all, &endpoint::Endpoint::calls);
        if (others == 0 || static_cast<std::size_t>(std::ranges::count_if(all, &endpoint::Endpoint::calls)) != others)
            continue;
        return setup_error(SetupCode::usage,
                           fmt::format("{0} is a recording, and route would begin a new one under its name; to send "
                                       "it, type mavloom replay {0} --to {1}; to record, tlog://{0}",
                                       shown(flight.path), called->label()));
    }
    return {};
}

}  // namespace

std::vector<config::Override> RouteOptions::overrides() const {
    std::vector<config::Override> all;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const config::ConfigKey& key = config::config_keys()[i];
        const bool is_flag = key.option.placeholder == nullptr;
        const auto value = is_flag ? std::string(flags[i] ? "true" : "") : keys[i];
        if (key.option.name != nullptr && !value.empty())
            all.push_back({key.option.name, key.section, key.name, value});
    }
    return all;
}

SetupResult<Plan> make_plan(const RouteOptions& options, const dialect::Dialect& dialect) {
    Plan plan;
    if (endpoint::parse_endpoint(options.explain))
        return setup_error(
            SetupCode::usage,
            fmt::format("--explain takes a message's name, not '{}'; put it after the endpoints", options.explain));
    for (const auto& text : options.endpoints) {
        auto endpoint = router::parse_router_endpoint(text);
        if (!endpoint) return tl::unexpected(std::move(endpoint.error()));
        plan.from_command_line.push_back(std::move(*endpoint));
    }
    auto config = read_config(options, dialect);
    if (!config) return tl::unexpected(of_input_file(std::move(config.error())));
    plan.config = std::move(*config);
    const auto endpoints = plan.endpoints();
    if (endpoints.empty())
        return setup_error(SetupCode::usage, "nothing to route between: give endpoints, or a --config with some");
    if (auto good = check_recordings(endpoints); !good) return tl::unexpected(std::move(good.error()));
    if (auto good = check_not_replayed(options.endpoints, plan); !good) return tl::unexpected(std::move(good.error()));
    return plan;
}

SetupResult<config::Config> reread_config(const RouteOptions& options, const dialect::Dialect& dialect,
                                          const Plan& running) {
    std::error_code unknown;
    const auto type = std::filesystem::status(options.config, unknown).type();
    if (type == std::filesystem::file_type::fifo || type == std::filesystem::file_type::character)
        return setup_error(SetupCode::bad_input,
                           fmt::format("{} is a pipe or a terminal, which can be read only once", options.config));
    auto config = read_config(options, dialect);
    if (!config) return config;
    const auto endpoints = Plan{*config, running.from_command_line}.endpoints();
    // An editor may have truncated the file before rewriting it.
    if (endpoints.empty() || (config->endpoints.empty() && !running.config.endpoints.empty()))
        return setup_error(SetupCode::bad_input, fmt::format("{} has no endpoint", options.config));
    if (auto agreed = router::Router::group_modes_of(endpoints); !agreed)
        return tl::unexpected(std::move(agreed.error()));
    return config;
}

}  // namespace mavloom::app
