// SPDX-License-Identifier: MIT
// How a module outside `link` adds a kind of link: a transport with threads of its own, such as MAVLink over WebSocket.
//
// The transport moves whole messages, each of one or more whole frames. Everything else is done for it: Links looks up
// hosts, tries again after failures, parses, verifies, routes, signs, queues by class, key and age, and counts. The two
// sides meet in a Mailbox. The transport's threads report there what happened; Links' thread calls the transport.
#pragma once

#include <sys/uio.h>

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/clock.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/link/counters.hpp"
#include "mavloom/net/address.hpp"

namespace mavloom::link {

// A connection of a transport. The transport numbers them from 1 on; a number is never used again.
using PeerNumber = std::uint64_t;

struct NewPeer {
    PeerNumber number = 0;
    std::optional<net::Address> address;  // decides the rank of a client; part of its name
    // A client that is a stranger wherever it comes from. Without an address, `trusted=false` has no other effect.
    bool is_foreign = false;
};

// Takes what happened, in order. Any thread may call these functions, also while it is in one of the Transport's; none
// waits. After Links has closed the endpoint, they do nothing.
class Mailbox {
public:
    // `wake` makes Links' thread look into the mailbox.
    explicit Mailbox(std::function<void()> wake) : wake_(std::move(wake)) {}

    // A client came, or a call succeeded. The peer becomes a link, or the endpoint's only link comes up.
    void join(const NewPeer& peer);
    // Also after Transport::close, where it has no effect.
    void leave(PeerNumber peer, std::string_view why);
    // A call failed.
    void fail(const SetupError& error);
    // For the user, such as a client that was refused. A transport limits how often it calls this.
    void notice(std::string_view text);
    // A message arrived. Returns false if the mailbox is full: read no more from this peer, keep the message, and
    // deliver it again when Transport::resume is called.
    [[nodiscard]] bool deliver(PeerNumber peer, ByteView message, WallTime time);
    // So many bytes, which Transport::send was passed for the peer, have left. While too many are not reported, Links
    // sends the peer nothing more.
    void note_sent(PeerNumber peer, std::size_t bytes);

    struct Event {
        enum class Kind : std::uint8_t { join, leave, fail, notice, message, sent };
        Kind kind;
        PeerNumber peer = 0;
        // Of `bytes`: the message or text. `sent`: the number of bytes. `join`, `fail`: the place in the list of peers
        // or errors.
        std::size_t offset = 0, size = 0;
        WallTime time{};
    };
    struct Batch {
        std::vector<Event> events;
        std::vector<std::uint8_t> bytes;
        std::vector<NewPeer> peers;
        std::vector<SetupError> errors;
        void clear() noexcept;
        [[nodiscard]] ByteView bytes_of(const Event& event) const noexcept {
            return ByteView(bytes).subspan(event.offset, event.size);
        }
    };
    // For Links. Exchanges what has arrived with `read`, whose memory is used again. Returns true if `deliver` was
    // refused since the last call.
    [[nodiscard]] bool exchange(Batch& read);
    // Waits until something has arrived.
    void wait(std::chrono::milliseconds limit);
    void close();

    // Bytes of messages, with their events, that may wait: of one peer, so that it does not delay the others, and of
    // all. A peer of which none waits may always deliver one.
    static constexpr std::size_t max_peer_bytes = std::size_t{256} << 10, max_bytes = std::size_t{4} << 20;

private:
    template <class Put>
    bool add(Put&& put);

    const std::function<void()> wake_;
    std::mutex mutex_;  // for all below
    std::condition_variable arrived_;
    Batch batch_;
    std::unordered_map<PeerNumber, std::size_t> waiting_;  // bytes in batch_, of each peer
    std::size_t all_waiting_ = 0;
    bool is_closed_ = false, was_full_ = false;
};

// One endpoint of a transport. Links' thread calls these functions, and none may wait for the network.
class Transport {
public:
    virtual ~Transport() = default;  // closes everything

    // Listens on these addresses, or makes one attempt to call one of them. An attempt that began ends with
    // Mailbox::join or Mailbox::fail; one that could not begin returns the error. Links calls `open` again later,
    // also after a connection that it made has left or was closed.
    [[nodiscard]] virtual SetupResult<void> open(const std::vector<net::Address>& addresses) = 0;
    // The port that it listens on; 0: none.
    [[nodiscard]] virtual std::uint16_t local_port() const { return 0; }
    // Sends whole frames, back to back, as one message. They are copied before the call returns. Returns how many bytes
    // have left already, of all that was passed for the peer; Mailbox::note_sent reports the others. None may be
    // dropped while the connection lasts: of one peer, at most `max_unsent_bytes` are passed and have not left.
    static constexpr std::size_t max_unsent_bytes = std::size_t{128} << 10;
    virtual std::size_t send(PeerNumber peer, std::span<const iovec> frames) = 0;
    virtual void close(PeerNumber peer, std::string_view why) = 0;
    // The mailbox has room again, for all peers that it refused.
    virtual void resume() = 0;
    // Updates the counters that only the transport knows. Called before they are read.
    virtual void refresh(EndpointCounters&) {}
};

using CreateTransport = std::unique_ptr<Transport> (*)(const endpoint::Endpoint&, std::shared_ptr<Mailbox>);

// From now on, endpoints of this scheme use this transport. A program calls it before it opens endpoints. Safe from any
// thread.
void register_transport(endpoint::Scheme scheme, CreateTransport create) noexcept;

}  // namespace mavloom::link
