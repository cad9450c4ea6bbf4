// SPDX-License-Identifier: MIT
// The links of one process on one event loop: opens endpoints, reads batches, finds frames, hands each good one to a handler, queues whole
// frames for the way out and sends them in batches at the end of the turn. Every UDP peer and TCP client is a link of its own (parser,
// sequence tracking, queue, counters). Endpoints whose far side is absent are retried for ever with back-off.
//
// Owned and driven by one thread; `wake()` and the counters' values may be used from any. The frame path neither allocates, locks nor logs.
// DESIGN.md rules 2, 3, 4, 7 and 9; routing.md section 6 for loss.
#pragma once

#include <cstdint>
#include <filesystem>
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
#include "mavloom/endpoint/checks.hpp"
#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/wire/frame.hpp"
#include "mavloom/wire/message_table.hpp"
#include "mavloom/wire/sequence.hpp"

namespace mavloom::dialect {
class Dialect;
}

namespace mavloom::link {

using EndpointId = Id<struct EndpointTag, std::uint32_t>;

// What arrived and left on one link. Every discard has its name (DESIGN.md rule 3).
struct LinkCounters {
    Counter frames_in, bytes_in, frames_out, bytes_out;
    Counter crc_error, junk_bytes, unknown_flags, implausible_unknown, unknown_ids;
    Counter bad_signature;                  // verify= is set and the signature does not agree, or there is none
    Counter queue_bytes, queue_age;         // whole frames dropped on the way out
    Counter lost, late, duplicate, resync;  // the link's own loss: sequence gaps at ingress
    Counter frames_not_sent;                // in datagrams that the kernel refused
    Counter refused;  // sent to a closed port: within 1 s after a refusal (ICMP) and before the peer is heard
    void add(const LinkCounters& other) noexcept;
    // What a frame's number says of the loss.
    void add(const wire::SequenceTracker::Update& update) noexcept;
};

// What belongs to a socket rather than to one of its peers.
struct EndpointCounters {
    Counter kernel_drop;  // SO_MEMINFO's drop count; refreshed by `refresh_kernel_drops()`
    Counter wrong_peer;   // udpout: datagrams from another address
    Counter stray_bytes;  // bytes of strangers whose datagrams held no valid frame, or with verify= none that is well signed
    Counter peers_refused;  // over max_peers, and none of the others may go (docs/guide/queues.md)
    Counter peers_evicted;  // the longest idle, gone for a newcomer
    Counter send_errors;    // datagrams that met a closed port (as far as ICMP reports it) or that the kernel refused
    Counter reconnects;
    // Sums over the peers and clients that are gone, and the bad signatures of strangers, who never were peers: with the counters of the
    // links that are there they make the endpoint's whole. A link is added when its on_link_down has returned.
    LinkCounters gone;
    Counter gone_queued;  // whole frames that were still queued when their link went
};

struct RxFrame {
    wire::FrameView frame;                    // valid during the call
    const wire::MessageInfo* info = nullptr;  // null: id without definition (accepted by routing.md 5.4)
    LinkId link;
    EndpointId endpoint;
    WallTime time{};                           // the kernel's receive time; a recording's own time for tlog sources
    wire::SequenceTracker::Update sequence{};  // what it says of the link's loss, unless the owner counts that
    std::uint8_t ring_verdict = 0;             // of a ring: what its writer says of the frame (ring/frames.hpp)
};

class LinkHandler {
public:
    virtual ~LinkHandler() = default;
    // A good frame. May call Links::send. Never called with a lock held.
    virtual void on_frame(const RxFrame& rx) = 0;
    // A peer was seen for the first time, connected, went, or was expired.
    virtual void on_link_up(LinkId, EndpointId, std::string_view /*name*/) {}
    virtual void on_link_down(LinkId, EndpointId, std::string_view /*why*/) {}
    // Something that began and was as long as a frame of this id, damaged or made with another definition. It is counted already.
    virtual void on_bad_checksum(LinkId, EndpointId, MessageId) {}
    // Something a person should know once (not per packet): "udpin://…: listening (receive buffer 425984 bytes)".
    virtual void on_notice(EndpointId, std::string_view /*text*/) {}
};

struct LinkInfo {
    LinkId id;
    EndpointId endpoint;
    std::string name;  // unique: the endpoint's label, with "#HOST:PORT" of the peer where there can be several
    bool up = false;
    const LinkCounters* counters = nullptr;
};

struct EndpointInfo {
    EndpointId id;
    endpoint::Endpoint endpoint;
    std::uint16_t local_port = 0;    // the bound port (port 0 was asked for: the one that was given)
    std::uint64_t rcvbuf_bytes = 0;  // what the kernel gave
    const EndpointCounters* counters = nullptr;

    // The endpoint's label, with the given port where port 0 was asked for.
    [[nodiscard]] std::string label() const {
        endpoint::Endpoint given = endpoint;
        if (given.address.port == 0) given.address.port = local_port;
        return given.label();
    }
};

class Links {
public:
    // `table` must outlive the object. A full queue then drops telemetry oldest first; with a dialect it knows which newer value replaces
    // which.
    [[nodiscard]] static SetupResult<std::unique_ptr<Links>> create(const wire::MessageTable& table);
    // The same with the dialect's table, which must outlive the object, and its instance fields (docs/guide/queues.md).
    [[nodiscard]] static SetupResult<std::unique_ptr<Links>> create(
        const dialect::Dialect& dialect, endpoint::RoutingOptions routing = endpoint::RoutingOptions::refused);
    Links(const Links&) = delete;
    Links& operator=(const Links&) = delete;
    ~Links();

    // Links get numbers behind `last`, not from 1: before the first is added.
    void count_from(LinkId last) noexcept;

    // Signed frames of a group of links are taken up to this long after a faster link brought newer ones. Who tells copies by their bytes has to
    // know them for longer.
    static constexpr Nanoseconds longest_late = std::chrono::milliseconds{1800};

    // Opens at once what can be opened (bind, listen; a port in use is an error), and starts what needs the far side (connect, look-up).
    // With `required=true` it waits up to 5 s for the far side and fails without it. An option that these links cannot honour is an error.
    // After the first turn it waits for nobody: a look-up or connection goes on beside the turns, whatever `required` says.
    // With a dialect, which must outlive the endpoint, its links find and queue frames by that.
    [[nodiscard]] SetupResult<EndpointId> add(const endpoint::Endpoint& endpoint,
                                              const dialect::Dialect* dialect = nullptr);
    // From now on endpoints without a name= may lead to the same place: whoever adds them tells them apart by their ids.
    void let_repeat() noexcept;
    [[nodiscard]] bool may_repeat(const endpoint::Endpoint& endpoint) const noexcept;
    // Where the writer of the ring `ring` makes its inlet: RUN/NAME.in. Errors as of net::run_path.
    [[nodiscard]] static SetupResult<std::filesystem::path> inlet_path(std::string_view ring);
    // The inlet of the ring `ring` (docs/formats/ring.md): a Unix datagram socket at `socket` that may be sent to as `mode` says. Each sender of a
    // valid frame is a link, all that are not bound are one; what is sent to these links is counted and goes nowhere, for they find it in the ring.
    // A socket that nobody serves any more is replaced; `in_use` where somebody does.
    [[nodiscard]] SetupResult<EndpointId> add_inlet(const std::string& ring, const std::filesystem::path& socket,
                                                    unsigned mode);
    // Why an endpoint that is tried again and again could not be opened the last time; null while that goes on for the first time, and of one
    // that never failed.
    [[nodiscard]] const SetupError* failure(EndpointId endpoint) const noexcept;
    // Closes an endpoint and all its links; what they had queued is lost. Not to be called inside a callback.
    void remove(EndpointId endpoint);
    // Closes one peer, client or sender of an endpoint, as if it had gone; it may come again. False where the link is the only one that its endpoint
    // can have, or is gone. Not to be called inside a callback.
    bool close(LinkId link);
    // Whether the key files of its `sign=` and `verify=` hold other keys now than those in use; not so while one of them cannot be read.
    [[nodiscard]] bool has_other_keys(EndpointId endpoint) const;

    // One turn: waits until something is readable, writable, due, or `deadline` (in a rush of frames, and where no endpoint has low_latency, it
    // begins 0.2 ms after the last one at the earliest); reads all that is there (bounded, so that one flooded
    // socket cannot starve the rest), calls the handler, then sends what was queued. Returns the number of frames received.
    std::size_t turn(LinkHandler& handler, MonoTime deadline);

    // Queues a whole frame for one link, or for every link of an endpoint that is up. Returns the number of links that took it.
    std::size_t send(LinkId link, wire::FrameView frame);
    std::size_t send(EndpointId endpoint, wire::FrameView frame);
    // The same without the signature that `sign=` would give: true when the link took it and has `sign=`.
    bool send_unsigned(LinkId link, wire::FrameView frame);
    // endpoint::RoutingOptions::by_owner: this frame, which is being handled, counts for its link's loss.
    wire::SequenceTracker::Update count_loss(const RxFrame& rx);
    // The instant of the turn that is under way.
    [[nodiscard]] MonoTime now() const noexcept;
    // True when something queued is not yet with the kernel.
    [[nodiscard]] bool pending() const;
    // Bytes queued for the links of an endpoint: a file source uses it to wait instead of overflowing a queue.
    [[nodiscard]] std::size_t queued_bytes(EndpointId endpoint) const;

    // Wakes `turn`; any thread, also from a signal handler.
    void wake() noexcept;

    // Reads SO_MEMINFO of every UDP socket into kernel_drop: to be called at snapshots and at the end.
    void refresh_kernel_drops();

    // What is there now. `counters` of a link stay until its on_link_down has returned.
    [[nodiscard]] std::vector<LinkInfo> links() const;
    [[nodiscard]] std::vector<EndpointInfo> endpoints() const;
    // The same counters without the list, in constant time; null for a link that is gone.
    [[nodiscard]] const LinkCounters* counters(LinkId link) const noexcept;
    // What each source on a link lost; valid until the next turn, empty for a link that is gone.
    [[nodiscard]] std::span<const wire::SequenceStats> sources(LinkId link) const noexcept;
    // Empty for a link that is gone.
    [[nodiscard]] std::string_view link_name(LinkId link) const;

private:
    class Impl;
    explicit Links(std::unique_ptr<Impl> impl) noexcept;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mavloom::link
