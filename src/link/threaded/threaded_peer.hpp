// SPDX-License-Identifier: MIT
// A peer of a transport with threads, as a link. Private to module link; Links' thread owns it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "link/core/core.hpp"
#include "link/peer_policy.hpp"
#include "mavloom/link/transport.hpp"
#include "mavloom/wire/datagram_parser.hpp"

namespace mavloom::link::detail {

// Frames wait in the link's queue, where they can still be replaced and dropped by class. Only so much is handed to the
// transport as keeps it busy until Links' next turn.
class ThreadedPeer final : public Link, public Outlet {
public:
    ThreadedPeer(Core& core, Transport& transport, EndpointId of, const endpoint::EndpointOptions& options)
        : Link(of, options), core_(core), transport_(transport), parser_(core.dialects.of(of).table) {}
    ~ThreadedPeer() override { core_.outlets.forget(*this); }

    // Begins a connection: sends what is queued.
    void begin(PeerNumber number);
    // Ends it. Frames that the transport had, and did not send, are counted.
    void end();
    [[nodiscard]] PeerNumber number() const noexcept { return number_; }
    [[nodiscard]] bool is_sending() const noexcept { return messages_ != 0; }

    void take(ByteView message, WallTime time);
    void hear(ByteView message, WallTime time) override;
    // The far side has ended the connection: delivers what stages still hold.
    void finish() {
        if (border) border->release(Way::in);
    }
    // The transport has sent this many bytes more.
    void note_sent(std::size_t bytes);

    void schedule() override { core_.outlets.schedule(*this); }
    void flush() override;
    [[nodiscard]] bool blocked() const override { return !queue.empty(); }
    void expire(MonoTime now) override { counters.queue_age.add(queue.expire(now)); }

    MonoTime last_heard{};
    std::uint16_t crowd = 0;  // of its address
    [[nodiscard]] PeerPolicy::Candidate candidate() const noexcept {
        return {id, counters.frames_in.value() != frames_repeated, last_heard, crowd};
    }

private:
    // The transport has at most so much at a time.
    static constexpr std::size_t max_message_bytes = 8192, pieces_per_message = 64;
    static constexpr std::size_t max_messages = Transport::max_unsent_bytes / max_message_bytes;
    struct Message {
        std::uint32_t frames = 0, bytes = 0;
    };
    void send_one();
    void count_sent(std::size_t bytes);

    Core& core_;
    Transport& transport_;
    PeerNumber number_ = 0;  // 0: not connected
    wire::DatagramParser parser_;
    // The messages that the transport has, in a circle.
    std::array<Message, max_messages> sending_{};
    std::size_t first_ = 0, messages_ = 0;
    std::size_t sent_bytes_ = 0;  // of the first message
};

}  // namespace mavloom::link::detail
