// SPDX-License-Identifier: MIT
#include "plan.hpp"

#include <fmt/format.h>
#include <unistd.h>

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
    auto config = options.config.empty() ? config::parse_config("", "", environment)
                                         : config::load_config(options.config, environment);
    if (!config) return config;
    if (!options.ring.empty()) config->ring.name = options.ring;
    if (auto checked = config::check_for_router(*config, options.config, dialect); !checked)
        return tl::unexpected(std::move(checked.error()));
    return config;
}

SetupResult<void> check_recordings(std::span<const endpoint::Endpoint> endpoints) {
    std::set<std::filesystem::path> recordings;
    for (const auto& e : endpoints)
        if (e.scheme == endpoint::Scheme::tlog && !recordings.insert(endpoint::canonical_path(e.path)).second)
            return setup_error(SetupCode::usage,
                               fmt::format("another recording already writes to {}", in_quotes(e.path)));
    return {};
}

}  // namespace

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
