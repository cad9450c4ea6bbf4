// SPDX-License-Identifier: MIT
// tcpin and tcpout: a TCP stream as a link. Private to module link; single owner thread.
#pragma once

#include <memory>
#include <string>

#include "link/core.hpp"
#include "mavloom/net/tcp.hpp"
#include "mavloom/wire/stream_parser.hpp"

namespace mavloom::link::detail {

class TcpPeer;

class TcpOwner {
public:
    virtual ~TcpOwner() = default;
    // The stream has ended. The peer is detached and may be buried.
    virtual void on_closed(TcpPeer& peer, std::string_view why) = 0;
};

// Reads once per turn, and writes the queue in as few calls as possible. What the kernel does not accept stays in the
// queue. A slow far side is never disconnected for being slow.
class TcpPeer final : public Link, public Outlet, public net::IoHandler, public Core::Ticker {
public:
    TcpPeer(Core& core, TcpOwner& owner, EndpointId endpoint_id, const net::BlockQueue::Limits& limits)
        : Link(endpoint_id, limits), core_(core), owner_(owner), parser_(core.table(endpoint_id)) {}
    ~TcpPeer() override { detach(); }

    [[nodiscard]] SetupResult<void> attach(net::TcpStream stream);
    // Closes the stream. A partly sent frame will be sent again, from its start, on the next stream.
    void detach() noexcept;
    // Delivers what the parser still holds back, then closes the stream and calls on_closed.
    void close(std::string_view why);
    // Like `close`, for an owner that calls it between turns: discards what the parser holds back.
    void drop(std::string_view why);
    [[nodiscard]] const net::TcpStream& stream() const noexcept { return stream_; }

    void schedule() override { core_.schedule(*this); }
    void on_io(net::IoEvents events) override;
    void flush() override;
    [[nodiscard]] bool blocked() const override { return blocked_; }
    void expire(MonoTime now) override { counters.queue_age.add(queue.expire(now)); }
    [[nodiscard]] std::optional<MonoTime> tick_due() const override { return parser_.deadline(); }
    void tick(MonoTime now) override;

    MonoTime last_heard{};

private:
    void read();
    [[nodiscard]] auto sink(WallTime time) {
        return [this, time](const wire::ParseEvent& event) { core_.on_event(*this, event, time); };
    }

    Core& core_;
    TcpOwner& owner_;
    net::TcpStream stream_;
    net::WatchId watch_;
    wire::StreamParser parser_;
    bool blocked_ = false;
};

[[nodiscard]] SetupResult<std::unique_ptr<OpenEndpoint>> open_tcpin(Opening opening);
[[nodiscard]] SetupResult<std::unique_ptr<OpenEndpoint>> open_tcpout(Opening opening);

}  // namespace mavloom::link::detail
