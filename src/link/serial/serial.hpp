// SPDX-License-Identifier: MIT
// serial: a serial port as a link. Private to module link; single owner thread.
#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "link/core.hpp"
#include "link/serial/pacer.hpp"
#include "mavloom/net/serial.hpp"
#include "mavloom/wire/stream_parser.hpp"

namespace mavloom::link::detail {

class SerialOwner {
public:
    virtual ~SerialOwner() = default;
    // A frame of a defined message with a good checksum: the baud rate is right. Called before the frame's handler.
    virtual void on_good_frame() = 0;
    // The port is gone; the peer is already detached.
    virtual void on_gone(std::string_view why) = 0;
};

// Reads once per turn. Keeps at most 50 ms of data in the driver; the rest waits in the queue, where it can expire.
class SerialPeer final : public Link, public Outlet, public net::IoHandler, public net::TimerHandler, public Core::Ticker {
public:
    SerialPeer(Core& core, SerialOwner& owner, EndpointId endpoint_id, const net::BlockQueue::Limits& limits)
        : Link(endpoint_id, limits), core_(core), owner_(owner), parser_(core.table(endpoint_id)) {}
    ~SerialPeer() override { detach(); }

    [[nodiscard]] SetupResult<void> attach(net::SerialPort port);
    // Releases the port. A partly sent frame will be sent again from its start.
    void detach() noexcept;
    void close(std::string_view why);
    [[nodiscard]] const net::SerialPort& port() const noexcept { return port_; }
    // Returns false if the port is gone.
    [[nodiscard]] bool set_baud(std::uint32_t baud);

    void schedule() override { core_.schedule(*this); }
    void on_io(net::IoEvents events) override;
    void on_timer(MonoTime now) override;
    void flush() override;
    [[nodiscard]] bool blocked() const override { return blocked_; }
    void expire(MonoTime now) override { counters.queue_age.add(queue.expire(now)); }
    [[nodiscard]] std::optional<MonoTime> tick_due() const override { return parser_.deadline(); }
    void tick(MonoTime now) override;

private:
    void read();
    void wait_for_room();
    void wait_for_driver();
    [[nodiscard]] auto sink(WallTime time) {
        return [this, time](const wire::ParseEvent& event) {
            const bool is_frame = event.kind == wire::ParseEvent::Kind::frame;
            if (is_frame && event.info != nullptr) owner_.on_good_frame();
            if (is_frame && !up) return;  // still searching for the baud rate
            core_.on_event(*this, event, time);
        };
    }

    Core& core_;
    SerialOwner& owner_;
    net::SerialPort port_;
    net::WatchId watch_;
    net::TimerId pace_;
    wire::StreamParser parser_;
    SerialPacer pacer_{0};
    bool blocked_ = false;
};

[[nodiscard]] SetupResult<std::unique_ptr<OpenEndpoint>> open_serial(Opening opening);

}  // namespace mavloom::link::detail
