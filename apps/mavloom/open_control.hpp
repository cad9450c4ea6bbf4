// SPDX-License-Identifier: MIT
// Opens the control socket and the metrics port of a router or a simulator.
#pragma once

#include <memory>
#include <string>

#include "command.hpp"
#include "mavloom/control/control.hpp"

namespace mavloom::app {

// `name` is that of --name. If it is empty, the program gets the default name. It then starts without a control socket
// if another program already has that name, which `ctl` then reaches, or if there is no folder for sockets. The name
// decides the path of the socket; `options.socket` is ignored. If the port of the metrics is 0, prints the port that
// the kernel chose.
[[nodiscard]] SetupResult<std::unique_ptr<control::Control>> open_control(const Common& common, control::Served& served,
                                                                          control::ControlOptions options,
                                                                          const std::string& name,
                                                                          const std::string& default_name);

}  // namespace mavloom::app
