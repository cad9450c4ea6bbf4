// SPDX-License-Identifier: MIT
// serial: a serial port as a link. Private to module link; single owner thread.
#pragma once

#include <memory>
#include <string_view>

#include "link/serial/pacer.hpp"
#include "link/stream_peer.hpp"
#include "mavloom/net/serial.hpp"

namespace mavloom::link::detail {

class SerialOwner {
public:
    virtual ~SerialOwner() = default;
    // Called for a frame of a defined message with a good checksum, before the frame's handler. Such a frame proves
    // that the baud rate is right.
    virtual void on_good_frame() = 0;
    // Called when the port is gone. The peer is already detached.
    virtual void on_gone(std::string_view why) = 0;
};

// Keeps at most 50 ms of data in the driver; the rest waits in the queue, where it can expire.
class SerialPeer final : public StreamPeer<SerialPeer, net::SerialPort>, public net::TimerHandler {
public:
    SerialPeer(Core& core, SerialOwner& owner, EndpointId endpoint_id, const endpoint::EndpointOptions& options)
        : StreamPeer(core, endpoint_id, options), owner_(owner) {}
    ~SerialPeer() override { core_.loop().cancel_timer(pace_); }

    [[nodiscard]] SetupResult<void> attach(net::SerialPort port);
    void detach() noexcept override;
    void close(std::string_view why);
    // Returns false if the port is gone.
    [[nodiscard]] bool set_baud(std::uint32_t baud);

    void on_timer(MonoTime now) override;
    void flush() override;
    [[nodiscard]] bool blocked() const override { return pace_.valid() || StreamPeer::blocked(); }

    [[nodiscard]] static bool accepts(ByteView) noexcept { return true; }
    // While the endpoint searches for the baud rate, the handler gets no frames.
    [[nodiscard]] bool wants(const wire::ParseEvent& event) {
        const bool is_frame = event.kind == wire::ParseEvent::Kind::frame;
        if (is_frame && event.info != nullptr) owner_.on_good_frame();
        return !is_frame || up;
    }

private:
    // A hang-up appears as a read of 0 bytes or as an error.
    void on_end(net::IoError) override { close("unplugged"); }

    SerialOwner& owner_;
    net::TimerId pace_;  // runs while the driver holds as many bytes as it may
    SerialPacer pacer_{0};
};

}  // namespace mavloom::link::detail
