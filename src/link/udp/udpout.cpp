// SPDX-License-Identifier: MIT
// udpout: sends to one address; the endpoint is one link. The socket is not connected, so that datagrams from other
// addresses can be counted. ICMP reports closed ports.
#include <fmt/format.h>

#include <algorithm>

#include "link/resolve_and_open.hpp"
#include "link/retry.hpp"
#include "link/udp/peers.hpp"
#include "link/udp/udp.hpp"

namespace mavloom::link::detail {

namespace {

class UdpOut final : public OpenEndpoint, public NameUser, public UdpOwner, public net::TimerHandler {
public:
    UdpOut(Opening& opening, std::optional<net::Address> local)
        : OpenEndpoint(opening),
          NameUser(opening.core.look_ups),
          core_(opening.core),
          local_(local),
          idle_(opening.endpoint.options.idle.value_or(UdpPeers::default_idle)),
          is_name_(!net::Address::parse(opening.endpoint.address.host, 0)),
          retry_(opening.core, *this, *this) {}
    ~UdpOut() override {
        if (peer_) core_.remove_link(*peer_, "closed");
        if (peer_) port_->forget(*peer_);
    }

    SetupResult<void> begin(net::Resolver::Answer&& answer, bool required) {
        if (answer || required) return start(std::move(answer));
        on_resolved(std::move(answer));
        return {};
    }

    std::size_t send(const wire::FrameView& frame) override { return peer_ && core_.send(*peer_, frame) ? 1 : 0; }
    [[nodiscard]] std::size_t queued_bytes() const override { return peer_ ? peer_->queued_bytes() : 0; }
    void settle_sent() override {
        if (port_) port_->settle();
    }
    void refresh_counters() override {
        if (port_) port_->refresh_kernel_drops();
    }
    void on_resolved(net::Resolver::Answer&& answer) override;

    UdpPeer* peer_of(UdpPort&, const net::Datagram& datagram) override {
        if (peer_ && *datagram.from == peer_->address) return peer_.get();
        counters.wrong_peer.add();
        return nullptr;
    }
    UdpPeer* find_peer(UdpPort&, const net::Address& address) const override {
        return peer_ && address == peer_->address ? peer_.get() : nullptr;
    }
    void on_send_error(net::IoError error, const UdpPeer*) override;
    void on_timer(MonoTime now) override;

private:
    SetupResult<void> start(net::Resolver::Answer answer);
    SetupResult<void> aim_at(const net::Address& address);
    SetupResult<void> open_port(const net::Address& address);

    Core& core_;
    std::optional<net::Address> local_;
    Nanoseconds idle_;
    bool is_name_;
    std::vector<net::Address> addresses_;
    std::size_t current_ = 0;
    std::unique_ptr<UdpPort> port_;
    std::unique_ptr<UdpPeer> peer_;
    Retry retry_;
};

SetupResult<void> UdpOut::start(net::Resolver::Answer answer) {
    if (!answer) return tl::unexpected(std::move(answer).error());
    addresses_ = std::move(*answer);
    if (local_) std::erase_if(addresses_, [&](const net::Address& a) { return a.family() != local_->family(); });
    if (addresses_.empty()) {
        return setup_error(SetupCode::usage, fmt::format("'{}' has no address of the same family as bind={}",
                                                         info.endpoint.address.host, local_->text()));
    }
    current_ = 0;
    if (auto done = aim_at(addresses_[0]); !done) return done;
    if (is_name_ && !retry_.waits()) retry_.after(idle_);
    return {};
}

SetupResult<void> UdpOut::open_port(const net::Address& address) {
    if (port_ && port_->socket().local().family() == address.family()) return {};
    const net::UdpOptions options = udp_options(info.endpoint.options);
    const auto any = net::Address::parse(address.is_v4() ? "0.0.0.0" : "::", 0);
    if (!port_) port_ = std::make_unique<UdpPort>(core_, *this, counters, info.endpoint.options.mtu_bytes);
    if (auto done = port_->open(local_.value_or(*any), options); !done) return done;
    info.local_port = port_->socket().local().port();
    info.rcvbuf_bytes = port_->socket().receive_buffer_bytes();
    return {};
}

// The link stays the same when the far side's address changes.
SetupResult<void> UdpOut::aim_at(const net::Address& address) {
    if (auto done = open_port(address); !done) return done;
    if (!peer_) {
        peer_ = std::make_unique<UdpPeer>(info.id, info.endpoint.options, core_.dialects.of(info.id).table, *port_,
                                          address);
        peer_->name = info.endpoint.label();
        peer_->signature = signature.get();
        core_.add_link(*peer_);
    }
    peer_->move_to(address);
    core_.events.mark_up(*peer_);
    return {};
}

void UdpOut::on_resolved(net::Resolver::Answer&& answer) {
    const bool aimed = peer_ != nullptr;
    if (aimed && answer && std::find(answer->begin(), answer->end(), peer_->address) != answer->end()) {
        const auto at = std::find(answer->begin(), answer->end(), peer_->address);
        current_ = static_cast<std::size_t>(at - answer->begin());
        addresses_ = std::move(*answer);
        return;
    }
    auto done = start(std::move(answer));
    if (done) return;
    retry_.fail(done.error());
}

void UdpOut::on_send_error(net::IoError error, const UdpPeer*) {
    if (!peer_) return;
    const bool refused = error == net::IoError::refused;
    if (!retry_.is_failing())
        retry_.report(
            peer_->address.text() + (refused ? " refuses (no program listens there yet)" : " cannot be reached"),
            "sending continues");
    if (peer_->last_heard != MonoTime{} && core_.now() - peer_->last_heard < Retry::max_delay) retry_.reset();
    const bool choice = is_name_ || addresses_.size() > 1;
    if (choice && !retry_.within(Retry::max_delay)) retry_.later();
}

// After a failure: tries the next address, and after the last one a new look-up. Without a failure: a new look-up if
// nothing was heard for `idle`.
void UdpOut::on_timer(MonoTime now) {
    retry_.fired(now);
    const bool heard = peer_ && peer_->last_heard != MonoTime{} && now - peer_->last_heard < idle_;
    if (heard && now - peer_->last_heard < Retry::initial_delay) {
        retry_.settle();
        retry_.reset();
    } else if (retry_.is_failing() && current_ + 1 < addresses_.size()) {
        ++current_;
        if (auto done = aim_at(addresses_[current_]); !done) retry_.later();
    } else if (is_name_ && !heard) {
        look_up(info.endpoint.address);
    } else if (retry_.is_failing() && addresses_.size() > 1) {
        current_ = 0;
        if (auto done = aim_at(addresses_[0]); !done) retry_.later();
    }
    if (is_name_ && !retry_.waits()) retry_.after(idle_);
}

}  // namespace

Opened open_udpout(Opening opening) { return open_destination<UdpOut>(std::move(opening)); }

}  // namespace mavloom::link::detail
