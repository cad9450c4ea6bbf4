// SPDX-License-Identifier: MIT
// Generates the load of `bench listen`: sends recorded frames to a UDP port at a steady rate, in batches by sendmmsg,
// with as little work per frame as possible. Prints how many frames it sent, and how long it took.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t batch = 64;

// Returns the frames of an undamaged tlog, split by their own length bytes.
std::vector<std::vector<char>> frames_of(const char* path) {
    std::ifstream in(path, std::ios::binary);
    const std::vector<char> file{std::istreambuf_iterator<char>(in), {}};
    std::vector<std::vector<char>> frames;
    for (std::size_t at = 8; at + 3 < file.size();) {
        const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(file[at + i]); };
        const std::size_t size = byte(1) + (byte(0) == 0xfd ? 12u + 13u * (byte(2) & 1u) : 8u);
        frames.emplace_back(file.begin() + static_cast<std::ptrdiff_t>(at),
                            file.begin() + static_cast<std::ptrdiff_t>(at + size));
        at += size + 8;
    }
    return frames;
}

int connect_to(const char* host, const char* port) {
    const int fd = ::socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(std::atoi(port)));
    ::inet_pton(AF_INET, host, &address.sin_addr);
    const int size = 8 << 20;
    ::setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &size, sizeof size);
    return ::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ? fd : -1;
}

// Sends all messages of the batch. Waits if the send buffer is full, because the load must not lose frames itself.
void send_all(int fd, mmsghdr* messages, std::size_t count) {
    while (count != 0) {
        const int sent = ::sendmmsg(fd, messages, static_cast<unsigned>(count), 0);
        if (sent > 0) {
            messages += sent;
            count -= static_cast<std::size_t>(sent);
        } else if (errno != ENOBUFS && errno != EAGAIN && errno != EINTR && errno != ECONNREFUSED) {
            return;
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 6) {
        fmt::print(stderr, "usage: load_bench HOST PORT FILE.tlog FRAMES_PER_SECOND SECONDS [FRAMES_PER_DATAGRAM]\n");
        return 2;
    }
    const auto frames = frames_of(argv[3]);
    const double rate = std::atof(argv[4]), seconds = std::atof(argv[5]);
    const std::size_t gathered = argc > 6 ? static_cast<std::size_t>(std::atoi(argv[6])) : 1;
    const int fd = connect_to(argv[1], argv[2]);
    if (frames.empty() || fd < 0 || rate <= 0 || gathered == 0 || gathered > 64) return 1;

    std::array<mmsghdr, batch> messages{};
    std::vector<iovec> parts(batch * gathered);
    const auto total = static_cast<std::uint64_t>(rate * seconds);
    std::uint64_t sent = 0;
    const auto begin = Clock::now();
    while (sent < total) {
        const auto due = static_cast<std::uint64_t>(rate * std::chrono::duration<double>(Clock::now() - begin).count());
        if (due <= sent) {
            std::this_thread::sleep_for(std::chrono::microseconds(100));
            continue;
        }
        std::size_t datagrams = 0;
        for (; datagrams < batch && sent < std::min(due, total); ++datagrams) {
            auto& header = messages[datagrams].msg_hdr;
            header.msg_iov = &parts[datagrams * gathered];
            header.msg_iovlen = 0;
            for (; header.msg_iovlen < gathered && sent < total; ++sent) {
                const auto& frame = frames[sent % frames.size()];
                header.msg_iov[header.msg_iovlen++] = {const_cast<char*>(frame.data()), frame.size()};
            }
        }
        send_all(fd, messages.data(), datagrams);
    }
    const double took = std::chrono::duration<double>(Clock::now() - begin).count();
    fmt::print("{{\"sent\":{},\"seconds\":{:.3f},\"rate\":{:.0f}}}\n", sent, took, static_cast<double>(sent) / took);
}
