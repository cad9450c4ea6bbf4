// SPDX-License-Identifier: MIT
#include "open_control.hpp"

#include <fmt/format.h>

#include <utility>

namespace mavloom::app {

using Opened = SetupResult<std::unique_ptr<control::Control>>;

static Opened open_socket_and_port(const Common& common, control::Served& served, control::ControlOptions options,
                                   const std::string& name, const std::string& default_name) {
    auto path = control::control_path(name.empty() ? default_name : name);
    if (path) options.socket = *path;
    else if (!name.empty()) return tl::unexpected(std::move(path.error()));
    else print_notice(common, path.error().text);
    auto opened = control::Control::create(served, options);
    if (opened || !name.empty() || opened.error().code != SetupCode::in_use) return opened;
    options.socket.clear();
    auto without = control::Control::create(served, options);  // fails again if the port of --metrics was in use
    if (without) print_notice(common, fmt::format("no control socket: {}", opened.error().text));
    return without;
}

Opened open_control(const Common& common, control::Served& served, control::ControlOptions options,
                    const std::string& name, const std::string& default_name) {
    const bool any_port = options.metrics && options.metrics->port == 0;
    auto opened = open_socket_and_port(common, served, std::move(options), name, default_name);
    if (opened && any_port) print_notice(common, fmt::format("metrics on port {}", (*opened)->metrics_port()));
    return opened;
}

}  // namespace mavloom::app
