// SPDX-License-Identifier: MIT
#include "link/udp/peers.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace mavloom::link::detail {

UdpPeers::~UdpPeers() {
    core_.loop().unwatch(watch_);
    core_.loop().cancel_timer(expiry_);
}

bool UdpPeers::close(LinkId link) {
    UdpPeer* const peer = peers_.find(link);
    if (peer == nullptr) return false;
    drop(*peer, "closed");
    return true;
}

// Returns true if the datagram proves that its sender is a MAVLink peer. With verify=, the proof is a good signature on
// a frame that no endpoint has heard before. Without it, the proof is a good checksum of a defined message. Wrongly
// signed frames count in the endpoint's `gone` sums. Looks only at the beginning, because anybody may send large
// datagrams of junk.
bool UdpPeers::is_from_a_peer(const net::Datagram& datagram) {
    Signature* const signature = endpoint_.signature.get();
    const bool verifies = signature != nullptr && signature->verifies();
    bool found = false;
    std::uint64_t refused = 0;
    constexpr std::size_t max_bytes = 300;  // the longest frame has 280
    const auto beginning = datagram.bytes.first(std::min(datagram.bytes.size(), max_bytes));
    newcomer_parser_.parse(beginning, [&](const wire::ParseEvent& event) {
        if (found || event.kind != wire::ParseEvent::Kind::frame) return;
        found = verifies ? signature->accepts_early(event.frame, receive_time(datagram), core_.now())
                         : event.info != nullptr;
        if (verifies && !found && !signature->is_repeated()) ++refused;
    });
    if (!found) endpoint_.counters.gone.bad_signature.add(refused);
    return found;
}

bool UdpPeers::is_own_port(const UdpPort& port, std::uint16_t number) const {
    if (number == port.socket().local().port()) return true;
    return !core_.key_store.endpoints_are_independent && core_.endpoints.has_udp_port(number);
}

// Such a source is forged: nobody could receive an answer there, or a socket of this process or a whole network would.
bool UdpPeers::may_be_peer(const UdpPort& port, const net::Address& sender) {
    const net::Address from = sender.unmapped();
    if (from.port() == 0 || from.is_any() || from.is_multicast()) return false;
    if (is_own_port(port, from.port()) && core_.own_addresses.contains(from, core_.now())) return false;
    return !core_.own_addresses.has_broadcast(from, core_.now());
}

bool UdpPeers::may_enter(const net::Address& sender) {
    const auto answer = policy_.ask(sender, core_.now());
    if (answer == PeerPolicy::Answer::refused) endpoint_.counters.peers_refused.add();
    if (answer == PeerPolicy::Answer::limited) endpoint_.counters.peers_limited.add();
    return answer == PeerPolicy::Answer::admitted;
}

UdpPeer* UdpPeers::newcomer(UdpPort& port, const net::Datagram& datagram) {
    if (!may_be_peer(port, *datagram.from)) {
        endpoint_.counters.bad_source.add();
        return nullptr;
    }
    if (!may_enter(*datagram.from)) return nullptr;
    if (!is_from_a_peer(datagram)) {
        endpoint_.counters.stray_bytes.add(datagram.bytes.size());
        return nullptr;
    }
    policy_.note_entry(core_.now());
    if (!make_room(*datagram.from)) {
        endpoint_.counters.peers_refused.add();
        return nullptr;
    }
    const EndpointInfo& info = endpoint_.info;
    auto peer = std::make_unique<UdpPeer>(info.id, info.endpoint.options, core_.dialects.of(info.id).table, port,
                                          *datagram.from);
    peer->name = fmt::format("{}#{}", info.label(), datagram.from->text());
    peer->last_heard = peer->first_heard = core_.now();  // until its first frame is found
    const Rank rank = core_.rank_of(info.endpoint.options, *datagram.from);
    // A stranger may have forged its address, so it gets little before it repeats itself.
    if (rank == Rank::stranger && !verifies()) peer->give_allowance();
    else note_confirmed(*peer);
    if (!datagram.from->is_loopback()) watch_neighbours();
    port.peers().add(*datagram.from, *peer);
    if (!expiry_.valid()) expiry_ = core_.loop().start_timer(core_.now() + idle_, *this);
    return &peers_.add(std::move(peer), rank);
}

// If the kernel allows no watch, frames to hosts that are gone delay those to others.
void UdpPeers::watch_neighbours() {
    if (neighbours_) return;
    auto opened = net::NeighbourWatch::open();
    if (!opened) return;
    auto watch = core_.loop().watch(opened->fd(), true, false, *this);
    if (!watch) return;
    watch_ = *watch;
    neighbours_ = std::move(*opened);
}

// While the kernel looks for a host, datagrams for it stay in the socket's send buffer. Those for two such hosts fill
// it, so that all other peers wait.
void UdpPeers::on_io(net::IoEvents) {
    for (const auto& change : neighbours_.read())
        peers_.each([&](UdpPeer& peer) {
            if (peer.address.unmapped().with_port(0) == change.host) note_host(peer, change);
        });
}

void UdpPeers::note_host(UdpPeer& peer, const net::NeighbourWatch::Change& change) {
    const bool was_missing = peer.is_missing(core_.now());
    if (change.answers && !was_missing) return;
    // Two interfaces may lead to equal networks.
    const auto bound = net::index_of_zone(endpoint_.info.endpoint.options.iface);
    if (change.interface != net::interface_to(change.host, peer.port->socket().local(), bound)) return;
    if (change.answers) peer.note_found();
    else peer.note_missing(change.interface, core_.now());
    if (was_missing == change.answers) report(peer, change.answers);
}

void UdpPeers::report(const UdpPeer& peer, bool answers) {
    if (!reports_.take(core_.now())) return;
    core_.events.notice(endpoint_.info.id,
                        fmt::format("{}: its host {}", peer.name,
                                    answers ? "answers again" : "does not answer on its network; frames for it wait"));
}

bool UdpPeers::verifies() const { return endpoint_.signature && endpoint_.signature->verifies(); }

bool UdpPeers::make_room(const net::Address& newcomer) {
    if (!peers_.is_full()) return true;
    auto candidates = peers_.candidates();
    if (const auto silent = PeerPolicy::to_evict(candidates, core_.now())) {
        endpoint_.counters.peers_evicted.add();
        drop(*peers_.find(*silent), "max_peers is reached, and this peer was silent longest");
        return true;
    }
    // All peers are active. Verified ones keep their places.
    if (!policy_.repeats(newcomer, core_.now()) || verifies()) return false;
    const auto active = policy_.to_displace(std::move(candidates), core_.now());
    if (!active) return false;
    endpoint_.counters.peers_displaced.add();
    drop(*peers_.find(*active), "max_peers is reached, and others wait");
    return true;
}

void UdpPeers::note_confirmed(const UdpPeer& peer) {
    if (++confirmed_ == 1) owner_.on_first_confirmed(peer.address);
}

void UdpPeers::drop(UdpPeer& peer, std::string_view why) {
    const bool was_last = peer.is_confirmed() && --confirmed_ == 0;
    peer.settle();
    peers_.remove(peer, why);
    peer.port->forget(peer);  // after the handler, which may still have sent to this peer
    if (was_last) owner_.on_last_confirmed_gone();
}

// Runs when the peer that has been idle longest may have expired.
void UdpPeers::on_timer(MonoTime now) {
    const MonoTime next = peers_.expire(now, idle_, [&](UdpPeer& peer) { drop(peer, "idle"); });
    expiry_ = peers_.empty() ? net::TimerId{} : core_.loop().start_timer(next, *this);
}

}  // namespace mavloom::link::detail
