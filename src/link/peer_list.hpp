// SPDX-License-Identifier: MIT
// The peers, clients or senders of an endpoint that may have several. Private to module link; single owner thread.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "link/core/core.hpp"
#include "link/eviction.hpp"

namespace mavloom::link::detail {

// `Peer` is a Link with `last_heard`. The destructor removes the remaining peers and destroys them
// immediately, so it must not run inside a callback.
template <class Peer>
class PeerList {
public:
    PeerList(Core& core, OpenEndpoint& endpoint) : core_(core), endpoint_(endpoint) {}
    PeerList(const PeerList&) = delete;
    PeerList& operator=(const PeerList&) = delete;
    ~PeerList() {
        for (const auto& peer : peers_) core_.remove_link(*peer, "closed");
    }

    [[nodiscard]] bool empty() const noexcept { return peers_.empty(); }
    [[nodiscard]] std::size_t size() const noexcept { return peers_.size(); }
    [[nodiscard]] bool is_full() const noexcept { return size() >= endpoint_.info.endpoint.options.max_peers; }
    [[nodiscard]] std::vector<Peer*> all() const {
        std::vector<Peer*> list(peers_.size());
        std::ranges::transform(peers_, list.begin(), &std::unique_ptr<Peer>::get);
        return list;
    }
    // Returns null if no peer has this link id.
    [[nodiscard]] Peer* find(LinkId link) const noexcept {
        const auto at = std::ranges::find_if(peers_, [&](const auto& peer) { return peer->id == link; });
        return at == peers_.end() ? nullptr : at->get();
    }

    // Makes the peer a link, and notifies the handler.
    Peer& add(std::unique_ptr<Peer> peer) {
        peer->signature = endpoint_.signature.get();
        core_.add_link(*peer);
        Peer& added = *peers_.emplace_back(std::move(peer));
        core_.events.mark_up(added);
        return added;
    }
    // Notifies the handler, adds the peer's counters to the endpoint's sums, and destroys it at the end of the turn.
    void remove(Peer& peer, std::string_view why) {
        core_.remove_link(peer, why);
        endpoint_.count_gone(peer);
        const auto at = std::ranges::find_if(peers_, [&](const auto& p) { return p.get() == &peer; });
        core_.bury(std::move(*at));
        *at = std::move(peers_.back());
        peers_.pop_back();
    }
    // Calls drop(Peer&), which must remove the peer, for each peer that has been silent for `idle`. Returns the
    // earliest time at which another peer can expire.
    template <class Drop>
    MonoTime expire(MonoTime now, Nanoseconds idle, Drop&& drop) {
        MonoTime oldest = now;
        for (std::size_t i = peers_.size(); i-- > 0;) {
            if (now - peers_[i]->last_heard >= idle) drop(*peers_[i]);
            else oldest = std::min(oldest, peers_[i]->last_heard);
        }
        return oldest + idle;
    }
    // See eviction.hpp.
    [[nodiscard]] Peer* to_evict(MonoTime now) const { return detail::to_evict(all(), now); }

    // Queues the frame for all peers that are up. Returns how many took it.
    std::size_t send(const wire::FrameView& frame) {
        OutgoingFrame outgoing(frame);
        std::size_t taken = 0;
        for (const auto& peer : peers_) taken += peer->up && Core::send(*peer, outgoing, core_.now()) ? 1 : 0;
        return taken;
    }
    [[nodiscard]] std::size_t queued_bytes() const noexcept {
        std::size_t sum = 0;
        for (const auto& peer : peers_) sum += peer->queue.bytes();
        return sum;
    }

private:
    Core& core_;
    OpenEndpoint& endpoint_;
    std::vector<std::unique_ptr<Peer>> peers_;
};

}  // namespace mavloom::link::detail
