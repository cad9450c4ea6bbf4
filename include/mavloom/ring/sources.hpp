// SPDX-License-Identifier: MIT
// The set of shared-memory rings that a program reads frames from. One owner thread; the RingWaiter inside runs a
// helper thread of its own.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "mavloom/ring/room.hpp"
#include "mavloom/ring/source.hpp"
#include "mavloom/shm/ring_waiter.hpp"

namespace mavloom::ring {

class RingSources {
public:
    // `links` and `table` must outlive the object.
    RingSources(link::Links& links, const wire::MessageTable& table, Copies copies);

    [[nodiscard]] SetupResult<link::EndpointId> add(const endpoint::Endpoint& endpoint,
                                                    const dialect::Dialect* dialect = nullptr);
    void remove(link::EndpointId ring);
    // Returns null if there is no such ring.
    [[nodiscard]] RingSource* find(link::EndpointId ring) const noexcept;
    [[nodiscard]] bool empty() const noexcept { return rings_.empty(); }

    // Returns when to call play next. Asks to be woken earlier when a record is written.
    [[nodiscard]] MonoTime due(const Room& room);
    // Delivers the waiting frames. Returns how many.
    std::size_t play(link::LinkHandler& handler, const Room& room);
    // Reads no further than the current end of each ring. Later records stay in the rings.
    void stop_at_current_end() noexcept;
    // Returns whether everything up to those ends was delivered.
    [[nodiscard]] bool at_end() const noexcept;

    // Sends a frame to each ring's inlet. The first frame opens the inlet. Returns how many inlets accepted the frame.
    std::size_t send(const wire::FrameView& frame);
    [[nodiscard]] std::span<const std::unique_ptr<RingSource>> rings() const noexcept { return rings_; }

private:
    void watch_changed();

    link::Links& links_;
    const wire::MessageTable& table_;
    Copies copies_;
    shm::RingWaiter waiter_;
    std::vector<std::unique_ptr<RingSource>> rings_;
    std::vector<std::uint64_t> watched_;  // for each ring, the value of opened() that the waiter watches; 0: none
    std::size_t first_ = 0;
};

}  // namespace mavloom::ring
