// SPDX-License-Identifier: MIT
// The asking side of control.hpp, and the names both sides go by.
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>

#include "mavloom/net/local_sender.hpp"
#include "mavloom/runtime/control.hpp"

namespace mavloom::runtime {

namespace asio = boost::asio;
using Local = asio::local::stream_protocol;
using boost::system::error_code;

bool is_router_name(std::string_view name) noexcept {
    const auto good = [](char c) {
        return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    };
    return !name.empty() && name.size() <= 64 && std::ranges::all_of(name, good);
}

// Where RUN may be; the first that serves is taken.
static std::vector<std::filesystem::path> run_folders() {
    std::vector<std::filesystem::path> folders{"/run/mavloom"};
    if (const char* own = std::getenv("XDG_RUNTIME_DIR"); own != nullptr && *own == '/')
        folders.push_back(std::filesystem::path(own) / "mavloom");
    return folders;
}

static SetupResult<void> check_name(std::string_view name) {
    if (is_router_name(name)) return {};
    return setup_error(SetupCode::usage, fmt::format("'{}' is no name: 1 to 64 of A-Z a-z 0-9 _ -", name));
}

// RUN/NAME.SUFFIX; `what` for people.
static SetupResult<std::filesystem::path> run_path(std::string_view name, std::string_view suffix,
                                                   std::string_view what) {
    constexpr std::size_t most = sizeof(sockaddr_un::sun_path) - 1;
    if (auto checked = check_name(name); !checked) return tl::unexpected(std::move(checked.error()));
    for (const auto& folder : run_folders()) {
        ::mkdir(folder.c_str(), 0755);
        if (::access(folder.c_str(), W_OK | X_OK) != 0) continue;
        auto path = folder / fmt::format("{}.{}", name, suffix);
        if (path.native().size() <= most) return path;
        return setup_error(SetupCode::permission,
                           fmt::format("{} {}: a socket's path has at most {} bytes; a shorter name or XDG_RUNTIME_DIR "
                                       "helps",
                                       what, path.string(), most));
    }
    return setup_error(
        SetupCode::permission,
        fmt::format("no folder for the {}: /run/mavloom cannot be made and XDG_RUNTIME_DIR is not set", what));
}

SetupResult<std::filesystem::path> control_path(std::string_view name) {
    return run_path(name, "ctl", "control socket");
}

SetupResult<std::filesystem::path> inlet_path(std::string_view ring) { return run_path(ring, "in", "inlet"); }

SetupResult<net::LocalSender> connect_inlet(std::string_view ring) {
    if (auto checked = check_name(ring); !checked) return tl::unexpected(std::move(checked.error()));
    std::string looked_at;
    std::optional<SetupError> why_not;
    for (const auto& folder : run_folders()) {
        const auto path = folder / fmt::format("{}.in", ring);
        auto sender = net::LocalSender::connect(path);
        if (sender) return sender;
        if (!why_not && sender.error().code != SetupCode::not_found) why_not = std::move(sender.error());
        looked_at += fmt::format("{}{}", looked_at.empty() ? "" : " or ", path.string());
    }
    if (why_not) return tl::unexpected(std::move(*why_not));
    return setup_error(SetupCode::not_found, fmt::format("cannot send to {}: {}", looked_at, std::strerror(ENOENT)));
}

namespace {

SetupResult<std::vector<std::string>> answer_of(std::string_view text) {
    std::vector<std::string> lines;
    for (std::size_t at = 0; at < text.size();) {
        const auto end = std::min(text.find('\n', at), text.size());
        lines.emplace_back(text.substr(at, end - at));
        at = end + 1;
    }
    const auto last = lines.empty() ? nlohmann::json() : nlohmann::json::parse(lines.back(), nullptr, false);
    if (!last.is_object() || !last.value("/ok"_json_pointer, nlohmann::json()).is_boolean())
        return setup_error(SetupCode::unreachable, "the router's answer was cut off");
    if (!last["ok"].get<bool>()) {
        const auto why = last.value("/error"_json_pointer, nlohmann::json());
        return setup_error(SetupCode::unreachable, why.is_string() ? why.get<std::string>() : "the router refused");
    }
    lines.pop_back();
    return lines;
}

}  // namespace

SetupResult<std::vector<std::string>> ask_router(std::string_view name, std::string_view request,
                                                 std::chrono::milliseconds limit) {
    const auto path = control_path(name);
    if (!path) return tl::unexpected(path.error());
    asio::io_context context;
    Local::socket socket(context);
    error_code error;
    socket.connect(Local::endpoint(path->string()), error);
    if (error)
        return setup_error(SetupCode::not_found, fmt::format("no router called '{}' runs here ({}: {})", name,
                                                             path->string(), error.message()));
    // The router closes behind the answer, because nothing more is asked.
    std::string input, output = std::string(request) + "\n";
    bool done = false;
    asio::async_write(
        socket, asio::buffer(output), [&](error_code e, std::size_t) {  // who turns us away may still say why
            socket.shutdown(Local::socket::shutdown_send, e);
            asio::async_read(socket, asio::dynamic_buffer(input), [&](error_code, std::size_t) { done = true; });
        });
    context.run_for(limit);
    if (!done)
        return setup_error(SetupCode::unreachable,
                           fmt::format("router '{}' gave no answer within {} ms", name, limit.count()));
    return answer_of(input);
}

}  // namespace mavloom::runtime
