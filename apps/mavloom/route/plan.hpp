// SPDX-License-Identifier: MIT
// The plan of `mavloom route`: its options, and the endpoints of the configuration file and the command line.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "mavloom/base/result.hpp"
#include "mavloom/config/config.hpp"
#include "mavloom/config/keys.hpp"
#include "mavloom/dialect/dialect.hpp"

namespace mavloom::app {

struct RouteOptions {
    std::string fault_log;
    std::vector<std::string> endpoints;
    std::string config;
    std::string duration;
    std::string explain;  // a message's name or id; "*": all
    // The options of the configuration keys, in the order of `config_keys()`. Empty: not given.
    std::vector<std::string> keys = std::vector<std::string>(config::config_keys().size());
    // Of the keys that are flags: whether they are given. A deque, because the command line refers to its elements.
    std::deque<bool> flags = std::deque<bool>(config::config_keys().size());

    // Those as settings that take precedence over the file's.
    [[nodiscard]] std::vector<config::Override> overrides() const;
};

// The endpoints to route between: first those of the configuration file, then those of the command line. A reload
// changes only those of the file.
struct Plan {
    config::Config config;
    std::vector<endpoint::Endpoint> from_command_line;

    [[nodiscard]] std::vector<endpoint::Endpoint> endpoints() const {
        auto all = config.endpoints;
        all.insert(all.end(), from_command_line.begin(), from_command_line.end());
        if (!config.record.path.empty()) all.push_back(recording());
        return all;
    }

private:
    [[nodiscard]] endpoint::Endpoint recording() const {
        endpoint::Endpoint endpoint;
        endpoint.scheme = endpoint::Scheme::tlog;
        endpoint.path = config.record.path;
        endpoint.options.rotate_bytes = config.record.rotate_bytes;
        endpoint.options.rotate_every = config.record.rotate_every;
        return endpoint;
    }
};

// Reads the configuration file and the endpoints of the command line, and checks both.
[[nodiscard]] SetupResult<Plan> make_plan(const RouteOptions& options, const dialect::Dialect& dialect);
// Reads the configuration file again. Refuses one with which the router of the `running` plan cannot continue.
[[nodiscard]] SetupResult<config::Config> reread_config(const RouteOptions& options, const dialect::Dialect& dialect,
                                                        const Plan& running);

}  // namespace mavloom::app
