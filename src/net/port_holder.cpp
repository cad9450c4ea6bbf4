// SPDX-License-Identifier: MIT
#include "mavloom/net/port_holder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>

#include "mavloom/base/shown.hpp"

namespace mavloom::net {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view tcp_listening = "0A";  // in /proc/net/tcp

std::string first_line(const fs::path& file) {
    std::ifstream stream(file);
    std::string line;
    std::getline(stream, line);
    return line;
}

// Adds the sockets of one line of /proc/net/udp or tcp that are bound to the port, as their links in /proc/PID/fd show
// them.
void add_socket(const std::string& line, Transport transport, std::uint16_t port, std::set<std::string>& sockets) {
    std::istringstream words(line);
    std::string number, local, remote, state, queues, timer, retransmits, user, timeout, inode;
    words >> number >> local >> remote >> state >> queues >> timer >> retransmits >> user >> timeout >> inode;
    if (transport == Transport::tcp && state != tcp_listening) return;
    if (!inode.empty() && local.ends_with(fmt::format(":{:04X}", port)))
        sockets.insert(fmt::format("socket:[{}]", inode));
}

std::set<std::string> sockets_on(Transport transport, std::uint16_t port) {
    std::set<std::string> sockets;
    for (const std::string_view family : {"", "6"}) {
        std::ifstream table(fmt::format("/proc/net/{}{}", transport == Transport::udp ? "udp" : "tcp", family));
        for (std::string line; std::getline(table, line);) add_socket(line, transport, port, sockets);
    }
    return sockets;
}

bool has_one_of(const fs::path& process, const std::set<std::string>& sockets) {
    std::error_code hidden;
    for (fs::directory_iterator fd(process / "fd", hidden), end; !hidden && fd != end; fd.increment(hidden)) {
        std::error_code closed;
        if (sockets.contains(fs::read_symlink(fd->path(), closed).string())) return true;
    }
    return false;
}

std::optional<int> process_id(const fs::path& folder) {
    const auto name = folder.filename().string();
    int id = 0;
    const auto [end, failure] = std::from_chars(name.data(), name.data() + name.size(), id);
    return failure == std::errc{} && end == name.data() + name.size() ? std::optional(id) : std::nullopt;
}

}  // namespace

std::string port_holder(Transport transport, std::uint16_t port) {
    const auto sockets = sockets_on(transport, port);
    if (sockets.empty()) return {};
    std::error_code failed;
    for (fs::directory_iterator process("/proc", failed), end; !failed && process != end; process.increment(failed)) {
        const auto id = process_id(process->path());
        if (!id || !has_one_of(process->path(), sockets)) continue;
        if (*id == ::getpid()) return "this process";
        return fmt::format("{} (process {})", printable(first_line(process->path() / "comm")), *id);
    }
    return {};
}

tl::unexpected<SetupError> bind_error(std::string_view what, int err, Transport transport, std::uint16_t port) {
    auto error = system_error(what, err);
    if (err != EADDRINUSE) return error;
    if (const auto holder = port_holder(transport, port); !holder.empty()) error.value().text += " by " + holder;
    return error;
}

}  // namespace mavloom::net
