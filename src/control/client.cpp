// SPDX-License-Identifier: MIT
// The client side of control.hpp: finds a program's control socket and sends it a request.
#include <fmt/format.h>
#include <sys/socket.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <cerrno>
#include <nlohmann/json.hpp>
#include <optional>

#include "mavloom/control/control.hpp"
#include "mavloom/net/run_folder.hpp"

namespace mavloom::control {

namespace asio = boost::asio;
using Local = asio::local::stream_protocol;
using boost::system::error_code;

SetupResult<std::filesystem::path> control_path(std::string_view name) {
    return net::run_path(name, "ctl", "control socket");
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
        return setup_error(SetupCode::unreachable, "the answer was cut off");
    if (!last["ok"].get<bool>()) {
        const auto why = last.value("/error"_json_pointer, nlohmann::json());
        return setup_error(SetupCode::unreachable, why.is_string() ? why.get<std::string>() : "the request was refused");
    }
    lines.pop_back();
    return lines;
}

// The answer of a program, or the error of the connection. Without both, there was no answer in time.
struct Exchange {
    std::optional<std::string> answer;
    error_code error;
};

// The client shuts down its sending side, so the program closes the connection after the answer.
Exchange exchange(const std::filesystem::path& path, std::string_view request, std::chrono::milliseconds limit) {
    asio::io_context context;
    Local::socket socket(context);
    Exchange done;
    socket.connect(Local::endpoint(path.string()), done.error);
    if (done.error) return done;
    std::string input, output = std::string(request) + "\n";
    // Read even if the write failed: a program that turns a client away may still send the reason.
    asio::async_write(socket, asio::buffer(output), [&](error_code e, std::size_t) {
        socket.shutdown(Local::socket::shutdown_send, e);
        asio::async_read(socket, asio::dynamic_buffer(input), [&](error_code, std::size_t) { done.answer = input; });
    });
    context.run_for(limit);
    return done;
}

enum class Presence : std::uint8_t { absent, busy, here };

// A program that is busy may not accept now; this does not wait for it.
Presence presence_of(const std::filesystem::path& path) {
    asio::io_context context;
    Local::socket socket(context);
    error_code error;
    socket.open(Local(), error);
    if (!error) socket.non_blocking(true, error);
    if (error) return Presence::absent;
    const Local::endpoint to(path.string());
    if (::connect(socket.native_handle(), to.data(), static_cast<socklen_t>(to.size())) == 0) return Presence::here;
    return errno == EAGAIN ? Presence::busy : Presence::absent;
}

// Only a simulator knows the request. A program that turns clients away may be either.
std::string_view kind_of(const std::filesystem::path& path, Presence presence) {
    constexpr std::chrono::milliseconds limit{300};
    if (presence == Presence::busy) return "busy";
    const auto done = exchange(path, R"({"cmd":"state"})", limit);
    if (!done.answer) return "busy";
    const auto lines = answer_of(*done.answer);
    if (lines) return "simulator";
    return lines.error().text.starts_with("there is no command") ? "router" : "busy";
}

// The programs whose control sockets are in the folder.
std::vector<std::string> programs_in(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    std::error_code failed;
    for (std::filesystem::directory_iterator file(folder, failed), end; !failed && file != end; file.increment(failed))
        if (const auto& path = file->path(); path.extension() == ".ctl")
            if (const auto presence = presence_of(path); presence != Presence::absent)
                names.push_back(fmt::format("{} ({})", path.stem().string(), kind_of(path, presence)));
    std::ranges::sort(names);
    return names;
}

SetupError no_program(std::string_view name, const std::filesystem::path& path, const error_code& error) {
    const auto others = programs_in(path.parent_path());
    const auto hint = others.empty() ? std::string() : fmt::format("; running: {}", fmt::join(others, ", "));
    return {SetupCode::not_found, 0,
            fmt::format("no router or simulator called '{}' runs here ({}: {}){}", name, path.string(), error.message(),
                        hint)};
}

}  // namespace

std::vector<std::string> running_programs() {
    const auto path = control_path("any");
    return path ? programs_in(path->parent_path()) : std::vector<std::string>();
}

SetupResult<std::vector<std::string>> send_request(std::string_view name, std::string_view request,
                                                   std::chrono::milliseconds limit) {
    const auto path = control_path(name);
    if (!path) return tl::unexpected(path.error());
    const auto done = exchange(*path, request, limit);
    if (done.error) return tl::unexpected(no_program(name, *path, done.error));
    if (!done.answer)
        return setup_error(SetupCode::unreachable, fmt::format("'{}' did not answer within {} ms", name, limit.count()));
    return answer_of(*done.answer);
}

}  // namespace mavloom::control
