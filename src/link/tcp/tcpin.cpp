// SPDX-License-Identifier: MIT
// tcpin: listens on a TCP port. Each client is its own link.
#include <fmt/format.h>

#include "link/peer_list.hpp"
#include "link/resolve_and_open.hpp"
#include "link/retry.hpp"
#include "link/tcp/tcp.hpp"
#include "mavloom/endpoint/checks.hpp"
#include "mavloom/net/port_holder.hpp"

namespace mavloom::link::detail {

namespace {

constexpr int accepts_per_turn = 64;
// Without free descriptors, accept fails and the waiting client keeps waking the loop. Listening pauses for this
// long.
constexpr std::chrono::milliseconds accept_pause{100};

class TcpIn;

class Listening final : public net::IoHandler {
public:
    Listening(Core& core, TcpIn& owner, net::TcpListener listener)
        : core_(core), owner_(owner), listener_(std::move(listener)) {}
    ~Listening() override { core_.loop().unwatch(watch_); }
    [[nodiscard]] SetupResult<void> start() {
        auto watch = core_.loop().watch(listener_.fd(), true, false, *this);
        if (!watch) return tl::unexpected(std::move(watch).error());
        watch_ = *watch;
        return {};
    }
    void listen(bool on) noexcept { core_.loop().change(watch_, on, false); }
    void on_io(net::IoEvents events) override;

private:
    Core& core_;
    TcpIn& owner_;
    net::TcpListener listener_;
    net::WatchId watch_;
};

class TcpIn final : public OpenEndpoint, public NameUser, public TcpOwner, public net::TimerHandler {
public:
    explicit TcpIn(Opening& opening)
        : OpenEndpoint(opening),
          NameUser(opening.core.look_ups),
          core_(opening.core),
          peers_(core_, *this),
          policy_(opening.endpoint.options.max_peers),
          retry_(opening.core, *this, *this) {}
    ~TcpIn() override {
        core_.loop().cancel_timer(pause_);
        core_.loop().cancel_timer(expiry_);
    }

    SetupResult<void> open(const std::vector<net::Address>& addresses);
    void accept_from(net::TcpListener& listener);

    std::size_t send(const wire::FrameView& frame) override { return peers_.send(frame); }
    [[nodiscard]] std::size_t queued_bytes() const override { return peers_.queued_bytes(); }
    bool close_link(LinkId link) override;
    void on_resolved(net::Resolver::Answer&& answer) override;
    void on_closed(TcpPeer& peer, std::string_view why) override { peers_.remove(peer, why); }
    void on_http(TcpPeer& peer) override;
    void on_timer(MonoTime now) override;

private:
    void admit(net::TcpStream stream);
    [[nodiscard]] bool make_room(const net::Address& newcomer);
    void pause();
    void expire(MonoTime now);

    Core& core_;
    std::vector<std::unique_ptr<Listening>> listeners_;
    PeerList<TcpPeer> peers_;
    PeerPolicy policy_;
    net::TimerId pause_, expiry_;
    Retry retry_;  // to look the name up again
    net::BindErrors bind_errors_{net::Transport::tcp};
    bool reported_full_ = false, reported_http_ = false;
};

void Listening::on_io(net::IoEvents) { owner_.accept_from(listener_); }

SetupResult<void> TcpIn::open(const std::vector<net::Address>& addresses) {
    for (const net::Address& address : addresses) {
        const bool any_port = address.port() == 0 && info.local_port != 0;
        const net::Address local = any_port ? address.with_port(info.local_port) : address;
        auto listener = net::TcpListener::open(local, addresses.size() > 1);
        if (!listener) return bind_errors_.complete(std::move(listener).error(), local);
        info.local_port = listener->local().port();
        auto listening = std::make_unique<Listening>(core_, *this, std::move(*listener));
        if (auto done = listening->start(); !done) return done;
        listeners_.push_back(std::move(listening));
    }
    core_.events.notice(info.id, info.label() + ": listening");
    if (const auto idle = info.endpoint.options.idle) expiry_ = core_.loop().start_timer(core_.now() + *idle, *this);
    return {};
}

// Called only if the look-up took longer than `add` waits.
void TcpIn::on_resolved(net::Resolver::Answer&& answer) {
    auto done = answer ? open(*answer) : tl::unexpected(answer.error());
    if (done) return;
    listeners_.clear();
    retry_.fail(done.error());
}

void TcpIn::accept_from(net::TcpListener& listener) {
    for (int i = 0; i < accepts_per_turn; ++i) {
        auto stream = listener.accept();
        if (stream) {
            admit(std::move(*stream));
        } else {
            if (stream.error() == net::IoError::no_descriptors || stream.error() == net::IoError::no_buffers) pause();
            // `closed`: that client gave up while it waited. The next one may be fine.
            if (stream.error() != net::IoError::closed) return;
        }
    }
}

void TcpIn::admit(net::TcpStream stream) {
    if (peers_.is_full() && !make_room(stream.remote())) {
        counters.peers_refused.add();
        if (!std::exchange(reported_full_, true)) {
            core_.events.notice(info.id, fmt::format("{}: max_peers={} reached; other clients are turned away",
                                                     info.endpoint.label(), peers_.size()));
        }
        return;
    }
    auto peer = std::make_unique<TcpPeer>(core_, *this, info.id, info.endpoint.options);
    peer->name = fmt::format("{}#{}", info.label(), stream.remote().text());
    peer->connected_at = core_.now();
    peer->crowd = PeerPolicy::crowd_of(stream.remote());
    peer->refuse_http();
    const Rank rank = core_.rank_of(info.endpoint.options, stream.remote());
    if (peer->attach(std::move(stream))) peers_.add(std::move(peer), rank);
}

bool TcpIn::make_room(const net::Address& newcomer) {
    TcpPeer* const first = peers_.to_close_for(newcomer, policy_, core_.now());
    if (first == nullptr) return false;
    counters.peers_evicted.add();
    first->close("max_peers is reached, and this client was silent longest");
    return true;
}

// A browser sends such a request for any web page that it shows, and the rest of the request may be MAVLink. In TLS,
// the page chooses hardly any bytes, but no such client is one of MAVLink.
void TcpIn::on_http(TcpPeer& peer) {
    counters.http_refused.add();
    if (!std::exchange(reported_http_, true)) {
        core_.events.notice(info.id,
                            fmt::format("{}: {} is an HTTP or TLS client, such as a web page in a browser, and was "
                                        "disconnected; this port takes MAVLink only. Further such clients are counted "
                                        "(http_refused)",
                                        info.endpoint.label(), peer.stream().remote().text()));
    }
    peer.close("HTTP or TLS client");
}

void TcpIn::pause() {
    for (const auto& listening : listeners_) listening->listen(false);
    if (!pause_.valid()) pause_ = core_.loop().start_timer(core_.now() + accept_pause, *this);
    if (!std::exchange(reported_full_, true)) {
        core_.events.notice(info.id,
                            fmt::format("{}: few file descriptors left; new clients wait", info.endpoint.label()));
    }
}

bool TcpIn::close_link(LinkId link) {
    TcpPeer* const peer = peers_.find(link);
    if (peer != nullptr) peer->drop("closed");
    return peer != nullptr;
}

void TcpIn::on_timer(MonoTime now) {
    if (pause_.valid() && pause_.when <= now) {
        pause_ = {};
        for (const auto& listening : listeners_) listening->listen(true);
    }
    if (expiry_.valid() && expiry_.when <= now) expire(now);
    if (retry_.fired(now)) look_up(info.endpoint.address);
}

void TcpIn::expire(MonoTime now) {
    const auto next = peers_.expire(now, *info.endpoint.options.idle, [](TcpPeer& peer) { peer.close("idle"); });
    expiry_ = core_.loop().start_timer(next, *this);
}

}  // namespace

Opened open_tcpin(Opening opening) { return open_listening<TcpIn>(std::move(opening)); }

}  // namespace mavloom::link::detail
