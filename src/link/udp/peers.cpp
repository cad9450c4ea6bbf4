// SPDX-License-Identifier: MIT
#include "link/udp/peers.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace mavloom::link::detail {

UdpPeers::~UdpPeers() { core_.loop().cancel_timer(expiry_); }

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
    constexpr std::size_t most_bytes = 300;  // the longest frame has 280
    const auto beginning = datagram.bytes.first(std::min(datagram.bytes.size(), most_bytes));
    stranger_.parse(beginning, [&](const wire::ParseEvent& event) {
        if (found || event.kind != wire::ParseEvent::Kind::frame) return;
        found = verifies ? signature->accepts_early(event.frame, receive_time(datagram)) : event.info != nullptr;
        if (verifies && !found && !signature->is_repeated()) ++refused;
    });
    if (!found) endpoint_.counters.gone.bad_signature.add(refused);
    return found;
}

bool UdpPeers::is_own_port(const UdpPort& port, std::uint16_t number) const {
    if (number == port.socket().local().port()) return true;
    return !core_.key_states.endpoints_are_independent && core_.endpoints.has_udp_port(number);
}

// Such a source is forged: nobody could receive an answer there, or a socket of this process or a whole network would.
bool UdpPeers::may_be_peer(const UdpPort& port, const net::Address& sender) {
    const net::Address from = sender.unmapped();
    if (from.port() == 0 || from.is_any() || from.is_multicast()) return false;
    if (is_own_port(port, from.port()) && own_.contains(from, core_.now())) return false;
    return !own_.has_broadcast(from, core_.now());
}

bool UdpPeers::may_enter(const net::Address& sender) {
    const auto answer = admission_.ask(sender, core_.now());
    if (answer == Admission::Answer::refused) endpoint_.counters.peers_refused.add();
    if (answer == Admission::Answer::limited) endpoint_.counters.peers_limited.add();
    return answer == Admission::Answer::admitted;
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
    admission_.note_entry();
    if (!make_room(*datagram.from)) {
        endpoint_.counters.peers_refused.add();
        return nullptr;
    }
    const EndpointInfo& info = endpoint_.info;
    auto peer = std::make_unique<UdpPeer>(info.id, info.endpoint.options, core_.dialects.of(info.id).table, port,
                                          *datagram.from);
    peer->name = fmt::format("{}#{}", info.label(), datagram.from->text());
    peer->last_heard = peer->first_heard = core_.now();  // until its first frame is found
    if (must_confirm(*datagram.from)) peer->give_allowance();
    else note_confirmed(*peer);
    port.peers().add(*datagram.from, *peer);
    if (!expiry_.valid()) expiry_ = core_.loop().start_timer(core_.now() + idle_, *this);
    return &peers_.add(std::move(peer));
}

// Returns true if the sender's address may be forged: then the peer gets little before it repeats itself.
bool UdpPeers::must_confirm(const net::Address& sender) const {
    const auto& options = endpoint_.info.endpoint.options;
    return !sender.is_loopback() && !options.trusted && !verifies();
}

bool UdpPeers::verifies() const { return endpoint_.signature && endpoint_.signature->verifies(); }

bool UdpPeers::make_room(const net::Address& newcomer) {
    if (!peers_.is_full()) return true;
    UdpPeer* const first = peers_.to_evict(core_.now());
    if (first == nullptr) return displace_for(newcomer);
    endpoint_.counters.peers_evicted.add();
    drop(*first, "max_peers is reached, and this peer was silent longest");
    return true;
}

void UdpPeers::note_confirmed(const UdpPeer& peer) {
    if (++confirmed_ == 1) owner_.on_first_confirmed(peer.address);
}

// All peers talk. Verified ones keep their places.
bool UdpPeers::displace_for(const net::Address& newcomer) {
    if (!admission_.note_and_check_repeat(newcomer, core_.now()) || verifies()) return false;
    UdpPeer* const peer = displacement_.choose(peers_.all(), core_.now());
    if (peer == nullptr) return false;
    endpoint_.counters.peers_displaced.add();
    drop(*peer, "max_peers is reached, and others wait");
    return true;
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
