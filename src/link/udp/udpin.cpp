// SPDX-License-Identifier: MIT
// udpin: each peer that sends valid MAVLink is a link of its own.
#include <fmt/format.h>

#include "link/retry.hpp"
#include "link/udp/peers.hpp"
#include "mavloom/endpoint/checks.hpp"

namespace mavloom::link::detail {

namespace {

class UdpIn final : public OpenEndpoint, public UdpPeers::Owner, public net::TimerHandler {
public:
    explicit UdpIn(Opening& opening)
        : OpenEndpoint(opening),
          core_(opening.core),
          peers_(opening.core, *this, *this),
          retry_(opening.core, *this, *this) {}
    ~UdpIn() override { core_.forget(static_cast<const OpenEndpoint&>(*this)); }

    SetupResult<void> open(const std::vector<net::Address>& addresses);
    std::size_t send(const wire::FrameView& frame) override { return peers_.send(frame); }
    [[nodiscard]] std::size_t queued_bytes() const override { return peers_.queued_bytes(); }
    bool close_link(LinkId link) override { return peers_.close(link); }
    void settle_sent() override {
        for (const auto& port : ports_) port->settle();
    }
    void refresh_kernel_drops() override {
        for (const auto& port : ports_) port->refresh_kernel_drops();
    }
    void on_resolved(net::Resolver::Answer&& answer) override;

    UdpPeer* peer_of(UdpPort& port, const net::Datagram& datagram) override { return peers_.of(port, datagram); }
    void on_send_error(net::IoError) override {}
    void on_timer(MonoTime) override { core_.resolve(*this, info.endpoint.address); }

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
    for (const net::Address& address : addresses) {
        auto port = std::make_unique<UdpPort>(core_, *this, counters, info.endpoint.options.mtu_bytes);
        const bool any_port = address.port() == 0 && info.local_port != 0;
        if (auto done = port->open(any_port ? address.with_port(info.local_port) : address, options); !done)
            return done;
        info.local_port = port->socket().local().port();
        info.rcvbuf_bytes = port->socket().receive_buffer_bytes();
        ports_.push_back(std::move(port));
    }
    core_.notice(info.id, fmt::format("{}: listening (receive buffer {} bytes)", info.label(), info.rcvbuf_bytes));
    if (info.rcvbuf_bytes < options.receive_buffer_bytes)
        core_.notice(info.id, fmt::format("{}: a larger receive buffer loses less when very much comes at once; to "
                                          "allow it: sysctl net.core.rmem_max={}",
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

SetupResult<std::unique_ptr<OpenEndpoint>> open_udpin(Opening opening) {
    Core& core = opening.core;
    const endpoint::Endpoint& endpoint = opening.endpoint;
    auto opened = std::make_unique<UdpIn>(opening);
    constexpr std::chrono::seconds look_up_limit{1};
    auto answer = core.resolve_now(endpoint.address, look_up_limit, *opened);
    if (!answer) return opened;
    if (!*answer) return tl::unexpected(std::move(answer->error()).within(endpoint.label()));
    if (auto done = opened->open(**answer); !done)
        return tl::unexpected(std::move(done.error()).within(endpoint.label()));
    return opened;
}

}  // namespace mavloom::link::detail
