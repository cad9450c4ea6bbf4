// SPDX-License-Identifier: MIT
// A TCP connection on loopback that carries MAVLink, for both programs of `bench hil`.
#pragma once

#include <all/mavlink.h>
#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdlib>

namespace hil_bench {

inline sockaddr_in loopback(const char* port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(std::atoi(port)));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
}

class Connection {
public:
    explicit Connection(int fd) : fd_(fd) {
        const int on = 1;
        ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    }
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;
    ~Connection() { ::close(fd_); }

    // Packs frames into one write.
    void add(const mavlink_message_t& message) {
        if (size_ + MAVLINK_MAX_PACKET_LEN > out_.size()) flush();
        size_ += mavlink_msg_to_send_buffer(out_.data() + size_, &message);
    }
    bool flush() {
        const bool sent = ::send(fd_, out_.data(), size_, MSG_NOSIGNAL) == static_cast<ssize_t>(size_);
        size_ = 0;
        return sent;
    }
    // Return whether something may be read within this time; a negative time waits for ever.
    [[nodiscard]] bool is_ready(int milliseconds) const {
        pollfd one{.fd = fd_, .events = POLLIN, .revents = 0};
        return ::poll(&one, 1, milliseconds) > 0;
    }
    // Reads once, and calls `take` with each message. Returns false if the peer is gone.
    template <class Take>
    bool read(Take&& take) {
        std::array<std::uint8_t, 4096> bytes;
        const ssize_t count = ::recv(fd_, bytes.data(), bytes.size(), 0);
        if (count <= 0) return false;
        mavlink_message_t message{};
        for (ssize_t i = 0; i < count; ++i)
            if (mavlink_frame_char_buffer(&buffer_, &status_, bytes[static_cast<std::size_t>(i)], &message, nullptr) ==
                MAVLINK_FRAMING_OK)
                take(message);
        return true;
    }

private:
    int fd_;
    std::array<std::uint8_t, 4096> out_{};
    std::size_t size_ = 0;
    mavlink_message_t buffer_{};
    mavlink_status_t status_{};
};

}  // namespace hil_bench
