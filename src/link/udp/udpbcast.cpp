// SPDX-License-Identifier: MIT
// udpbcast: broadcasts until a peer answers and is confirmed. Then only the peers that answered receive frames, each
// over its own link, until the last confirmed one is silent for `idle`. A single datagram, whose sender may be forged,
// does not end the broadcast. With fixed=true a single link broadcasts to, and hears, everyone.
#include <fmt/format.h>

#include "link/resolve_and_open.hpp"
#include "link/retry.hpp"
#include "link/udp/peers.hpp"

namespace mavloom::link::detail {

namespace {

class UdpBroadcast final : public OpenEndpoint, public NameUser, public UdpPeers::Owner, public net::TimerHandler {
public:
    UdpBroadcast(Opening& opening, std::optional<net::Address> local)
        : OpenEndpoint(opening),
          NameUser(opening.core.look_ups),
          core_(opening.core),
          local_(local),
          port_(opening.core, *this, counters, opening.endpoint.options.mtu_bytes),
          everybody_(opening.id, opening.endpoint.options, opening.core.dialects.of(opening.id).table, port_,
                     net::Address{}),
          peers_(opening.core, *this, *this),
          retry_(opening.core, *this, *this) {
        everybody_.name = opening.endpoint.label();
        everybody_.signature = signature.get();
        core_.add_link(everybody_, opening.endpoint.options.trusted.value_or(false) ? Rank::own : Rank::stranger);
    }
    ~UdpBroadcast() override {
        core_.remove_link(everybody_, "closed");
        port_.forget(everybody_);
    }

    SetupResult<void> begin(const net::Resolver::Answer& answer, bool required);

    std::size_t send(const wire::FrameView& frame) override {
        if (everybody_.up) return core_.send(everybody_, frame) ? 1 : 0;
        return peers_.send(frame);
    }
    [[nodiscard]] std::size_t queued_bytes() const override {
        return everybody_.queued_bytes() + peers_.queued_bytes();
    }
    bool close_link(LinkId link) override { return peers_.close(link); }
    void settle_sent() override { port_.settle(); }
    void refresh_counters() override { port_.refresh_kernel_drops(); }
    void on_resolved(net::Resolver::Answer&& answer) override;

    UdpPeer* peer_of(UdpPort& port, const net::Datagram& datagram) override;
    void on_send_error(net::IoError error, const UdpPeer* peer) override;
    void on_first_confirmed(const net::Address& from) override {
        core_.events.mark_down(everybody_, fmt::format("{} answers", from.text()));
    }
    void on_last_confirmed_gone() override { core_.events.mark_up(everybody_); }
    void on_confirmed(UdpPeer& peer) override { peers_.note_confirmed(peer); }
    void on_timer(MonoTime) override { look_up(info.endpoint.address); }

private:
    SetupResult<void> start(const net::Resolver::Answer& answer);

    Core& core_;
    std::optional<net::Address> local_;
    UdpPort port_;
    UdpPeer everybody_;
    UdpPeers peers_;
    Retry retry_;
    bool reported_unreachable_ = false;
};

// Tries again later if the host or the interface is missing.
SetupResult<void> UdpBroadcast::begin(const net::Resolver::Answer& answer, bool required) {
    auto done = start(answer);
    const bool may_come = !answer || (!done && done.error().code == SetupCode::not_found);
    if (done || required || !may_come) return done;
    retry_.fail(done.error());
    return {};
}

SetupResult<void> UdpBroadcast::start(const net::Resolver::Answer& answer) {
    if (!answer) return tl::unexpected(answer.error());
    const auto to = std::find_if(answer->begin(), answer->end(), [](const net::Address& a) { return a.is_v4(); });
    if (to == answer->end()) return setup_error(SetupCode::usage, "IPv6 has no broadcast; udpmcast:// has groups");
    net::UdpOptions options = udp_options(info.endpoint.options);
    options.broadcast = true;
    if (auto done = port_.open(local_.value_or(*net::Address::parse("0.0.0.0", 0)), options); !done) return done;
    info.local_port = port_.socket().local().port();
    info.rcvbuf_bytes = port_.socket().receive_buffer_bytes();
    everybody_.address = *to;
    core_.events.mark_up(everybody_);
    return {};
}

void UdpBroadcast::on_resolved(net::Resolver::Answer&& answer) {
    if (auto done = start(answer); !done) retry_.fail(done.error());
}

// A socket bound to the broadcast port hears its own datagrams.
UdpPeer* UdpBroadcast::peer_of(UdpPort& port, const net::Datagram& datagram) {
    if (datagram.from->port() == info.local_port && core_.own_addresses.contains(*datagram.from, core_.now()))
        return nullptr;
    return info.endpoint.options.fixed ? &everybody_ : peers_.of(port, datagram);
}

void UdpBroadcast::on_send_error(net::IoError error, const UdpPeer* peer) {
    if (error == net::IoError::refused || peer != nullptr) return;  // it concerns one peer
    if (std::exchange(reported_unreachable_, true)) return;
    core_.events.notice(info.id, fmt::format("{}: no network reaches {} now; sending continues", info.endpoint.label(),
                                             everybody_.address.text()));
}

}  // namespace

Opened open_udpbcast(Opening opening) { return open_destination<UdpBroadcast>(std::move(opening)); }

}  // namespace mavloom::link::detail
