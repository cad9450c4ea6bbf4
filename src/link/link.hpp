// SPDX-License-Identifier: MIT
// A link: a peer, client, connection or port, with its queue, sequence tracking and counters. Private to module link;
// single owner thread.
#pragma once

#include <cassert>
#include <cstdint>
#include <memory>
#include <string>

#include "mavloom/base/bytes.hpp"
#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/net/lane_queue.hpp"
#include "mavloom/wire/sequence.hpp"

namespace mavloom::link::detail {

class Border;
class Signature;
struct LinkDialect;

[[nodiscard]] inline net::BlockQueue::Limits queue_limits(const endpoint::EndpointOptions& options) {
    net::BlockQueue::Limits limits;
    assert(options.queue_bytes <= endpoint::EndpointOptions::max_queue_bytes);
    limits.max_bytes = static_cast<std::size_t>(options.queue_bytes);
    if (options.queue_age) limits.max_age.fill(*options.queue_age);
    return limits;
}

struct Link {
    Link(EndpointId owner, const endpoint::EndpointOptions& options);
    Link(const Link&) = delete;
    Link& operator=(const Link&) = delete;
    virtual ~Link();
    // Notifies the outlet that `queue` has new frames.
    virtual void schedule() = 0;
    // Parses a datagram, a message or the next bytes of a stream, during a turn. Ignored if the link has ended.
    virtual void hear(ByteView, WallTime) {}
    // Whether the kernel does not find the far side's host. Frames then wait in the queue.
    [[nodiscard]] virtual bool is_missing(MonoTime) const noexcept { return false; }

    // How the link sends.
    enum class Sending : std::uint8_t {
        queued,
        // The link has an allowance: how many more bytes may be sent to it. A sender that forges its address thus
        // cannot direct all traffic to the owner of that address. Only UDP peers have an allowance.
        limited,
        // The far side refused a frame, and gets none while that holds. Only UDP peers are paused.
        paused,
        // The far side reads outgoing frames from the ring. They are counted, never queued.
        found_in_ring,
    };
    void give_allowance() noexcept {
        allowance_bytes_ = 0;
        sending = Sending::limited;
    }
    void extend_allowance(std::int64_t bytes) noexcept { allowance_bytes_ += bytes; }
    void lift_allowance() noexcept { sending = Sending::queued; }
    [[nodiscard]] bool has_allowance() const noexcept { return sending == Sending::limited; }
    // Spends `bytes` of the allowance. Returns false if too little is left. Call it only if there is one.
    [[nodiscard]] bool spend(std::size_t bytes) noexcept {
        assert(has_allowance());
        if (allowance_bytes_ < static_cast<std::int64_t>(bytes)) return false;
        allowance_bytes_ -= static_cast<std::int64_t>(bytes);
        return true;
    }

    // The far side refused a frame. Until `until`, frames for it count as refused. `pause`: they are not even sent.
    void begin_refusal(MonoTime until) noexcept { refused_until_ = until; }
    void pause() noexcept {
        if (sending == Sending::queued) sending = Sending::paused;
    }
    void end_refusal() noexcept {
        refused_until_ = {};
        if (sending == Sending::paused) sending = Sending::queued;
    }
    [[nodiscard]] bool is_refused(MonoTime now) const noexcept { return now < refused_until_; }
    [[nodiscard]] bool is_paused(MonoTime now) noexcept {
        if (!is_refused(now)) end_refusal();
        return sending == Sending::paused;
    }

    // Whether the link signs frames that a link of this rank brought.
    [[nodiscard]] bool signs(Rank from) const noexcept;
    // Bytes in the queue, and those that stages hold for it.
    [[nodiscard]] std::size_t queued_bytes() const noexcept;

    LinkId id;  // Core::add_link sets this, `dialect` and `rank`
    const LinkDialect* dialect = nullptr;
    EndpointId endpoint;
    std::uint64_t ordinal = 0;  // StageSite::ordinal; Core::add_link sets it
    Rank rank = Rank::own;
    std::string name;
    bool up = false;
    bool reported_up = false;
    // True if the outlet was notified that the queue is not empty.
    bool is_scheduled = false;
    Sending sending = Sending::queued;
    Signature* signature = nullptr;
    std::unique_ptr<Border> border;  // null: no stages
    std::size_t max_held_bytes;      // queue_bytes=: by the queue, and by stages in each direction
    LinkCounters counters;
    std::uint64_t frames_repeated = 0;  // of frames_in: those that another endpoint had heard; see RxFrame::is_repeated
    // Frames of strangers use the second lane, all others the first.
    net::LaneQueue queue;
    Loss loss{counters};

private:
    std::int64_t allowance_bytes_ = 0;
    MonoTime refused_until_{};
};

}  // namespace mavloom::link::detail
