// SPDX-License-Identifier: MIT
// A link: a peer, client, connection or port, with its queue, sequence tracking and counters. Private to module link;
// single owner thread.
#pragma once

#include <cstdint>
#include <string>

#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/net/lane_queue.hpp"
#include "mavloom/wire/sequence.hpp"

namespace mavloom::link::detail {

class Signature;
struct LinkDialect;

[[nodiscard]] inline net::BlockQueue::Limits queue_limits(const endpoint::EndpointOptions& options) {
    net::BlockQueue::Limits limits;
    limits.max_bytes = static_cast<std::size_t>(options.queue_bytes);
    if (options.queue_age) limits.max_age.fill(*options.queue_age);
    return limits;
}

struct Link {
    Link(EndpointId owner, const endpoint::EndpointOptions& options) : endpoint(owner), queue(queue_limits(options)) {}
    Link(const Link&) = delete;
    Link& operator=(const Link&) = delete;
    virtual ~Link() = default;
    // Notifies the outlet that `queue` has new frames.
    virtual void schedule() = 0;

    // How the link sends.
    enum class Sending : std::uint8_t {
        queued,
        // The link has an allowance: how many more bytes may be sent to it. A sender that forges its address thus
        // cannot direct all traffic to the owner of that address. Only UDP peers have an allowance.
        limited,
        // The far side refuses frames, and gets none for a while. Only UDP peers are paused.
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
        if (allowance_bytes_ < static_cast<std::int64_t>(bytes)) return false;
        allowance_bytes_ -= static_cast<std::int64_t>(bytes);
        return true;
    }

    // Counts frames as refused until `until`, instead of sending them.
    void pause(MonoTime until) noexcept {
        if (sending != Sending::queued) return;
        sending = Sending::paused;
        paused_until_ = until;
    }
    void resume() noexcept {
        if (sending == Sending::paused) sending = Sending::queued;
    }
    [[nodiscard]] bool is_paused(MonoTime now) noexcept {
        if (now >= paused_until_) resume();
        return sending == Sending::paused;
    }

    LinkId id;  // Core::add_link sets this and `dialect`
    const LinkDialect* dialect = nullptr;
    EndpointId endpoint;
    std::string name;
    bool up = false;
    bool reported_up = false;
    // True if the outlet was notified that the queue is not empty.
    bool is_scheduled = false;
    Sending sending = Sending::queued;
    Signature* signature = nullptr;
    LinkCounters counters;
    std::uint64_t frames_repeated = 0;  // of frames_in: those that another endpoint had heard; see RxFrame::is_repeated
    // Frames from verified senders, and the program's own, use the first lane.
    net::LaneQueue queue;
    wire::SequenceTracker tracker;

private:
    std::int64_t allowance_bytes_ = 0;
    MonoTime paused_until_{};
};

}  // namespace mavloom::link::detail
