// SPDX-License-Identifier: MIT
#include "mavloom/ring/sources.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "mavloom/dialect/dialect.hpp"

namespace mavloom::ring {

RingSources::RingSources(link::Links& links, const wire::MessageTable& table, Copies copies)
    : links_(links), table_(table), copies_(copies), waiter_([&links] { links.wake(); }) {}

SetupResult<link::EndpointId> RingSources::add(const endpoint::Endpoint& endpoint, const dialect::Dialect* dialect) {
    if (auto checked = endpoint::check_supported(endpoint, endpoint::RoutingOptions::refused); !checked)
        return tl::unexpected(std::move(checked.error()));
    const auto same = [&](const auto& ring) { return ring->endpoint().label() == endpoint.label(); };
    if (!links_.allows_same_address(endpoint) && std::ranges::any_of(rings_, same))
        return setup_error(
            SetupCode::usage,
            fmt::format("two endpoints are named {}; remove one of them, or give it another name=", endpoint.label()));
    auto ring = std::make_unique<RingSource>(endpoint, dialect == nullptr ? table_ : dialect->wire_table(), links_,
                                             copies_, dialect);
    if (auto opened = ring->open(); !opened) return tl::unexpected(std::move(opened.error()));
    rings_.push_back(std::move(ring));
    return rings_.back()->id();
}

// Updates the waiter, so that it no longer sleeps on the removed ring.
void RingSources::remove(link::EndpointId ring) {
    std::erase_if(rings_, [&](const auto& known) { return known->id() == ring; });
    watch_changed();
}

RingSource* RingSources::find(link::EndpointId ring) const noexcept {
    const auto found = std::ranges::find(rings_, ring, [](const auto& known) { return known->id(); });
    return found == rings_.end() ? nullptr : found->get();
}

// Passes the open rings to the waiter if any was opened or closed since the last call.
void RingSources::watch_changed() {
    const auto opening = [](const auto& ring) { return ring->follower().is_open() ? ring->follower().opened() : 0; };
    if (std::ranges::equal(rings_, watched_, {}, opening)) return;
    watched_.clear();
    std::ranges::transform(rings_, std::back_inserter(watched_), opening);
    std::vector<shm::RingWaiter::WakeWord> words;
    for (const auto& ring : rings_)
        if (auto* const reader = ring->follower().reader()) words.push_back(reader->wake_word());
    waiter_.watch(std::move(words));
}

// Arms the waiter before the rings. A writer that sees a ring's request thus finds the waiter ready.
MonoTime RingSources::due(const Room& room) {
    if (rings_.empty()) return MonoTime::max();
    watch_changed();
    waiter_.arm();
    const MonoTime now = mono_now();
    MonoTime due = MonoTime::max();
    for (const auto& ring : rings_)
        due = std::min(due, ring->due((ring->lossless() ? room.lossless : room.lossy) != 0, now));
    return due;
}

std::size_t RingSources::play(link::LinkHandler& handler, const Room& room) {
    if (rings_.empty()) return 0;
    waiter_.disarm();
    std::size_t played = 0;
    Room left = room;
    first_ = (first_ + 1) % rings_.size();  // rotates the order, so that no ring is always last
    for (std::size_t i = 0; i < rings_.size(); ++i) {
        RingSource& ring = *rings_[(first_ + i) % rings_.size()];
        std::size_t& most = ring.lossless() ? left.lossless : left.lossy;
        const std::size_t frames = ring.play(handler, most);
        most -= frames;
        played += frames;
    }
    return played;
}

void RingSources::stop_at_current_end() noexcept {
    for (const auto& ring : rings_) ring->stop_at_current_end();
}

bool RingSources::at_end() const noexcept {
    return std::ranges::all_of(rings_, [](const auto& ring) { return ring->at_end(); });
}

std::size_t RingSources::send(const wire::FrameView& frame) {
    std::size_t takers = 0;
    for (const auto& ring : rings_) takers += ring->send(frame) ? 1 : 0;
    return takers;
}

}  // namespace mavloom::ring
