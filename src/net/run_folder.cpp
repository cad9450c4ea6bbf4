// SPDX-License-Identifier: MIT
#include "mavloom/net/run_folder.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mavloom/base/name.hpp"

namespace mavloom::net {

namespace {

std::string_view value_of(const char* variable) {
    const char* const value = std::getenv(variable);
    return value == nullptr ? std::string_view{} : value;
}

// The folders for sockets, in order of preference.
std::vector<std::filesystem::path> run_folders() {
    if (const auto only = value_of(run_variable); !only.empty()) return {only};
    std::vector<std::filesystem::path> folders{"/run/mavloom"};
    if (const auto own = value_of("XDG_RUNTIME_DIR"); own.starts_with('/'))
        folders.push_back(std::filesystem::path(own) / "mavloom");
    return folders;
}

SetupResult<void> check_name(std::string_view name) {
    if (is_name(name)) return {};
    return setup_error(SetupCode::usage, fmt::format("'{}' is not a valid name: use 1 to 64 of A-Z a-z 0-9 _ -", name));
}

}  // namespace

SetupResult<std::filesystem::path> run_path(std::string_view name, std::string_view suffix, std::string_view what) {
    constexpr std::size_t most = sizeof(sockaddr_un::sun_path) - 1;
    if (auto checked = check_name(name); !checked) return tl::unexpected(std::move(checked.error()));
    for (const auto& folder : run_folders()) {
        ::mkdir(folder.c_str(), 0755);
        if (::access(folder.c_str(), W_OK | X_OK) != 0) continue;
        auto path = folder / fmt::format("{}.{}", name, suffix);
        if (path.native().size() <= most) return path;
        return setup_error(SetupCode::permission,
                           fmt::format("{} {}: a socket's path has at most {} bytes; choose a shorter name, or "
                                       "set MAVLOOM_RUN to a shorter path",
                                       what, path.string(), most));
    }
    if (const auto only = value_of(run_variable); !only.empty())
        return setup_error(
            SetupCode::permission,
            fmt::format("no folder for the {}: {}={} cannot be created or written", what, run_variable, only));
    return setup_error(
        SetupCode::permission,
        fmt::format("no folder for the {}: neither /run/mavloom nor $XDG_RUNTIME_DIR/mavloom can be written; set {} to "
                    "a folder of yours",
                    what, run_variable));
}

std::optional<uid_t> run_folder_owner() {
    for (const auto& folder : run_folders()) {
        struct stat status {};
        if (::stat(folder.c_str(), &status) == 0 && S_ISDIR(status.st_mode)) return status.st_uid;
    }
    return std::nullopt;
}

SetupResult<LocalSender> connect_in_run_folder(std::string_view name, std::string_view suffix) {
    if (auto checked = check_name(name); !checked) return tl::unexpected(std::move(checked.error()));
    std::string paths;
    std::optional<SetupError> why_not;
    for (const auto& folder : run_folders()) {
        const auto path = folder / fmt::format("{}.{}", name, suffix);
        auto sender = LocalSender::connect(path);
        if (sender) return sender;
        if (!why_not && sender.error().code != SetupCode::not_found) why_not = std::move(sender.error());
        paths += fmt::format("{}{}", paths.empty() ? "" : " or ", path.string());
    }
    if (why_not) return tl::unexpected(std::move(*why_not));
    return setup_error(SetupCode::not_found, fmt::format("cannot send to {}: {}", paths, std::strerror(ENOENT)));
}

}  // namespace mavloom::net
