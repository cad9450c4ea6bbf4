// SPDX-License-Identifier: MIT
// The peers, clients or senders of an endpoint that may have several. Private to module link; single owner thread.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "link/core/core.hpp"
#include "link/peer_policy.hpp"

namespace mavloom::link::detail {

// `Peer` is a Link with `last_heard` and `candidate`. The destructor removes the remaining peers and destroys them
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
    [[nodiscard]] std::vector<PeerPolicy::Candidate> candidates() const {
        std::vector<PeerPolicy::Candidate> list(peers_.size());
        std::ranges::transform(peers_, list.begin(), [](const auto& peer) { return peer->candidate(); });
        return list;
    }
    // Returns null if no peer has this link id.
    [[nodiscard]] Peer* find(LinkId link) const noexcept {
        const auto at = std::ranges::find_if(peers_, [&](const auto& peer) { return peer->id == link; });
        return at == peers_.end() ? nullptr : at->get();
    }

    template <class F>
    void each(F&& f) const {
        for (const auto& peer : peers_) f(*peer);
    }

    // Makes the peer a link, and notifies the handler.
    Peer& add(std::unique_ptr<Peer> peer, Rank rank) {
        assert(!is_full());
        peer->signature = endpoint_.signature.get();
        core_.add_link(*peer, rank);
        Peer& added = *peers_.emplace_back(std::move(peer));
        core_.events.mark_up(added);
        return added;
    }
    // Notifies the handler, adds the peer's counters to the endpoint's sums, and destroys it at the end of the turn.
    void remove(Peer& peer, std::string_view why) {
        core_.remove_link(peer, why);
        endpoint_.count_gone(peer);
        const auto at = std::ranges::find_if(peers_, [&](const auto& p) { return p.get() == &peer; });
        assert(at != peers_.end());
        core_.destroy_later(std::move(*at));
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
    // The client to close for a newcomer: a silent one, and only at a limited rate, unless the newcomer's host has at
    // least two silent clients fewer than another. Null if there is none.
    [[nodiscard]] Peer* to_close_for(const net::Address& newcomer, PeerPolicy& policy, MonoTime now) const {
        const auto all = candidates();
        const bool is_limited = !PeerPolicy::is_small(PeerPolicy::crowd_of(newcomer), all);
        if (is_limited && policy.ask(newcomer, now) != PeerPolicy::Answer::admitted) return nullptr;
        const auto first = PeerPolicy::to_evict(all, now);
        if (first && is_limited) policy.note_entry(now);
        return first ? find(*first) : nullptr;
    }

    // Queues the frame for all peers that are up. Returns how many took it.
    std::size_t send(const wire::FrameView& frame) {
        OutgoingFrame outgoing(frame);
        std::size_t taken = 0;
        for (const auto& peer : peers_) taken += peer->up && Core::send(*peer, outgoing, core_.now()) ? 1 : 0;
        return taken;
    }
    [[nodiscard]] std::size_t queued_bytes() const noexcept {
        std::size_t sum = 0;
        for (const auto& peer : peers_) sum += peer->queued_bytes();
        return sum;
    }

private:
    Core& core_;
    OpenEndpoint& endpoint_;
    std::vector<std::unique_ptr<Peer>> peers_;
};

}  // namespace mavloom::link::detail
