// SPDX-License-Identifier: MIT
// udpin: every peer that sends valid MAVLink is a link of its own.
#include <fmt/format.h>

#include <algorithm>

#include "runtime/links_options.hpp"
#include "runtime/links_udp.hpp"

namespace mavloom::runtime::detail {

namespace {

constexpr std::chrono::seconds default_idle{60};
// A peer that was heard more than once and was heard this lately does not give way to a newcomer: a flood of strangers cannot push out
// those who send heartbeats (1 Hz).
constexpr std::chrono::seconds protected_for{2};

class UdpIn final : public OpenEndpoint, public UdpOwner, public net::TimerHandler {
public:
    explicit UdpIn(Opening& opening)
        : OpenEndpoint(opening),
          core_(opening.core),
          idle_(opening.endpoint.options.idle.value_or(default_idle)),
          stranger_(opening.core.table()) {}
    ~UdpIn() override {
        core_.loop().cancel_timer(expiry_);
        while (!peers_.empty()) drop(peers_.size() - 1, "closed");
        core_.forget(static_cast<const OpenEndpoint&>(*this));
    }

    SetupResult<void> open(std::vector<net::Address> addresses);
    std::size_t send(const wire::FrameView& frame) override;
    [[nodiscard]] std::size_t queued_bytes() const override;
    void refresh_kernel_drops() override;
    void on_resolved(net::Resolver::Answer answer) override;

    UdpPeer* peer_of(UdpPort& port, const net::Datagram& datagram) override {
        if (signature) signature->forget_vouched();
        if (UdpPeer* peer = port.peers().find(*datagram.from)) return peer;
        return newcomer(port, datagram);
    }
    void on_send_error(net::IoError) override {}
    void on_timer(MonoTime now) override;

private:
    UdpPeer* newcomer(UdpPort& port, const net::Datagram& datagram);
    [[nodiscard]] bool vouched_for(const net::Datagram& datagram);
    [[nodiscard]] bool make_room();
    void drop(std::size_t index, std::string_view why);

    Core& core_;
    Nanoseconds idle_;
    wire::DatagramParser stranger_;
    std::vector<std::unique_ptr<UdpPort>> ports_;
    std::vector<std::unique_ptr<UdpPeer>> peers_;
    net::TimerId expiry_;
};

SetupResult<void> UdpIn::open(std::vector<net::Address> addresses) {
    net::UdpOptions options;
    options.receive_buffer_bytes = info.endpoint.options.rcvbuf_bytes;
    // One socket on :: serves both families; where each family has a socket of its own they must not meet.
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
    const bool less = info.rcvbuf_bytes < options.receive_buffer_bytes;
    core_.notice(info.id,
                 fmt::format("{}: receive buffer {} bytes (asked {}){}", info.endpoint.label(), info.rcvbuf_bytes,
                             options.receive_buffer_bytes, less ? "; net.core.rmem_max sets the limit" : ""));
    return {};
}

// Only when the look-up took longer than `add` waits.
void UdpIn::on_resolved(net::Resolver::Answer answer) {
    auto done = answer ? open(std::move(*answer)) : tl::unexpected(std::move(answer).error());
    if (!done) core_.notice(info.id, fmt::format("{}: {}", info.endpoint.label(), done.error().text));
}

std::size_t UdpIn::send(const wire::FrameView& frame) {
    std::size_t taken = 0;
    for (const auto& peer : peers_) taken += core_.send(*peer, frame) ? 1 : 0;
    return taken;
}

std::size_t UdpIn::queued_bytes() const {
    std::size_t sum = 0;
    for (const auto& peer : peers_) sum += peer->queue.bytes();
    return sum;
}

void UdpIn::refresh_kernel_drops() {
    for (const auto& port : ports_) port->refresh_kernel_drops();
}

// With verify= a good signature vouches for the sender; without, the checksum of a defined message does: an id without definition alone does
// not.
bool UdpIn::vouched_for(const net::Datagram& datagram) {
    const bool verifies = signature && signature->verifies();
    bool found = false;
    stranger_.parse(datagram.bytes, [&](const wire::ParseEvent& event) {
        if (found || event.kind != wire::ParseEvent::Kind::frame) return;
        found = verifies ? signature->vouches(event.frame, receive_time(datagram)) : event.info != nullptr;
    });
    return found;
}

UdpPeer* UdpIn::newcomer(UdpPort& port, const net::Datagram& datagram) {
    if (!vouched_for(datagram)) {
        counters.stray_bytes.add(datagram.bytes.size());
        return nullptr;
    }
    if (!make_room()) {
        counters.peers_refused.add();
        return nullptr;
    }
    auto peer = std::make_unique<UdpPeer>(info.id, queue_limits(info.endpoint.options), core_.table(), port,
                                          *datagram.from);
    peer->name = fmt::format("{}#{}", info.label(), datagram.from->text());
    peer->signature = signature.get();
    peer->last_heard = core_.now();
    core_.add_link(*peer);
    port.peers().add(*datagram.from, *peer);
    peers_.push_back(std::move(peer));
    if (!expiry_.valid()) expiry_ = core_.loop().start_timer(core_.now() + idle_, *this);
    core_.set_up(*peers_.back());
    return peers_.back().get();
}

// The longest idle goes first: of those heard once, else of all that are not protected.
bool UdpIn::make_room() {
    if (peers_.size() < info.endpoint.options.max_peers) return true;
    const auto rank = [](const std::unique_ptr<UdpPeer>& peer) {
        return std::pair(peer->datagrams > 1, peer->last_heard);
    };
    const auto first = std::min_element(peers_.begin(), peers_.end(),
                                        [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
    if (first == peers_.end()) return false;
    if ((*first)->datagrams > 1 && core_.now() - (*first)->last_heard < protected_for) return false;
    counters.peers_evicted.add();
    drop(static_cast<std::size_t>(first - peers_.begin()),
         "more peers than max_peers, and this one was silent for longest");
    return true;
}

void UdpIn::drop(std::size_t index, std::string_view why) {
    UdpPeer& peer = *peers_[index];
    core_.remove_link(peer, why);
    count_gone(peer);
    peer.port->forget(peer);
    core_.bury(std::move(peers_[index]));
    peers_[index] = std::move(peers_.back());
    peers_.pop_back();
}

// Runs when the longest idle peer may have been silent for too long, and then again when the next one may.
void UdpIn::on_timer(MonoTime now) {
    MonoTime oldest = now;
    for (std::size_t i = peers_.size(); i-- > 0;) {
        if (now - peers_[i]->last_heard >= idle_) {
            drop(i, "idle");
        } else {
            oldest = std::min(oldest, peers_[i]->last_heard);
        }
    }
    expiry_ = peers_.empty() ? net::TimerId{} : core_.loop().start_timer(oldest + idle_, *this);
}

}  // namespace

SetupResult<std::unique_ptr<OpenEndpoint>> open_udpin(Opening opening) {
    Core& core = opening.core;
    const Endpoint& endpoint = opening.endpoint;
    auto opened = std::make_unique<UdpIn>(opening);
    constexpr std::chrono::seconds look_up_limit{1};
    auto answer = core.resolve_now(endpoint.address, look_up_limit, *opened);
    if (!answer) return opened;
    if (!*answer) return tl::unexpected(std::move(answer->error()).within(endpoint.label()));
    if (auto done = opened->open(std::move(**answer)); !done)
        return tl::unexpected(std::move(done.error()).within(endpoint.label()));
    return opened;
}

}  // namespace mavloom::runtime::detail
