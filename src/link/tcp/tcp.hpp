// SPDX-License-Identifier: MIT
// tcpin and tcpout: a stream as a link. Private to module link; one owner thread.
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
    // The stream has ended; the peer is detached and may be buried.
    virtual void on_closed(TcpPeer& peer, std::string_view why) = 0;
};

// Reads once a turn and writes what is queued with one call a turn. What the kernel will not take waits in the queue: a slow far side is
// never disconnected for being slow.
class TcpPeer final : public Link, public Outlet, public net::IoHandler, public Core::Ticker {
public:
    TcpPeer(Core& core, TcpOwner& owner, EndpointId endpoint_id, const net::BlockQueue::Limits& limits)
        : Link(endpoint_id, limits), core_(core), owner_(owner), parser_(core.table(endpoint_id)) {}
    ~TcpPeer() override { detach(); }

    [[nodiscard]] SetupResult<void> attach(net::TcpStream stream);
    // Ends the stream. A frame of which a part was sent will be sent again, from its start, on the next one.
    void detach() noexcept;
    void close(std::string_view why);
    // The same for an owner that closes it between two turns: what the parser held back is not handed over.
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
