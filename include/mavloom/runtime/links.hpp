// SPDX-License-Identifier: MIT
// The links of one process on one event loop: opens endpoints, reads batches, finds frames, hands each good one to a handler, queues whole
// frames for the way out and sends them in batches at the end of the turn. Every UDP peer and TCP client is a link of its own (parser,
// sequence tracking, queue, counters). Endpoints whose far side is absent are retried for ever with back-off.
//
// Owned and driven by one thread; `stop()` and the counters may be used from any. The frame path neither allocates, locks nor logs.
// DESIGN.md rules 2, 3, 4, 7 and 9; routing.md section 6 for loss.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/counter.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/runtime/endpoint.hpp"
#include "mavloom/wire/frame.hpp"
#include "mavloom/wire/message_table.hpp"

namespace mavloom::runtime {

using EndpointId = Id<struct EndpointTag, std::uint32_t>;

// What arrived and left on one link. Every discard has its name (DESIGN.md rule 3).
struct LinkCounters {
    Counter frames_in, bytes_in, frames_out, bytes_out;
    Counter crc_error, junk_bytes, unknown_flags, implausible_unknown, unknown_ids;
    Counter bad_signature;   // verify= is set and the signature does not agree, or there is none
    Counter queue_bytes, queue_age;  // whole frames dropped on the way out
    Counter lost, late, duplicate, resync;  // the link's own loss: sequence gaps at ingress
    Counter filtered, rate_limited;
};

// What belongs to a socket rather than to one of its peers.
struct EndpointCounters {
    Counter kernel_drop;      // SO_MEMINFO's drop count; refreshed by `refresh_kernel_drops()`
    Counter wrong_peer;       // udpout: datagrams from another address
    Counter stray_bytes;      // bytes of strangers whose datagrams held no valid frame
    Counter peers_refused;    // over max_peers with none idle
    Counter send_errors;      // the kernel refused a datagram (e.g. ECONNREFUSED, ENOBUFS after retries)
    Counter reconnects;
};

struct RxFrame {
    wire::FrameView frame;                    // valid during the call
    const wire::MessageInfo* info = nullptr;  // null: id without definition (accepted by routing.md 5.4)
    LinkId link;
    EndpointId endpoint;
    WallTime time{};                          // the kernel's receive time; a recording's own time for tlog sources
};

class LinkHandler {
public:
    virtual ~LinkHandler() = default;
    // A good frame. May call Links::send. Never called with a lock held.
    virtual void on_frame(const RxFrame& rx) = 0;
    // A peer was seen for the first time, connected, went, or was expired.
    virtual void on_link_up(LinkId, EndpointId, std::string_view /*name*/) {}
    virtual void on_link_down(LinkId, EndpointId, std::string_view /*why*/) {}
    // Something a person should know once (not per packet): "udpin://…: receive buffer 425984 bytes (asked 33554432)".
    virtual void on_notice(EndpointId, std::string_view /*text*/) {}
};

struct LinkInfo {
    LinkId id;
    EndpointId endpoint;
    std::string name;         // unique: the endpoint's label, with "#HOST:PORT" of the peer where there can be several
    bool up = false;
    const LinkCounters* counters = nullptr;
};

struct EndpointInfo {
    EndpointId id;
    Endpoint endpoint;
    std::uint16_t local_port = 0;     // the bound port (port 0 was asked for: the one that was given)
    std::uint64_t rcvbuf_bytes = 0;   // what the kernel gave
    bool finished = false;            // a tlog source that was read to its end
    const EndpointCounters* counters = nullptr;
};

class Links {
public:
    // `table` must outlive the object.
    [[nodiscard]] static SetupResult<std::unique_ptr<Links>> create(const wire::MessageTable& table);
    virtual ~Links() = default;

    // Opens at once what can be opened (bind, listen; a port in use is an error), and starts what needs the far side (connect, look-up).
    [[nodiscard]] virtual SetupResult<EndpointId> add(const Endpoint& endpoint) = 0;

    // One turn: waits until something is readable, writable, due, or `deadline`; reads all that is there (bounded, so that one flooded
    // socket cannot starve the rest), calls the handler, then sends what was queued. Returns the number of frames received.
    virtual std::size_t turn(LinkHandler& handler, MonoTime deadline) = 0;

    // Queues a whole frame for one link, or for every link of an endpoint that is up. Returns the number of links that took it.
    virtual std::size_t send(LinkId link, wire::FrameView frame) = 0;
    virtual std::size_t send(EndpointId endpoint, wire::FrameView frame) = 0;
    // True when something queued is not yet with the kernel.
    [[nodiscard]] virtual bool pending() const = 0;
    // Bytes queued for the links of an endpoint: a file source uses it to wait instead of overflowing a queue.
    [[nodiscard]] virtual std::size_t queued_bytes(EndpointId endpoint) const = 0;

    // Wakes `turn`; any thread, also from a signal handler.
    virtual void wake() noexcept = 0;

    // Reads SO_MEMINFO of every UDP socket into kernel_drop: to be called at snapshots and at the end.
    virtual void refresh_kernel_drops() = 0;

    [[nodiscard]] virtual std::vector<LinkInfo> links() const = 0;
    [[nodiscard]] virtual std::vector<EndpointInfo> endpoints() const = 0;
    [[nodiscard]] virtual std::string_view link_name(LinkId link) const = 0;
};

}  // namespace mavloom::runtime
