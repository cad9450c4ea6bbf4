// SPDX-License-Identifier: MIT
#include "mavloom/net/local_sender.hpp"

#include <fmt/format.h>

#include <cassert>
#include <cerrno>
#include <charconv>
#include <cstddef>
#include <fstream>
#include <sstream>
#include <string_view>
#include <utility>

#include "mavloom/base/shown.hpp"
#include "net/unix_address.hpp"

namespace mavloom::net {

SetupResult<LocalSender> LocalSender::connect(const std::filesystem::path& path) {
    const auto far = unix_address(path);
    if (!far) return setup_error(SetupCode::usage, fmt::format("{} is too long for a socket's path", path.string()));
    Fd fd(::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (!fd) return system_error("cannot create a local socket", errno);
    sockaddr_un own{};  // no name: the kernel assigns a free abstract address, without a file
    own.sun_family = AF_UNIX;
    if (::bind(fd.get(), as_sockaddr(own), sizeof own.sun_family) != 0)
        return system_error("cannot bind a local socket", errno);
    if (::connect(fd.get(), as_sockaddr(*far), sizeof *far) != 0)
        return system_error(fmt::format("cannot send to {}", path.string()), errno);
    return LocalSender(std::move(fd));
}

std::string LocalSender::own_address() const {
    sockaddr_un own{};
    socklen_t length = sizeof own;
    constexpr std::size_t before = offsetof(sockaddr_un, sun_path) + 1;  // skips the NUL of an abstract name
    if (::getsockname(fd_.get(), reinterpret_cast<sockaddr*>(&own), &length) != 0 || length <= before) return {};
    return fmt::format("@{}", printable(std::string_view(own.sun_path + 1, length - before)));
}

IoResult<std::size_t> LocalSender::send(SendBatch& batch, std::size_t first) noexcept {
    assert(first < batch.size());
    const auto left = static_cast<unsigned>(batch.size() - first);
    const int count = ::sendmmsg(fd_.get(), batch.messages_.data() + first, left, MSG_NOSIGNAL);
    if (count < 0) return tl::unexpected(io_error_of(errno));
    return static_cast<std::size_t>(count);
}

// Reads /proc/net/unix. Columns: "Num RefCount Protocol Flags Type St Inode Path", after a heading line.
static std::string inode_of_socket(const std::filesystem::path& path) {
    std::ifstream sockets("/proc/net/unix");
    for (std::string line; std::getline(sockets, line);) {
        std::istringstream words(line);
        std::string word, inode, at;
        for (int i = 0; i < 6; ++i) words >> word;
        if (words >> inode && words >> std::ws && std::getline(words, at) && at == path.native()) return inode;
    }
    return {};
}

static bool has_open(const std::filesystem::path& process, const std::string& target) {
    std::error_code none;
    for (const auto& fd : std::filesystem::directory_iterator(process / "fd", none))
        if (std::filesystem::read_symlink(fd.path(), none) == target) return true;
    return false;
}

std::optional<int> process_serving(const std::filesystem::path& path) {
    const auto inode = inode_of_socket(path);
    if (inode.empty()) return std::nullopt;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator("/proc", none)) {
        int pid = 0;
        const auto name = entry.path().filename().string();
        const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), pid);
        const bool is_process = error == std::errc{} && end == name.data() + name.size();
        if (is_process && has_open(entry.path(), fmt::format("socket:[{}]", inode))) return pid;
    }
    return std::nullopt;
}

}  // namespace mavloom::net
