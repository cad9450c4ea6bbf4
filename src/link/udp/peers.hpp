// SPDX-License-Identifier: MIT
// The peers of an endpoint that accepts any sender. A sender of a valid frame becomes a peer with its own link, and
// remains one until it has been silent for `idle`. There are at most max_peers. Private to module link; single owner
// thread.
#pragma once

#include <string_view>

#include "link/peer_list.hpp"
#include "link/udp/udp.hpp"
#include "mavloom/net/neighbours.hpp"

namespace mavloom::link::detail {

class UdpPeers final : public net::IoHandler, public net::TimerHandler {
public:
    // The endpoint that owns the sockets.
    class Owner : public UdpOwner {
    public:
        // Called for the first peer that is confirmed, and when the last such peer is gone. A peer that needs no
        // confirmation is confirmed before its link is up.
        virtual void on_first_confirmed(const net::Address&) {}
        virtual void on_last_confirmed_gone() {}
        // A program on this machine may invent many peers, and a frame to each of them costs several system calls if
        // its port is closed. So such a peer gets little. Over a network, anybody can forge such a report.
        void on_refused(UdpPeer& peer, const net::Address& reporter) final {
            if (peer.address.is_loopback() && reporter.is_loopback()) peer.pause();
        }
    };

    static constexpr std::chrono::seconds default_idle{60};

    UdpPeers(Core& core, OpenEndpoint& endpoint, Owner& owner)
        : core_(core),
          endpoint_(endpoint),
          owner_(owner),
          idle_(endpoint.info.endpoint.options.idle.value_or(default_idle)),
          newcomer_parser_(core.dialects.of(endpoint.info.id).table),
          policy_(endpoint.info.endpoint.options.max_peers),
          peers_(core, endpoint) {}
    ~UdpPeers() override;

    // Returns the peer that sent the datagram. A new sender of a valid frame becomes a peer. Returns null for a new
    // sender without a valid frame, or if there is no room for another peer.
    [[nodiscard]] UdpPeer* of(UdpPort& port, const net::Datagram& datagram) {
        if (endpoint_.signature) endpoint_.signature->forget_accepted();
        if (UdpPeer* peer = port.peers().find(*datagram.from)) return peer;
        return newcomer(port, datagram);
    }
    std::size_t send(const wire::FrameView& frame) { return peers_.send(frame); }
    bool close(LinkId link);
    // Call it when a peer that entered unconfirmed is confirmed.
    void note_confirmed(const UdpPeer& peer);
    [[nodiscard]] std::size_t queued_bytes() const { return peers_.queued_bytes(); }
    [[nodiscard]] bool empty() const noexcept { return peers_.empty(); }
    void on_io(net::IoEvents events) override;
    void on_timer(MonoTime now) override;

private:
    void watch_neighbours();
    void note_host(UdpPeer& peer, const net::NeighbourWatch::Change& change);
    void report(const UdpPeer& peer, bool answers);
    UdpPeer* newcomer(UdpPort& port, const net::Datagram& datagram);
    [[nodiscard]] bool is_own_port(const UdpPort& port, std::uint16_t number) const;
    [[nodiscard]] bool may_be_peer(const UdpPort& port, const net::Address& sender);
    [[nodiscard]] bool may_enter(const net::Address& sender);
    [[nodiscard]] bool is_from_a_peer(const net::Datagram& datagram);
    [[nodiscard]] bool verifies() const;
    [[nodiscard]] bool make_room(const net::Address& newcomer);
    void drop(UdpPeer& peer, std::string_view why);

    Core& core_;
    OpenEndpoint& endpoint_;
    Owner& owner_;
    Nanoseconds idle_;
    wire::DatagramParser newcomer_parser_;
    PeerPolicy policy_;
    PeerList<UdpPeer> peers_;
    std::size_t confirmed_ = 0;  // peers
    net::TimerId expiry_;
    net::NeighbourWatch neighbours_;  // opened for the first peer on a network
    net::WatchId watch_;
    Pace reports_{std::chrono::seconds(1), 20};  // anybody may invent peers
};

}  // namespace mavloom::link::detail
