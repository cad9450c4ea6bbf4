// SPDX-License-Identifier: MIT
// The shared-memory rings of Sources. One owner thread, beside which shm::RingWaiter's sleeps.
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

    [[nodiscard]] static SetupResult<void> check(const endpoint::Endpoint& endpoint);
    [[nodiscard]] SetupResult<link::EndpointId> add(const endpoint::Endpoint& endpoint,
                                                    const dialect::Dialect* dialect = nullptr);
    void remove(link::EndpointId ring);
    // Null where there is none.
    [[nodiscard]] RingSource* find(link::EndpointId ring) const noexcept;
    [[nodiscard]] bool empty() const noexcept { return rings_.empty(); }

    // When to play next, and asks to be woken before when something is written.
    [[nodiscard]] MonoTime due(const Room& room);
    // Hands over what stands there; returns how many frames.
    std::size_t play(link::LinkHandler& handler, const Room& room);
    // What is written from now on is left in the rings.
    void end_here() noexcept;
    // Whether all that was written before is handed over.
    [[nodiscard]] bool at_end() const noexcept;

    // To each ring's inlet, which is opened with the first answer. Returns how many took it.
    std::size_t send(const wire::FrameView& frame);
    [[nodiscard]] std::span<const std::unique_ptr<RingSource>> rings() const noexcept { return rings_; }

private:
    void watch_changed();

    link::Links& links_;
    const wire::MessageTable& table_;
    Copies copies_;
    shm::RingWaiter waiter_;
    std::vector<std::unique_ptr<RingSource>> rings_;
    std::vector<std::uint64_t> watched_;  // which opening of each ring the waiter sleeps on; 0: none
    std::size_t first_ = 0;
    RingLinkIds link_ids_;
};

}  // namespace mavloom::ring
