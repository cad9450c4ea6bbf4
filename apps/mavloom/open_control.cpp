// SPDX-License-Identifier: MIT
#include "open_control.hpp"

#include <fmt/format.h>

namespace mavloom::app {

SetupResult<std::unique_ptr<control::Control>> open_control(const Common& common, control::Served& served,
                                                            control::ControlOptions options, const std::string& name,
                                                            const std::string& default_name) {
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

}  // namespace mavloom::app
