// SPDX-License-Identifier: MIT
// One WebSocket (RFC 6455), accepted by a Server or opened by a Client; or one stream, an answer without a length.
//
// Messages arrive whole, on the http thread. Any thread may send: blocks wait in a bounded queue by class and key
// (net/block_queue.hpp), and one writer sends them: the http thread, or with `writes_at_once` the thread that calls
// `flush`. A peer that reads nothing fills only this queue; it loses telemetry first. Peers that do not answer pings
// are disconnected.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/clock.hpp"
#include "mavloom/base/counter.hpp"
#include "mavloom/net/address.hpp"
#include "mavloom/net/block_queue.hpp"

namespace mavloom::http {

class FrameWriter;  // private

enum class Kind : std::uint8_t { binary, text };
enum class Accepts : std::uint8_t { binary, text, both };

struct SessionOptions {
    // Limits for messages that arrive. A message that breaks one ends the session.
    Accepts accepts = Accepts::binary;
    std::size_t max_message = 65'536;  // bytes
    std::size_t max_fragments = 64;    // of one message
    // The whole queue takes up to 4.4 times `max_bytes`, if blocks are short.
    net::BlockQueue::Limits queue{.max_bytes = 192 * 1024};
    // Sends as many waiting blocks in one binary message as fit into so many bytes. 0: each block is a message.
    std::size_t pack_bytes = 0;
    // `flush` writes to the socket itself, unless the http thread has something to write. It spares the wake-up of that
    // thread. Only with `pack_bytes`.
    bool writes_at_once = false;
    // A peer from which nothing arrived for so long gets a ping. The session ends if nothing arrives for as long again.
    std::chrono::milliseconds silence{10'000};
};

enum class Ended : std::uint8_t { by_us, by_peer, silent, protocol, size, fragments, kind, lost };

struct Closed {
    Ended why = Ended::lost;
    std::uint16_t code = 0;  // that the peer sent; 0: none
    std::string text;        // for the user: what happened
};

// The callbacks of one session, on the http thread. They may use the session, but must not destroy its Server or
// Client.
struct SessionEvents {
    // Returns false if it cannot take the message yet. Then nothing more is read, and it gets the same message again
    // after `Session::resume`.
    std::function<bool(ByteView, Kind)> on_message{};
    std::function<void(std::size_t bytes)> on_sent{};  // the kernel has taken these bytes of blocks, not by `flush`
    std::function<void(const Closed&)> on_closed{};    // at most once, and nothing after it
};

// Any thread may read these. Blocks are what `push` got.
struct SessionCounters {
    Counter messages_in, bytes_in;
    Counter messages_out, blocks_out, bytes_out;
    std::array<Counter, net::BlockQueue::classes> dropped;  // blocks, by class; the next two together
    Counter dropped_full, dropped_old;
};

struct Peer {
    net::Address address;
    std::string origin;  // the Origin header; empty: there was none, so the client is not a browser
    std::string subprotocol;
};

class Session {
public:
    // Private to the module.
    struct Orders {
        std::function<void()> write;                                      // something waits
        std::function<void(std::uint16_t code, std::string text)> close;  // after what waits was sent
        std::function<void()> resume;                                     // reads on
    };
    Session(const SessionOptions& options, Peer peer, Orders orders);

    [[nodiscard]] const Peer& peer() const noexcept { return peer_; }
    [[nodiscard]] const SessionCounters& counters() const noexcept { return counters_; }

    // Any thread may call these; none waits. After the session has ended, they do nothing.
    //
    // Queues a copy of the block; `flush` lets the writer send it, and returns the bytes of blocks that the kernel has
    // taken at once. BlockQueue::push explains class and key. `kind` has an effect only if each block is a message.
    void push(ByteView block, std::uint8_t block_class, std::uint64_t key, MonoTime now, Kind kind = Kind::binary);
    std::size_t flush();
    // Sends what is queued, as far as the peer reads it within the `patience` of its server or client, then closes.
    // RFC 6455, section 7.4 lists the codes.
    void close(std::uint16_t code, const std::string& text) { orders_.close(code, text); }
    // See SessionEvents::on_message.
    void resume() { orders_.resume(); }
    // The bytes of the blocks that wait now.
    [[nodiscard]] std::size_t queued_bytes() const;

    // Private to the module: appends the next messages as frames, until `output` has `up_to` bytes or more. Returns the
    // bytes of blocks in them.
    std::size_t take(std::vector<std::uint8_t>& output, std::size_t up_to, FrameWriter& writer, MonoTime now);
    // The same without frames, for a stream; `pack_bytes` must not be 0.
    std::size_t take_unframed(std::vector<std::uint8_t>& output, std::size_t up_to, MonoTime now);
    [[nodiscard]] SessionCounters& counts() noexcept { return counters_; }
    // Private to the module, for `writes_at_once`. From `lend` to `withdraw`, `flush` may use the socket and writer.
    // Before the http thread writes, it appends with `take_begun` the rest of what `flush` has begun to write; from
    // then to the next `take`, `flush` writes nothing. Returns the bytes of blocks that were begun.
    void lend(int socket, FrameWriter& writer);
    void withdraw();
    std::size_t take_begun(std::vector<std::uint8_t>& output);
    void end();

private:
    void count_drops();
    template <class Append>
    std::size_t take_some(std::vector<std::uint8_t>& output, std::size_t up_to, MonoTime now, Append append);
    void take_one(std::vector<std::uint8_t>& output, FrameWriter& writer);
    void take_packed(std::vector<std::uint8_t>& output, FrameWriter* writer);
    void count_message(std::size_t blocks, std::size_t bytes);
    [[nodiscard]] std::size_t write_at_once();

    const Peer peer_;
    const Orders orders_;
    const std::size_t pack_bytes_;
    const bool writes_at_once_;
    SessionCounters counters_;

    mutable std::mutex mutex_;  // for all below, and for the counters of what leaves
    net::BlockQueue queue_;
    std::vector<std::uint8_t> scratch_;
    bool is_writing_ = false;        // the http thread will call `take` again
    FrameWriter* writer_ = nullptr;  // lent by the http thread, with the socket
    int socket_ = -1;
    std::vector<std::uint8_t> rest_;  // what the socket did not take at once
    std::size_t rest_bytes_ = 0;      // of the blocks of which some of `rest_` is
    bool has_ended_ = false;
};

}  // namespace mavloom::http
