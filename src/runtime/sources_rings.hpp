// SPDX-License-Identifier: MIT
// The shared-memory rings of Sources. Private to module runtime; one owner thread, beside which shm::RingWaiter's sleeps.
#pragma once

#include <memory>
#include <vector>

#include "mavloom/runtime/sources.hpp"
#include "mavloom/shm/ring_waiter.hpp"
#include "runtime/ring_source.hpp"

namespace mavloom::runtime::detail {

class RingSources {
public:
    // `links` and `table` must outlive the object.
    RingSources(Links& links, const wire::MessageTable& table, Copies copies);

    [[nodiscard]] static SetupResult<void> check(const Endpoint& endpoint);
    [[nodiscard]] SetupResult<EndpointId> add(const Endpoint& endpoint, const dialect::Dialect* dialect = nullptr);
    void remove(EndpointId ring);
    // Null where there is none.
    [[nodiscard]] RingSource* find(EndpointId ring) const noexcept;
    [[nodiscard]] bool empty() const noexcept { return rings_.empty(); }

    // When to play next, and asks to be woken before when something is written.
    [[nodiscard]] MonoTime due(const Room& room);
    // Hands over what stands there; returns how many frames.
    std::size_t play(LinkHandler& handler, const Room& room);
    // What is written from now on is left in the rings.
    void end_here() noexcept;
    // Whether all that was written before is handed over.
    [[nodiscard]] bool at_end() const noexcept;

    // To each ring's inlet, which is opened with the first answer. Returns how many took it.
    std::size_t send(const wire::FrameView& frame);
    void add_to(Totals& totals) const noexcept;

private:
    void watch_changed();

    Links& links_;
    const wire::MessageTable& table_;
    Copies copies_;
    shm::RingWaiter waiter_;
    std::vector<std::unique_ptr<RingSource>> rings_;
    std::vector<std::uint64_t> watched_;  // which opening of each ring the waiter sleeps on; 0: none
    std::size_t first_ = 0;
    RingLinkIds link_ids_;
};

}  // namespace mavloom::runtime::detail
