// SPDX-License-Identifier: MIT
#include "mavloom/net/port_holder.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
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

// An address of the tables, such as 0100007F:1F90: the 32-bit words of the address in the order of the machine, and the
// port.
std::optional<Address> listed_address(std::string_view text) {
    constexpr std::size_t digits = 8;
    const auto number = [](std::string_view hex) {
        std::uint32_t value = 0;
        std::from_chars(hex.data(), hex.data() + hex.size(), value, 16);
        return value;
    };
    const auto colon = text.find(':');
    if (colon != digits && colon != 4 * digits) return std::nullopt;
    std::array<std::uint32_t, 4> words{};
    for (std::size_t i = 0; i < colon / digits; ++i) words[i] = number(text.substr(i * digits, digits));
    std::array<char, INET6_ADDRSTRLEN> host{};
    ::inet_ntop(colon == digits ? AF_INET : AF_INET6, words.data(), host.data(), host.size());
    return Address::parse(host.data(), static_cast<std::uint16_t>(number(text.substr(colon + 1))));
}

// A socket on 0.0.0.0 has the port of every IPv4 address; one on :: usually has it of both families.
bool has_all_of(const Address& any, const Address& other) { return any.is_any() && (any.is_v6() || other.is_v4()); }

bool conflict(const Address& listed, const Address& wanted) {
    const auto a = listed.with_scope(0).unmapped(), b = wanted.with_scope(0).unmapped();
    return a.port() == b.port() && (a == b || has_all_of(a, b) || has_all_of(b, a));
}

// Adds the socket of one line of /proc/net/udp or tcp if it holds the address, as its link in /proc/PID/fd shows it.
void add_socket(const std::string& line, Transport transport, const Address& wanted, std::set<std::string>& sockets) {
    std::istringstream words(line);
    std::string number, local, remote, state, queues, timer, retransmits, user, timeout, inode;
    words >> number >> local >> remote >> state >> queues >> timer >> retransmits >> user >> timeout >> inode;
    if (transport == Transport::tcp && state != tcp_listening) return;
    const auto listed = listed_address(local);
    if (!inode.empty() && listed && conflict(*listed, wanted)) sockets.insert(fmt::format("socket:[{}]", inode));
}

std::set<std::string> sockets_on(Transport transport, const Address& local) {
    std::set<std::string> sockets;
    for (const std::string_view family : {"", "6"}) {
        std::ifstream table(fmt::format("/proc/net/{}{}", transport == Transport::udp ? "udp" : "tcp", family));
        for (std::string line; std::getline(table, line);) add_socket(line, transport, local, sockets);
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

std::string port_holder(Transport transport, const Address& local) {
    const auto sockets = sockets_on(transport, local);
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

tl::unexpected<SetupError> BindErrors::complete(SetupError error, const Address& local) {
    if (error.sys_errno != EADDRINUSE) return tl::unexpected(std::move(error));
    if (searched_ != local) {
        searched_ = local;
        holder_ = port_holder(transport_, local);
    }
    if (!holder_.empty()) error.text += " by " + holder_;
    return tl::unexpected(std::move(error));
}

}  // namespace mavloom::net
