// SPDX-License-Identifier: MIT
// What the tests of Links share: a small message table, frames, handlers that remember, plain sockets, and waiting for
// a condition.
#pragma once

#include <arpa/inet.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/wire/frame_writer.hpp"
#include "mavloom/wire/stream_parser.hpp"

namespace mavloom::link::testing {

using Bytes = std::vector<std::uint8_t>;

// Ids, checksum seeds and lengths as common.xml gives them.
inline const wire::MessageTable& table() {
    static constexpr wire::MessageInfo messages[] = {
        {MessageId{0}, 50, 9, 9},              // HEARTBEAT
        {MessageId{4}, 237, 14, 14, 12, 13},   // PING
        {MessageId{30}, 39, 28, 28},           // ATTITUDE
        {MessageId{76}, 152, 33, 33, 30, 31},  // COMMAND_LONG
        {MessageId{131}, 223, 255, 255},       // ENCAPSULATED_DATA
        {MessageId{253}, 83, 51, 54},          // STATUSTEXT
    };
    static const wire::MessageTable it{messages};
    return it;
}

inline Bytes frame_bytes(std::uint32_t id, std::uint8_t sequence, Bytes payload = {}, std::uint8_t system = 1) {
    const wire::MessageInfo& info = *table().find(MessageId{id});
    payload.resize(info.max_length, 0x5a);
    wire::FrameBuffer buffer;
    const auto frame = wire::write_frame(buffer, {wire::Version::v2, sequence, {SystemId{system}, ComponentId{1}}},
                                         info, payload);
    return {frame.bytes().begin(), frame.bytes().end()};
}
inline Bytes heartbeat(std::uint8_t sequence, std::uint8_t system = 1) { return frame_bytes(0, sequence, {}, system); }
inline Bytes attitude(std::uint8_t sequence, std::uint8_t system = 1) { return frame_bytes(30, sequence, {}, system); }
inline wire::FrameView view(const Bytes& bytes) { return wire::FrameView::unchecked(bytes); }
inline Bytes operator+(Bytes a, const Bytes& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

inline endpoint::Endpoint endpoint_of(const std::string& url) {
    auto endpoint = endpoint::parse_endpoint(url);
    EXPECT_TRUE(endpoint) << url << ": " << (endpoint ? "" : endpoint.error().text);
    return endpoint ? *std::move(endpoint) : endpoint::Endpoint{};
}

class Recorder : public LinkHandler {
public:
    struct Heard {
        LinkId link;
        Bytes bytes;
        WallTime time;
    };
    void on_frame(const RxFrame& rx) override {
        frames.push_back({rx.link, {rx.frame.bytes().begin(), rx.frame.bytes().end()}, rx.time});
        if (answer) answer(rx);
    }
    void on_link_up(LinkId id, EndpointId, std::string_view name) override { ups.emplace_back(id, name); }
    void on_link_down(LinkId id, EndpointId, std::string_view why) override { downs.emplace_back(id, why); }
    void on_notice(EndpointId, std::string_view text) override { notices.emplace_back(text); }

    [[nodiscard]] Bytes bytes() const {
        Bytes all;
        for (const Heard& heard : frames) all = std::move(all) + heard.bytes;
        return all;
    }

    std::vector<Heard> frames;
    std::vector<std::pair<LinkId, std::string>> ups, downs;
    std::vector<std::string> notices;
    std::function<void(const RxFrame&)> answer;
};

// One Links with its handler.
struct Node {
    Node() : links(std::move(*Links::create(dialect::default_dialect()))) {}
    EndpointId add(const std::string& url) {
        auto id = links->add(endpoint_of(url));
        EXPECT_TRUE(id) << url << ": " << (id ? "" : id.error().text);
        return id.value_or(EndpointId{});
    }
    [[nodiscard]] SetupError refused(const std::string& url) {
        auto id = links->add(endpoint_of(url));
        EXPECT_FALSE(id) << url;
        return id ? SetupError{} : id.error();
    }
    [[nodiscard]] EndpointInfo info(EndpointId id) const {
        for (const auto& e : links->endpoints())
            if (e.id == id) return e;
        return {};
    }
    [[nodiscard]] std::uint16_t port(EndpointId id) const { return info(id).local_port; }
    [[nodiscard]] const LinkCounters& counters(LinkId id) const {
        static const LinkCounters none;
        const LinkCounters* const found = links->counters(id);
        return found == nullptr ? none : *found;
    }
    void poll() { links->turn(recorder, mono_now()); }

    std::unique_ptr<Links> links;
    Recorder recorder;
};

// Turns all nodes until `condition` holds; false when it does not within a minute.
template <class Condition, class... Nodes>
[[nodiscard]] bool until(Condition&& condition, Nodes&... nodes) {
    const MonoTime deadline = mono_now() + std::chrono::seconds(60);
    while (!condition()) {
        if (mono_now() > deadline) return false;
        (nodes.links->turn(nodes.recorder, mono_now() + std::chrono::milliseconds(1)), ...);
    }
    return true;
}

// A socket that knows nothing of ours.
class PlainSocket {
public:
    explicit PlainSocket(int type, std::uint16_t port = 0, std::uint32_t host = INADDR_LOOPBACK)
        : fd_(::socket(AF_INET, type, 0)) {
        bind_to(host, port);
    }
    static PlainSocket udp(std::uint16_t port = 0) { return PlainSocket(SOCK_DGRAM, port); }
    static PlainSocket connected_tcp(std::uint16_t port, int receive_buffer = 0, std::uint32_t from = INADDR_LOOPBACK) {
        PlainSocket s(SOCK_STREAM, 0, from);
        if (receive_buffer != 0) setsockopt(s.fd(), SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
        sockaddr_in to = loopback(port);
        EXPECT_EQ(::connect(s.fd(), reinterpret_cast<sockaddr*>(&to), sizeof to), 0);
        return s;
    }
    PlainSocket(PlainSocket&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    ~PlainSocket() { close(); }
    void close() {
        if (fd_ >= 0) ::close(std::exchange(fd_, -1));
    }
    [[nodiscard]] int fd() const { return fd_; }
    static sockaddr_in loopback(std::uint16_t port) {
        sockaddr_in a{};
        a.sin_family = AF_INET;
        a.sin_port = htons(port);
        a.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        return a;
    }
    [[nodiscard]] std::uint16_t port() const {
        sockaddr_in a{};
        socklen_t length = sizeof a;
        getsockname(fd_, reinterpret_cast<sockaddr*>(&a), &length);
        return ntohs(a.sin_port);
    }
    void send_to(std::uint16_t port, const Bytes& bytes) const {
        sockaddr_in to = loopback(port);
        EXPECT_EQ(::sendto(fd_, bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&to), sizeof to),
                  static_cast<ssize_t>(bytes.size()));
    }
    void write(const Bytes& bytes) const {
        EXPECT_EQ(::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL), static_cast<ssize_t>(bytes.size()));
    }
    // Empty when there is nothing now (or the stream has ended).
    [[nodiscard]] Bytes read() const {
        Bytes bytes(65536);
        const ssize_t count = ::recv(fd_, bytes.data(), bytes.size(), MSG_DONTWAIT);
        bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
        return bytes;
    }

private:
    void bind_to(std::uint32_t host, std::uint16_t port) const {
        sockaddr_in a = loopback(port);
        a.sin_addr.s_addr = htonl(host);
        EXPECT_EQ(::bind(fd_, reinterpret_cast<sockaddr*>(&a), sizeof a), 0);
    }
    int fd_;
};

}  // namespace mavloom::link::testing
