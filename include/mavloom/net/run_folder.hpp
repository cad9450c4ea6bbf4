// SPDX-License-Identifier: MIT
// Finds the folder for the Unix sockets through which local programs communicate.
//
// The folder is $MAVLOOM_RUN if set. Otherwise it is /run/mavloom if that can be created, else
// $XDG_RUNTIME_DIR/mavloom. Any thread may call these functions, as long as no thread changes the environment.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string_view>

#include "mavloom/base/result.hpp"
#include "mavloom/net/local_sender.hpp"

namespace mavloom::net {

inline constexpr const char* run_variable = "MAVLOOM_RUN";

// Returns the path at which a program creates its socket NAME.SUFFIX. Creates the folder if necessary. `what` is the
// name of the socket in error texts. Errors: `usage` for an invalid name; `permission` if there is no folder or the
// path is too long for a socket.
[[nodiscard]] SetupResult<std::filesystem::path> run_path(std::string_view name, std::string_view suffix,
                                                          std::string_view what);

// Connects to the first socket NAME.SUFFIX that a program of any user serves. Looks in $MAVLOOM_RUN if set, otherwise
// in both other folders. If none is served, returns the reason why an existing socket cannot be used, or `not_found` if
// there is no socket. Creates nothing.
[[nodiscard]] SetupResult<LocalSender> connect_in_run_folder(std::string_view name, std::string_view suffix);

// Returns the owner of the first existing folder in which `connect_in_run_folder` looks. Empty if none exists; creates
// nothing.
[[nodiscard]] std::optional<uid_t> run_folder_owner();

}  // namespace mavloom::net
