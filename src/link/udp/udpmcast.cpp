// SPDX-License-Identifier: MIT
// udpmcast: sends to and receives from a multicast group. The whole group is one link, because every member receives
// every datagram.
//
// The endpoint has two sockets. One receives on the group's port, which other local programs may share. The other sends
// from its own port, so that the endpoint recognises its looped-back datagrams by their source. It also receives
// answers to that port.
#include <fmt/format.h>

#include "link/retry.hpp"
#include "link/udp/peers.hpp"
#include "mavloom/endpoint/checks.hpp"
#include "mavloom/net/interfaces.hpp"

namespace mavloom::link::detail {

namespace {

class UdpMulticast final : public OpenEndpoint, public UdpOwner, public net::TimerHandler {
public:
    // `interface`: its name; empty for the one that the kernel chooses.
    UdpMulticast(Opening& opening, const net::Address& group, std::string interface)
        : OpenEndpoint(opening),
          core_(opening.core),
          interface_(std::move(interface)),
          idle_(opening.endpoint.options.idle.value_or(UdpPeers::default_idle)),
          hearing_(opening.core, *this, counters, opening.endpoint.options.mtu_bytes),
          sending_(opening.core, *this, counters, opening.endpoint.options.mtu_bytes),
          group_(opening.id, opening.endpoint.options, opening.core.dialects.of(opening.id).table, sending_, group),
          retry_(opening.core, *this, *this) {
        group_.name = opening.endpoint.label();
        group_.signature = signature.get();
        core_.add_link(group_, opening.endpoint.options.trusted.value_or(false) ? Rank::own : Rank::stranger);
    }
    ~UdpMulticast() override {
        core_.remove_link(group_, "closed");
        sending_.forget(group_);
    }

    SetupResult<void> join();
    void fail(const SetupError& error) { retry_.fail(error); }

    std::size_t send(const wire::FrameView& frame) override { return group_.up && core_.send(group_, frame) ? 1 : 0; }
    [[nodiscard]] std::size_t queued_bytes() const override { return group_.queued_bytes(); }
    void settle_sent() override { sending_.settle(); }
    void refresh_counters() override {
        hearing_.refresh_kernel_drops();
        sending_.refresh_kernel_drops();
    }
    UdpPeer* peer_of(UdpPort&, const net::Datagram& datagram) override {
        const bool own = datagram.from->port() == own_port_ && core_.own_addresses.contains(*datagram.from, core_.now());
        return own ? nullptr : &group_;
    }
    void on_send_error(net::IoError error, const UdpPeer*) override;
    void on_timer(MonoTime now) override;

private:
    Core& core_;
    std::string interface_;
    Nanoseconds idle_;
    std::uint16_t own_port_ = 0;
    UdpPort hearing_, sending_;
    UdpPeer group_;
    Retry retry_;  // to join, or to join again
    bool failing_ = false;
};

SetupResult<void> UdpMulticast::join() {
    net::UdpOptions options = udp_options(info.endpoint.options);
    options.device.clear();
    if (!interface_.empty()) {
        const auto index = net::interface_index(interface_);
        if (!index) return tl::unexpected(index.error());
        options.group_interface = *index;
    }
    if (!sending_.socket() || failing_) {
        const auto any = net::Address::parse(group_.address.is_v4() ? "0.0.0.0" : "::", 0);
        if (auto done = sending_.open(*any, options); !done) return done;
        own_port_ = sending_.socket().local().port();
    }
    options.group = group_.address.with_scope(options.group_interface);
    if (auto done = hearing_.open(*options.group, options); !done) return done;
    info.local_port = group_.address.port();
    info.rcvbuf_bytes = hearing_.socket().receive_buffer_bytes();
    failing_ = false;
    retry_.after(idle_);
    core_.events.mark_up(group_);
    return {};
}

void UdpMulticast::on_send_error(net::IoError error, const UdpPeer*) {
    if (error == net::IoError::refused) return;
    if (std::exchange(failing_, true)) return;
    fail({SetupCode::unreachable, 0, "no network reaches the group now"});
}

// Rejoins the group unless it was heard lately. The membership ends with its interface, and the route to the group
// may change; the kernel reports neither.
void UdpMulticast::on_timer(MonoTime now) {
    const bool heard = group_.last_heard != MonoTime{} && now - group_.last_heard < idle_;
    if (heard && !failing_) {
        retry_.reset();
        retry_.settle();
        retry_.after(group_.last_heard + idle_ - now);
    } else if (auto done = join(); !done) {
        fail(done.error());
    }
}

}  // namespace

Opened open_udpmcast(Opening opening) {
    const endpoint::Endpoint& endpoint = opening.endpoint;
    const std::string& host = endpoint.address.host;
    const auto percent = host.find('%');
    const auto zone = percent == std::string::npos ? std::string{} : host.substr(percent + 1);
    const auto group = net::Address::parse(host.substr(0, percent), endpoint.address.port);
    if (!group || !group->is_multicast() || group->port() == 0)
        return setup_error(SetupCode::usage,
                           fmt::format("{}: '{}' is not a multicast group with a port", endpoint.label(), host));
    const std::string& iface = endpoint.options.iface;
    auto opened = std::make_unique<UdpMulticast>(opening, *group, iface.empty() ? zone : iface);
    auto done = opened->join();
    if (done) return opened;
    const bool may_come = done.error().code == SetupCode::not_found || done.error().code == SetupCode::unreachable;
    if (opening.is_required() || !may_come) return tl::unexpected(std::move(done.error()).within(endpoint.label()));
    opened->fail(done.error());
    return opened;
}

}  // namespace mavloom::link::detail
