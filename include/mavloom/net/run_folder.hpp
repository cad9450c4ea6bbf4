// SPDX-License-Identifier: MIT
// The folder of the sockets by which programs of this machine meet: $MAVLOOM_RUN where that is set, else /run/mavloom where it can be made, else
// $XDG_RUNTIME_DIR/mavloom. Any thread, as long as none changes the environment.
#pragma once

#include <filesystem>
#include <string_view>

#include "mavloom/base/result.hpp"
#include "mavloom/net/local_sender.hpp"

namespace mavloom::net {

inline constexpr const char* run_variable = "MAVLOOM_RUN";

// Where a program makes its socket NAME.SUFFIX; makes the folder where it is missing. `what` it is, for errors. Errors: a name that is none
// (`usage`), no folder, a path too long for a socket (`permission`).
[[nodiscard]] SetupResult<std::filesystem::path> run_path(std::string_view name, std::string_view suffix,
                                                          std::string_view what);

// For a sender, whichever user's program serves there: the first NAME.SUFFIX of these folders that is served, else why one that is there cannot be sent
// to, else `not_found`; makes nothing.
[[nodiscard]] SetupResult<LocalSender> connect_in_run_folder(std::string_view name, std::string_view suffix);

}  // namespace mavloom::net
