// SPDX-License-Identifier: MIT
#include "link/udp/peers.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "link/peer_room.hpp"

namespace mavloom::link::detail {

UdpPeers::~UdpPeers() {
    core_.loop().cancel_timer(expiry_);
    while (!peers_.empty()) drop(peers_.size() - 1, "closed");
}

std::size_t UdpPeers::send(const wire::FrameView& frame) {
    std::size_t taken = 0;
    for (const auto& peer : peers_) taken += core_.send(*peer, frame) ? 1 : 0;
    return taken;
}

bool UdpPeers::close(LinkId link) {
    const auto peer = std::ranges::find_if(peers_, [&](const auto& p) { return p->id == link; });
    if (peer == peers_.end()) return false;
    drop(static_cast<std::size_t>(peer - peers_.begin()), "closed");
    if (peers_.empty()) owner_.on_last_peer_gone();
    return true;
}

std::size_t UdpPeers::queued_bytes() const {
    std::size_t sum = 0;
    for (const auto& peer : peers_) sum += peer->queue.bytes();
    return sum;
}

// With verify= a good signature vouches for the sender. Without it, a good checksum of a defined message does; an id
// without definition is not enough. Wrongly signed frames count in the endpoint's `gone` sums.
bool UdpPeers::vouched_for(const net::Datagram& datagram) {
    Signature* const signature = endpoint_.signature.get();
    const bool verifies = signature != nullptr && signature->verifies();
    bool found = false;
    std::uint64_t refused = 0;
    stranger_.parse(datagram.bytes, [&](const wire::ParseEvent& event) {
        if (found || event.kind != wire::ParseEvent::Kind::frame) return;
        found = verifies ? signature->vouches(event.frame, receive_time(datagram)) : event.info != nullptr;
        if (verifies && !found) ++refused;
    });
    if (!found) endpoint_.counters.gone.bad_signature.add(refused);
    return found;
}

UdpPeer* UdpPeers::newcomer(UdpPort& port, const net::Datagram& datagram) {
    if (!vouched_for(datagram)) {
        endpoint_.counters.stray_bytes.add(datagram.bytes.size());
        return nullptr;
    }
    if (!make_room()) {
        endpoint_.counters.peers_refused.add();
        return nullptr;
    }
    if (peers_.empty()) owner_.on_first_peer(*datagram.from);
    const EndpointInfo& info = endpoint_.info;
    auto peer = std::make_unique<UdpPeer>(info.id, queue_limits(info.endpoint.options),
                                          core_.languages.of(info.id).table, port, *datagram.from);
    peer->name = fmt::format("{}#{}", info.label(), datagram.from->text());
    peer->signature = endpoint_.signature.get();
    peer->last_heard = core_.now();  // until its first frame is found
    core_.add_link(*peer);
    port.peers().add(*datagram.from, *peer);
    peers_.push_back(std::move(peer));
    if (!expiry_.valid()) expiry_ = core_.loop().start_timer(core_.now() + idle_, *this);
    core_.news.set_up(*peers_.back());
    return peers_.back().get();
}

bool UdpPeers::make_room() {
    if (peers_.size() < endpoint_.info.endpoint.options.max_peers) return true;
    const auto first = gives_way(peers_, core_.now());
    if (first == peers_.end()) return false;
    endpoint_.counters.peers_evicted.add();
    drop(static_cast<std::size_t>(first - peers_.begin()),
         "more peers than max_peers, and this one was silent for longest");
    return true;
}

void UdpPeers::drop(std::size_t index, std::string_view why) {
    UdpPeer& peer = *peers_[index];
    peer.settle();
    core_.remove_link(peer, why);
    endpoint_.count_gone(peer);
    peer.port->forget(peer);
    core_.bury(std::move(peers_[index]));
    peers_[index] = std::move(peers_.back());
    peers_.pop_back();
}

// Runs when the longest idle peer may have expired, and then when the next one may.
void UdpPeers::on_timer(MonoTime now) {
    MonoTime oldest = now;
    for (std::size_t i = peers_.size(); i-- > 0;) {
        if (now - peers_[i]->last_heard >= idle_) {
            drop(i, "idle");
        } else {
            oldest = std::min(oldest, peers_[i]->last_heard);
        }
    }
    expiry_ = peers_.empty() ? net::TimerId{} : core_.loop().start_timer(oldest + idle_, *this);
    if (peers_.empty()) owner_.on_last_peer_gone();
}

}  // namespace mavloom::link::detail
