// SPDX-License-Identifier: MIT
// udpin, udpout, udpbcast and udpmcast: a socket and its peers, each of them a link. Private to module link; single
// owner thread.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "link/core/core.hpp"
#include "link/core/read_budget.hpp"
#include "link/peer_policy.hpp"
#include "link/udp/peer_table.hpp"
#include "mavloom/base/pace.hpp"
#include "mavloom/net/port_holder.hpp"
#include "mavloom/net/udp.hpp"
#include "mavloom/wire/datagram_parser.hpp"

namespace mavloom::link::detail {

class UdpPort;

struct UdpPeer final : Link {
    UdpPeer(EndpointId owner, const endpoint::EndpointOptions& options, const wire::MessageTable& table, UdpPort& p,
            const net::Address& a)
        : Link(owner, options), port(&p), address(a), parser(table) {}
    void schedule() override;
    void hear(ByteView bytes, WallTime time) override;
    [[nodiscard]] bool is_missing(MonoTime now) const noexcept override { return now < missing_until_; }

    UdpPort* port;
    net::Address address;
    wire::DatagramParser parser;
    // Both count only datagrams with a good frame. Junk does not keep a peer alive.
    MonoTime first_heard{}, last_heard{};
    std::uint64_t datagrams = 0;
    // True if the network device's queue was full. The peer then waits for its port's retry.
    bool held = false;

    // Notes a datagram with a good frame. If it arrives at least 0.5 s after the peer's first one, it confirms that the
    // address is the peer's own. Returns true if this datagram did that.
    [[nodiscard]] bool note_heard(MonoTime now, std::size_t bytes) noexcept;
    [[nodiscard]] bool is_confirmed() const noexcept { return !has_allowance(); }
    // One datagram may be forged; a peer talks from the second on.
    [[nodiscard]] PeerPolicy::Candidate candidate() const noexcept { return {id, datagrams > 1, last_heard}; }
    // Notes that the far side's port is closed. ICMP does not report every datagram sent to a closed port, so frames
    // sent in the next second also count as refused.
    void note_refusal(MonoTime now) noexcept;
    // Notes that the kernel no longer finds the far side's host by this interface, or finds it again. It looks for the
    // host when something is sent to it: `search` does that, at most once a second.
    void note_missing(std::uint32_t interface, MonoTime now) noexcept;
    void note_found() noexcept;
    void search(MonoTime now) noexcept;
    // Changes the far side's address. Refusals from the old address are forgotten.
    void move_to(const net::Address& where) noexcept;
    // Counts sent frames at once only if the peer was heard since its last refusal. Otherwise `settle` counts them.
    void count_sent(std::uint32_t frames, std::uint32_t bytes, MonoTime now) noexcept;
    // Counts as sent the frames that were not refused.
    void settle() noexcept;
    [[nodiscard]] bool is_settled() const noexcept { return unsettled_frames_ == 0; }

private:
    static constexpr std::chrono::seconds refusal_holds{1};
    static constexpr std::chrono::milliseconds confirmed_after{500};
    // While datagrams are sent, the kernel announces every 3 s that it does not find the host. After this time without
    // an announcement, one that it finds the host may have been lost, or the route has changed.
    static constexpr std::chrono::seconds announced_within{10};
    static constexpr std::int64_t answers_per_byte = 3;  // to a peer that has not confirmed its address, as in QUIC
    bool listens_ = false;                               // the peer was heard, and has not refused anything since
    std::uint32_t interface_ = 0;                        // by which the host is missing
    MonoTime missing_until_{};
    Pace searches_{std::chrono::seconds(1), 1};
    std::uint32_t unsettled_frames_ = 0, unsettled_bytes_ = 0;
};

// The kernel's time stamp, or the current time if there is none.
[[nodiscard]] inline WallTime receive_time(const net::Datagram& datagram) {
    return datagram.time == WallTime{} ? wall_now() : datagram.time;
}

// Decides, for an endpoint, which peer a datagram belongs to.
class UdpOwner {
public:
    virtual ~UdpOwner() = default;
    // Returns the peer that sent the datagram, or null if the port should drop the datagram. The endpoint has then
    // counted it already, unless the datagram is the endpoint's own and was looped back.
    [[nodiscard]] virtual UdpPeer* peer_of(UdpPort& port, const net::Datagram& datagram) = 0;
    // The peer at this address; null if there is none.
    [[nodiscard]] virtual UdpPeer* find_peer(UdpPort& port, const net::Address& address) const;
    // Called when a datagram has confirmed the peer's address: see UdpPeer::note_heard.
    virtual void on_confirmed(UdpPeer&) {}
    // Called when `reporter` has reported that nobody listens at the peer's address.
    virtual void on_refused(UdpPeer&, const net::Address& /*reporter*/) {}
    // Called when the kernel has rejected a datagram, or the network an earlier one. `peer`: for whom the earlier one
    // was, if that is known.
    virtual void on_send_error(net::IoError error, const UdpPeer* peer) = 0;

    net::BindErrors bind_errors{net::Transport::udp};
};

// One socket. Reads one batch per turn. At the end of the turn, sends the frames that its peers have queued, with
// sendmmsg.
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
        core_.outlets.schedule(*this);
    }
    // Parses a datagram of the peer that has passed stages.
    void hear(UdpPeer& peer, ByteView bytes, WallTime time);
    // Call it before a peer is destroyed.
    void forget(UdpPeer& peer) noexcept;
    void refresh_kernel_drops() noexcept;
    // Reads the refusals that have arrived, then counts the remaining frames as sent.
    void settle();

    void on_io(net::IoEvents events) override;
    void on_timer(MonoTime now) override;
    void flush() override;
    [[nodiscard]] bool blocked() const override { return blocked_ || retry_.valid() || waits_; }
    void expire(MonoTime now) override;

private:
    struct Part {  // one datagram of the batch being built
        UdpPeer* peer;
        net::LaneQueue::Position until;
        std::uint32_t frames, bytes;
    };

    void receive();
    void receive(const net::ReceiveBatch& batch);
    void parse(UdpPeer& peer, ByteView bytes, WallTime time);
    void gather(UdpPeer& peer);
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
    net::TimerId retry_;  // for held peers
    PeerTable<UdpPeer> peers_;
    std::vector<UdpPeer*> waiting_;  // peers that have frames queued
    std::vector<Part> parts_;
    bool blocked_ = false;  // the socket's send buffer is full
    bool waits_ = false;    // the last flush has left peers that are held or missing
    std::vector<UdpPeer*> unsettled_;
    std::uint64_t unsettled_turn_ = 0;  // Core::turns() when frames were sent to the peers in `unsettled_`
    std::uint32_t last_drops_ = 0;
    ReadBudget budget_{1, net::ReceiveBatch::slots};
};

// The socket options that an endpoint's options require.
[[nodiscard]] net::UdpOptions udp_options(const endpoint::EndpointOptions& endpoint);

}  // namespace mavloom::link::detail
