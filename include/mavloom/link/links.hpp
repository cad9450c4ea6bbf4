// SPDX-License-Identifier: MIT
// Links moves MAVLink frames between a process and its endpoints. It opens endpoints, and it receives and sends frames.
//
// All links of a process share one event loop. In each turn Links reads in batches, passes each good frame to a
// handler, and sends queued frames in batches at the end. Every UDP peer and every TCP client is a link with its own
// parser, sequence tracking, queue and counters. If the far side of an endpoint is absent, Links retries indefinitely,
// with back-off.
//
// One thread owns and drives the object. Any thread may call `wake()` and read counter values. The frame path does not
// allocate, lock or log. Queues: docs/guide/queues.md. Counters: docs/guide/route.md.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/base/rank.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/endpoint/checks.hpp"
#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/link/counters.hpp"
#include "mavloom/link/stage.hpp"
#include "mavloom/wire/frame.hpp"
#include "mavloom/wire/message_table.hpp"
#include "mavloom/wire/sequence.hpp"

namespace mavloom::dialect {
class Dialect;
}

namespace mavloom::link {

using EndpointId = Id<struct EndpointTag, std::uint32_t>;

// The sequence numbers heard on one link, and its loss counters.
struct Loss {
    // With endpoint::RoutingOptions::by_owner, the owner of the links calls it for each frame that is no echo.
    // Otherwise Links does, for every frame. Returns a reference that is valid until the next call.
    const wire::SequenceTracker::Update& count(const wire::FrameView& frame, const wire::MessageInfo* info) {
        const auto& update = tracker.update(frame, info);
        if (update.verdict != wire::SequenceTracker::Verdict::good) [[unlikely]]
            counters.add(update);
        return update;
    }

    LinkCounters& counters;
    wire::SequenceTracker tracker{};
};

struct RxFrame {
    wire::FrameView frame;  // valid during the call
    // Null: the dialect has no definition for this id.
    const wire::MessageInfo* info = nullptr;
    LinkId link;
    EndpointId endpoint;
    // The kernel's receive time. For tlog sources: the time in the recording.
    WallTime time{};
    // How this frame changed the link's loss counters; valid during the call, never null. If the owner counts loss, an
    // update without changes.
    const wire::SequenceTracker::Update* sequence = &wire::no_loss;
    // From a ring: the verdict that its writer recorded for the frame (ring/frames.hpp).
    std::uint8_t ring_verdict = 0;
    // The frame's signature is good, but another endpoint has heard the frame before. A sender without the key may have
    // replayed it here.
    bool is_repeated = false;
    Rank rank = Rank::own;  // of the link
    Loss* loss = nullptr;   // of the link; null for rings and recordings
};

class LinkHandler {
public:
    virtual ~LinkHandler() = default;
    // Receives a good frame. It may call Links::send. No lock is held during the call.
    virtual void on_frame(const RxFrame& rx) = 0;
    // A link came up (new peer, connection or open port) or went down (closed, lost or idle).
    virtual void on_link_up(LinkId, EndpointId, std::string_view /*name*/) {}
    virtual void on_link_down(LinkId, EndpointId, std::string_view /*why*/) {}
    // Bytes that look like a frame of this id but fail the checksum: damaged, or sent with another definition. Links
    // has already counted them.
    virtual void on_bad_checksum(LinkId, EndpointId, MessageId) {}
    // An event for the log, reported once and never per packet: "udpin://…: listening (receive buffer 425984
    // bytes)".
    virtual void on_notice(EndpointId, std::string_view /*text*/) {}
};

struct LinkInfo {
    LinkId id;
    EndpointId endpoint;
    // A unique name: the endpoint's label, followed by the peer's "#HOST:PORT" if the endpoint can have several peers.
    std::string name;
    bool up = false;
    Rank rank = Rank::own;  // docs/guide/routing.md, "Trust"
    const LinkCounters* counters = nullptr;
    // Bytes that wait to be sent, and how many may wait: queue_bytes= of the endpoint.
    std::size_t queued_bytes = 0, queue_limit_bytes = 0;
    std::string stages{};  // what the stages at its border do; empty: there are none
};

struct EndpointInfo {
    EndpointId id;
    endpoint::Endpoint endpoint;
    // The bound port. If port 0 was requested, the port that the kernel assigned.
    std::uint16_t local_port = 0;
    std::uint64_t rcvbuf_bytes = 0;  // as granted by the kernel
    const EndpointCounters* counters = nullptr;

    // The endpoint's label; the bound port replaces a requested port 0.
    [[nodiscard]] std::string label() const {
        endpoint::Endpoint given = endpoint;
        if (given.address.port == 0) given.address.port = local_port;
        return given.label();
    }
};

// The interface for code that forwards frames over links but does not open them. Links implements it.
class LinkAccess {
public:
    LinkAccess() = default;
    LinkAccess(const LinkAccess&) = delete;
    LinkAccess& operator=(const LinkAccess&) = delete;
    virtual ~LinkAccess() = default;

    // Queues a whole frame for these links. Returns the number of links that queued it. Links that are gone or down are
    // skipped.
    virtual std::size_t send(std::span<const LinkId> links, const wire::FrameView& frame) = 0;
    // Queues a frame that a link of this rank brought. A link sends frames of strangers when no others are queued, and
    // they use none of the others' room. Links with `sign=` sign verified frames, and with `sign_all=true` own ones
    // too. Returns how many links with `sign=` queued the frame unsigned.
    virtual std::size_t forward(std::span<const LinkId> links, const wire::FrameView& frame, Rank from) = 0;
    // The clock reading that the current turn uses.
    [[nodiscard]] virtual MonoTime now() const noexcept = 0;
    // A link's counters in constant time; null if the link is gone.
    [[nodiscard]] virtual const LinkCounters* counters(LinkId link) const noexcept = 0;
    // Empty if the link is gone.
    [[nodiscard]] virtual std::string_view link_name(LinkId link) const = 0;
    // `stranger` if the link is gone.
    [[nodiscard]] virtual Rank rank(LinkId link) const noexcept = 0;
};

namespace detail {
class Core;
}

class Links final : public LinkAccess {
public:
    // Uses the dialect's message table and instance fields, so that a full queue drops superseded frames first
    // (docs/guide/queues.md). `dialect` must outlive the object.
    [[nodiscard]] static SetupResult<std::unique_ptr<Links>> create(
        const dialect::Dialect& dialect, endpoint::RoutingOptions routing = endpoint::RoutingOptions::refused);
    ~Links() override;

    // True if this program has links of the scheme: those of this module, and those with a registered transport.
    [[nodiscard]] static bool can_open(endpoint::Scheme scheme) noexcept;

    // Numbers new links from `last` + 1 instead of 1. Call it before the first endpoint is added.
    void count_from(LinkId last) noexcept;

    // Return ids that no link or endpoint here has, or will have: for sources that are read beside these links.
    [[nodiscard]] LinkId take_link_id() noexcept;
    [[nodiscard]] EndpointId take_endpoint_id();

    // In a group, a fast link may deliver a sender's newer signed frames before a slow link delivers older ones. The
    // older ones are still accepted for a while: at least a third of this time, at most all of it. A caller that
    // detects duplicates by their bytes must remember frames for longer than this.
    static constexpr Nanoseconds max_late = std::chrono::milliseconds{1800};

    // Opens the endpoint. Local steps (bind, listen) happen at once, and a port in use is an error. Steps that need the
    // far side (name look-up, connect) continue in the background if they take long. With `required=true` the call
    // fails if the far side is absent. It waits up to 5 s for a look-up, and up to 5 s for each TCP connection attempt.
    // After the first turn it never waits, whatever the value of `required`. An option that live links do not support
    // is an error. If `dialect` is given, this endpoint's links use it instead of the dialect of `create` to find and
    // queue frames. It must outlive the endpoint.
    [[nodiscard]] SetupResult<EndpointId> add(const endpoint::Endpoint& endpoint,
                                              const dialect::Dialect* dialect = nullptr);
    // From now on, treats each endpoint as if it belonged to a separate program. Several endpoints without name= may
    // then have the same address, and an endpoint accepts frames that another endpoint signed.
    void make_independent() noexcept;
    // Returns whether another endpoint with the same address may be added.
    [[nodiscard]] bool allows_same_address(const endpoint::Endpoint& endpoint) const noexcept;
    // Path at which the writer of the ring `ring` creates its inlet: RUN/NAME.in. Errors: see net::run_path.
    [[nodiscard]] static SetupResult<std::filesystem::path> inlet_path(std::string_view ring);
    // The user who owns the folder of the inlets. Readers trust the rings of this user. Empty if there is no folder.
    [[nodiscard]] static std::optional<uid_t> owner_of_inlets();
    // Opens the inlet of the ring `ring` (docs/formats/ring.md): a Unix datagram socket at `socket` with permissions
    // `mode`.
    // Each bound sender of a valid frame becomes a link; all unbound senders share one. Frames sent to these links are
    // counted but not transmitted, because the senders read them from the ring.
    // Replaces a socket that no process serves. If a process serves it, the error is `in_use`.
    [[nodiscard]] SetupResult<EndpointId> add_inlet(const std::string& ring, const std::filesystem::path& socket,
                                                    unsigned mode);
    // The last error of an endpoint that is being retried. Null during the first attempt, and for an endpoint that
    // never failed.
    [[nodiscard]] const SetupError* failure(EndpointId endpoint) const noexcept;
    // Closes an endpoint and all its links. Frames still queued are lost. Must not be called inside a callback;
    // on_link_down is not called for these links.
    void remove(EndpointId endpoint);
    // Closes one peer, client or sender of an endpoint, as if it had left. It may return as a new link. Returns false
    // if the link is gone or is the only one that its endpoint can have.
    // Must not be called inside a callback; on_link_down is not called for this link.
    bool close(LinkId link);
    // Put stages (stage.hpp) at the border of an endpoint's links, present and future ones, or of one link, in place of
    // earlier ones. For an endpoint, an empty function removes them; for a link, empty chains do. Pieces that the
    // earlier stages hold pass on at the next turn. Return false if the endpoint or link is gone, or belongs to a ring:
    // an inlet, or shm://.
    // Must not be called inside a callback.
    bool set_stages(EndpointId endpoint, CreateStages create);
    bool set_stages(LinkId link, const CreateStages& create);
    // The function of the last set_stages: of an endpoint, for its future links; of a link, for those that it has. Null
    // if there are no stages. Valid until the next call of set_stages, `remove` or `turn`.
    [[nodiscard]] const CreateStages* stages_by(EndpointId endpoint) const noexcept;
    [[nodiscard]] const CreateStages* stages_by(LinkId link) const noexcept;
    // Passes an event for the log to the handler's on_notice, in the next turn.
    void report(EndpointId endpoint, std::string text);
    // True if a key file of `sign=` or `verify=` now holds a different key from the one in use. False while one of the
    // files cannot be read.
    [[nodiscard]] bool has_other_keys(EndpointId endpoint) const;

    // Runs one turn. It waits for input, output, a timer or `deadline`, reads what has arrived, calls the handler, then
    // sends what is queued. Returns the number of frames received.
    // The amount read per turn is bounded, so that one flooded socket cannot starve the others. Under heavy load a turn
    // starts at least 0.2 ms after the previous one, unless an endpoint has low_latency.
    std::size_t turn(LinkHandler& handler, MonoTime deadline);
    // From now on, a turn reads as much as it can from each socket, even if that takes long. Call it before the last
    // turns, to receive everything that has arrived.
    void read_all() noexcept;

    std::size_t send(std::span<const LinkId> links, const wire::FrameView& frame) override;
    // Queue a frame for one link, and for every active link of an endpoint.
    std::size_t send(LinkId link, const wire::FrameView& frame);
    std::size_t send(EndpointId endpoint, const wire::FrameView& frame);
    std::size_t forward(std::span<const LinkId> links, const wire::FrameView& frame, Rank from) override;
    [[nodiscard]] MonoTime now() const noexcept override;
    // True while frames are queued, or held by stages, that the kernel has not accepted yet. Those that wait for a host
    // that has left its network do not count.
    [[nodiscard]] bool pending() const;
    // Bytes that are queued for an endpoint's links, or held by their stages. A source that reads a file can pause
    // instead of overflowing a queue.
    [[nodiscard]] std::size_t queued_bytes(EndpointId endpoint) const;
    // The same for one link, in constant time; 0 if the link is gone.
    [[nodiscard]] std::size_t queued_bytes(LinkId link) const noexcept;

    // Wakes `turn`. Callable from any thread and from signal handlers.
    void wake() noexcept;

    // Reads the counters that the kernel or a transport keeps, such as `kernel_drop` from SO_MEMINFO. Call it before
    // taking a snapshot and at the end.
    void refresh_counters();

    // The links that exist now. A link's `counters` stay valid until its on_link_down has returned.
    [[nodiscard]] std::vector<LinkInfo> links() const;
    // For a copy in pieces. `link_ids` returns the ids of the current links, sorted. `links` returns the links with
    // these ids, without those that are gone.
    [[nodiscard]] std::vector<LinkId> link_ids() const;
    [[nodiscard]] std::vector<LinkInfo> links(std::span<const LinkId> ids) const;
    [[nodiscard]] std::vector<EndpointInfo> endpoints() const;
    [[nodiscard]] const LinkCounters* counters(LinkId link) const noexcept override;
    // Loss per source on a link. Valid until the next turn; empty if the link is gone.
    [[nodiscard]] std::span<const wire::SequenceStats> sources(LinkId link) const noexcept;
    [[nodiscard]] std::string_view link_name(LinkId link) const override;
    [[nodiscard]] Rank rank(LinkId link) const noexcept override;

private:
    Links(std::unique_ptr<detail::Core> core, endpoint::RoutingOptions routing) noexcept;
    [[nodiscard]] SetupResult<void> open_as(EndpointId id, std::uint8_t signs_as, const endpoint::Endpoint& endpoint,
                                            const dialect::Dialect* dialect);

    std::unique_ptr<detail::Core> core_;
    endpoint::RoutingOptions routing_;
    bool allows_same_address_ = false;
};

}  // namespace mavloom::link
