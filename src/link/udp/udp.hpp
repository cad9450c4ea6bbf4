// SPDX-License-Identifier: MIT
// udpin, udpout, udpbcast and udpmcast: a socket with its peers, each peer a link. Private to module link; one owner thread.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "link/core.hpp"
#include "link/udp/peer_table.hpp"
#include "mavloom/net/udp.hpp"
#include "mavloom/wire/datagram_parser.hpp"

namespace mavloom::link::detail {

class UdpPort;

struct UdpPeer final : Link {
    UdpPeer(EndpointId owner, const net::BlockQueue::Limits& limits, const wire::MessageTable& table, UdpPort& p,
            const net::Address& a)
        : Link(owner, limits), port(&p), address(a), parser(table) {}
    void schedule() override;

    UdpPort* port;
    net::Address address;
    wire::DatagramParser parser;
    // Datagrams with a good frame count; those of junk do not keep a peer.
    MonoTime last_heard{};
    std::uint64_t datagrams = 0;
    bool held = false;  // the device's queue had no room for it: waits for its port's retry

    void note_heard(MonoTime now) noexcept;
    // The far side's port is closed. Not every datagram that meets it is reported: what is sent in the next second counts as refused.
    void note_refusal(MonoTime now) noexcept;
    // The far side is somewhere else now: what the old address refused says nothing of it.
    void move_to(const net::Address& where) noexcept;
    // Frames to a peer that has not been heard since its last refusal, or never, are counted by `settle`.
    void count_sent(std::uint32_t frames, std::uint32_t bytes, MonoTime now) noexcept;
    // No refusal has come of what was sent: it counts as sent.
    void settle() noexcept;
    [[nodiscard]] bool is_settled() const noexcept { return unsettled_frames_ == 0; }

private:
    static constexpr std::chrono::seconds refusal_holds{1};
    bool listens_ = false;  // heard, and not refused since
    MonoTime refuses_until_{};
    std::uint32_t unsettled_frames_ = 0, unsettled_bytes_ = 0;
};

// The kernel's time stamp; where it gave none, now.
[[nodiscard]] inline WallTime receive_time(const net::Datagram& datagram) {
    return datagram.time == WallTime{} ? wall_now() : datagram.time;
}

// What an endpoint decides about its sockets' datagrams.
class UdpOwner {
public:
    virtual ~UdpOwner() = default;
    // Whose datagram this is; null: nobody's, and it is counted.
    [[nodiscard]] virtual UdpPeer* peer_of(UdpPort& port, const net::Datagram& datagram) = 0;
    // The peer at this address; null where there is none.
    [[nodiscard]] virtual UdpPeer* find_peer(UdpPort& port, const net::Address& address) const;
    // The kernel or the network refused a datagram.
    virtual void on_send_error(net::IoError error) = 0;
};

// One socket: reads a batch a turn, and sends what its peers queued with one sendmmsg a turn.
class UdpPort final : public Outlet, public net::IoHandler, public net::TimerHandler {
public:
    UdpPort(Core& core, UdpOwner& owner, EndpointCounters& counters, std::uint32_t mtu_bytes)
        : core_(core), owner_(owner), counters_(counters), mtu_bytes_(mtu_bytes) {}
    ~UdpPort() override;

    [[nodiscard]] SetupResult<void> open(const net::Address& local, const net::UdpOptions& options);
    [[nodiscard]] const net::UdpSocket& socket() const noexcept { return socket_; }
    [[nodiscard]] PeerTable<UdpPeer>& peers() noexcept { return peers_; }

    void schedule(UdpPeer& peer) {
        waiting_.push_back(&peer);
        core_.schedule(*this);
    }
    // The peer is about to go.
    void forget(UdpPeer& peer) noexcept;
    void refresh_kernel_drops() noexcept;
    // Counts what was sent, after a look at the refusals that have come until now.
    void settle();

    void on_io(net::IoEvents events) override;
    void on_timer(MonoTime now) override;
    void flush() override;
    [[nodiscard]] bool blocked() const override { return blocked_ || retry_.valid(); }
    void expire(MonoTime now) override;

private:
    struct Part {  // of the batch being built: one datagram
        UdpPeer* peer;
        net::BlockQueue::Position until;
        std::uint32_t frames, bytes;
    };

    void receive();
    bool submit();
    void recover(std::size_t& index, net::IoError error, int& refusals);
    void account(const Part& part) noexcept;
    void take_failures();
    void settle_sent() noexcept;
    void block();
    void hold(std::size_t& index);

    Core& core_;
    UdpOwner& owner_;
    EndpointCounters& counters_;
    std::uint32_t mtu_bytes_;
    net::UdpSocket socket_;
    net::WatchId watch_;
    net::TimerId retry_;  // for peers that are held
    PeerTable<UdpPeer> peers_;
    std::vector<UdpPeer*> waiting_;  // with something queued
    std::vector<Part> parts_;
    bool blocked_ = false;  // the socket's own buffer is full
    std::vector<UdpPeer*> unsettled_;
    std::uint64_t unsettled_turn_ = 0;  // Core::turns() when they were sent to
    std::uint32_t last_drops_ = 0;
};

// What the options of an endpoint ask of its sockets.
[[nodiscard]] net::UdpOptions udp_options(const endpoint::EndpointOptions& endpoint);

// They make the endpoint at once or say why not.
[[nodiscard]] SetupResult<std::unique_ptr<OpenEndpoint>> open_udpin(Opening opening);
[[nodiscard]] SetupResult<std::unique_ptr<OpenEndpoint>> open_udpout(Opening opening);
[[nodiscard]] SetupResult<std::unique_ptr<OpenEndpoint>> open_udpbcast(Opening opening);
[[nodiscard]] SetupResult<std::unique_ptr<OpenEndpoint>> open_udpmcast(Opening opening);

}  // namespace mavloom::link::detail
