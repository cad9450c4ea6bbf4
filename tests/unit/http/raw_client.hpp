// SPDX-License-Identifier: MIT
// A TCP client that sends any bytes, and reads what a server answers.
#pragma once

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <string>
#include <string_view>
#include <utility>

#include "mavloom/base/bytes.hpp"
#include "mavloom/net/address.hpp"
#include "mavloom/net/tcp.hpp"

namespace mavloom::http {

inline const net::Address any_port = *net::Address::parse("127.0.0.1", 0);

inline ByteView bytes_of(std::string_view text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}
// RFC 6455, section 5.7: "Hello" as text, masked.
inline const std::string masked_hello("\x81\x85\x37\xfa\x21\x3d\x7f\x9f\x4d\x51\x58", 11);

class RawClient {
public:
    explicit RawClient(const net::Address& server) : stream_(std::move(*net::TcpStream::start_connect(server))) {
        EXPECT_TRUE(stream_.wait_connected(std::chrono::seconds(5)));
        EXPECT_TRUE(stream_.finish_connect());
    }

    void send(std::string_view bytes) {
        while (!bytes.empty()) {
            const ssize_t sent = ::send(stream_.fd(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
            if (sent > 0) bytes.remove_prefix(static_cast<std::size_t>(sent));
            else if (errno != EAGAIN || !await(POLLOUT)) return;
        }
    }
    // Reads until the text ends with `end`, or, if that is empty, until the server closes the connection.
    std::string read_until(std::string_view end = {}) {
        std::array<char, 4096> room{};
        while (!is_closed && (end.empty() || !text_.ends_with(end))) {
            if (!await(POLLIN)) break;
            const ssize_t size = ::recv(stream_.fd(), room.data(), end.empty() ? room.size() : 1, 0);
            if (size <= 0) is_closed = true;
            else text_.append(room.data(), static_cast<std::size_t>(size));
        }
        return std::exchange(text_, {});
    }
    std::string read_bytes(std::size_t count) {
        while (!is_closed && text_.size() < count && await(POLLIN)) {
            std::array<char, 4096> room{};
            const ssize_t size = ::recv(stream_.fd(), room.data(), std::min(room.size(), count - text_.size()), 0);
            if (size <= 0) is_closed = true;
            else text_.append(room.data(), static_cast<std::size_t>(size));
        }
        return std::exchange(text_, {});
    }
    // The code of the close frame that comes next, which must have a reason.
    int read_close() {
        const auto head = read_bytes(4);
        EXPECT_EQ(head.substr(0, 1), "\x88");
        EXPECT_EQ(read_bytes(static_cast<std::size_t>(head.at(1)) - 2).size() + 2, static_cast<std::size_t>(head[1]));
        EXPECT_GT(head[1], 2);
        return static_cast<unsigned char>(head[2]) << 8 | static_cast<unsigned char>(head[3]);
    }
    [[nodiscard]] int fd() const { return stream_.fd(); }

    bool is_closed = false;  // by the server, as far as it was read

private:
    [[nodiscard]] bool await(short events) const {
        pollfd wanted{stream_.fd(), events, 0};
        return ::poll(&wanted, 1, 10'000) == 1;
    }

    net::TcpStream stream_;
    std::string text_;
};

}  // namespace mavloom::http
