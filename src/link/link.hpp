// SPDX-License-Identifier: MIT
// A link: a peer, client, connection or port, with its queue, sequence tracking and counters. Private to module link;
// single owner thread.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "mavloom/link/links.hpp"
#include "mavloom/net/lane_queue.hpp"
#include "mavloom/wire/sequence.hpp"

namespace mavloom::link::detail {

class Signature;
struct LinkDialect;

struct Link {
    Link(EndpointId owner, const net::BlockQueue::Limits& limits) : endpoint(owner), queue(limits) {}
    Link(const Link&) = delete;
    Link& operator=(const Link&) = delete;
    virtual ~Link() = default;
    // Notifies the outlet that `queue` has new frames.
    virtual void schedule() = 0;

    // A link may have an allowance: the bytes that may be sent to it. A forged sender address must not direct all
    // traffic to its owner. Links other than UDP peers have none.
    void give_allowance() noexcept { allowance_bytes_ = 0; }
    void extend_allowance(std::int64_t bytes) noexcept { allowance_bytes_ += bytes; }
    void lift_allowance() noexcept { allowance_bytes_ = unlimited; }
    [[nodiscard]] bool has_allowance() const noexcept { return allowance_bytes_ != unlimited; }
    // Spends `bytes` of the allowance. Returns false if too little is left.
    [[nodiscard]] bool spend(std::size_t bytes) noexcept {
        if (!has_allowance()) [[likely]]
            return true;
        if (allowance_bytes_ < static_cast<std::int64_t>(bytes)) return false;
        allowance_bytes_ -= static_cast<std::int64_t>(bytes);
        return true;
    }

    LinkId id;  // Core::add_link sets this and `dialect`
    const LinkDialect* dialect = nullptr;
    EndpointId endpoint;
    std::string name;
    bool up = false;
    bool reported_up = false;
    // True if the outlet was notified that the queue is not empty.
    bool is_scheduled = false;
    // True if the far side reads outgoing frames from the ring. They are then counted, never queued.
    bool finds_in_ring = false;
    Signature* signature = nullptr;
    LinkCounters counters;
    // Frames from verified senders, and the program's own, use the first lane.
    net::LaneQueue queue;
    wire::SequenceTracker tracker;

private:
    static constexpr std::int64_t unlimited = std::numeric_limits<std::int64_t>::max();
    std::int64_t allowance_bytes_ = unlimited;
};

}  // namespace mavloom::link::detail
