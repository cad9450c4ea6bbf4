// SPDX-License-Identifier: MIT
// udpin: listens on a UDP port. Each peer that sends valid MAVLink is its own link.
#include <fmt/format.h>

#include "link/resolve_and_open.hpp"
#include "link/retry.hpp"
#include "link/udp/peers.hpp"
#include "mavloom/endpoint/checks.hpp"

namespace mavloom::link::detail {

namespace {

class UdpIn final : public OpenEndpoint, public NameUser, public UdpPeers::Owner, public net::TimerHandler {
public:
    explicit UdpIn(Opening& opening)
        : OpenEndpoint(opening),
          NameUser(opening.core.look_ups),
          core_(opening.core),
          peers_(opening.core, *this, *this),
          retry_(opening.core, *this, *this) {}

    SetupResult<void> open(const std::vector<net::Address>& addresses);
    std::size_t send(const wire::FrameView& frame) override { return peers_.send(frame); }
    [[nodiscard]] std::size_t queued_bytes() const override { return peers_.queued_bytes(); }
    bool close_link(LinkId link) override { return peers_.close(link); }
    void settle_sent() override {
        for (const auto& port : ports_) port->settle();
    }
    void refresh_counters() override {
        for (const auto& port : ports_) port->refresh_kernel_drops();
    }
    void on_resolved(net::Resolver::Answer&& answer) override;

    UdpPeer* peer_of(UdpPort& port, const net::Datagram& datagram) override { return peers_.of(port, datagram); }
    void on_send_error(net::IoError, const UdpPeer*) override {}
    void on_timer(MonoTime) override { look_up(info.endpoint.address); }

private:
    Core& core_;
    std::vector<std::unique_ptr<UdpPort>> ports_;
    UdpPeers peers_;
    Retry retry_;  // to look the name up again
};

SetupResult<void> UdpIn::open(const std::vector<net::Address>& addresses) {
    net::UdpOptions options = udp_options(info.endpoint.options);
    // A single socket on :: serves both families. If each family has its own socket, the IPv6 one must not also take
    // IPv4.
    options.v6_only = addresses.size() > 1;
    // The kernel gives two sockets that share addresses the same free port.
    options.reuse_address = info.endpoint.options.reuse && info.endpoint.address.port != 0;
    for (const net::Address& address : addresses) {
        auto port = std::make_unique<UdpPort>(core_, *this, counters, info.endpoint.options.mtu_bytes);
        const bool any_port = address.port() == 0 && info.local_port != 0;
        if (auto done = port->open(any_port ? address.with_port(info.local_port) : address, options); !done)
            return done;
        info.local_port = port->socket().local().port();
        info.rcvbuf_bytes = port->socket().receive_buffer_bytes();
        ports_.push_back(std::move(port));
    }
    core_.events.notice(info.id,
                        fmt::format("{}: listening (receive buffer {} bytes)", info.label(), info.rcvbuf_bytes));
    if (info.rcvbuf_bytes < options.receive_buffer_bytes)
        core_.events.notice(info.id, fmt::format("{}: a larger receive buffer loses fewer datagrams in a burst; to "
                                                 "allow one: sysctl net.core.rmem_max={}",
                                                 info.label(), options.receive_buffer_bytes));
    return {};
}

// Called only if the look-up took longer than `add` waits.
void UdpIn::on_resolved(net::Resolver::Answer&& answer) {
    auto done = answer ? open(*answer) : tl::unexpected(answer.error());
    if (done) return;
    ports_.clear();
    retry_.fail(done.error());
}

}  // namespace

net::UdpOptions udp_options(const endpoint::EndpointOptions& endpoint) {
    net::UdpOptions options;
    options.receive_buffer_bytes = endpoint.rcvbuf_bytes;
    options.device = endpoint.iface;
    options.ttl = endpoint.ttl;
    return options;
}

Opened open_udpin(Opening opening) { return open_listening<UdpIn>(std::move(opening)); }

}  // namespace mavloom::link::detail
