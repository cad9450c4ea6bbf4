// SPDX-License-Identifier: MIT
// A link: a peer, client, connection or port, with its queue, sequence tracking and counters. Private to module link;
// single owner thread.
#pragma once

#include <string>

#include "mavloom/link/links.hpp"
#include "mavloom/net/block_queue.hpp"
#include "mavloom/wire/sequence.hpp"

namespace mavloom::link::detail {

class Signature;
struct Language;

struct Link {
    Link(EndpointId owner, const net::BlockQueue::Limits& limits) : endpoint(owner), queue(limits) {}
    Link(const Link&) = delete;
    Link& operator=(const Link&) = delete;
    virtual ~Link() = default;
    // Notifies the outlet that `queue` has new frames.
    virtual void schedule() = 0;

    LinkId id;  // Core::add_link sets this and `language`
    const Language* language = nullptr;
    EndpointId endpoint;
    std::string name;
    bool up = false;
    bool told_up = false;
    // True if the outlet was notified that the queue is not empty.
    bool queued = false;
    // True if the far side reads outgoing frames from the ring. They are then counted, never queued.
    bool finds_in_ring = false;
    Signature* signature = nullptr;
    LinkCounters counters;
    net::BlockQueue queue;
    wire::SequenceTracker tracker;
};

}  // namespace mavloom::link::detail
