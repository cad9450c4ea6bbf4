// SPDX-License-Identifier: MIT
// tcpout: connects and reconnects indefinitely. The endpoint is one link, and its queued frames survive a lost
// connection until they are too old.
#include <fmt/format.h>

#include "link/resolve_and_open.hpp"
#include "link/retry.hpp"
#include "link/tcp/tcp.hpp"

namespace mavloom::link::detail {

namespace {

// An address that never answers is given up after this time, and the next one is tried.
constexpr std::chrono::seconds connect_limit{5};
constexpr std::chrono::seconds required_limit{5};

SetupError no_answer(const net::Address& silent) {
    return {SetupCode::unreachable, 0, fmt::format("{} does not answer", silent.text())};
}

SetupError no_address() { return {SetupCode::not_found, 0, "the host has no address of the same family as bind="}; }

class TcpOut final : public OpenEndpoint,
                     public NameUser,
                     public TcpOwner,
                     public net::IoHandler,
                     public net::TimerHandler {
public:
    TcpOut(Opening& opening, std::optional<net::Address> local)
        : OpenEndpoint(opening),
          NameUser(opening.core.look_ups),
          core_(opening.core),
          local_(local),
          peer_(core_, *this, opening.id, opening.endpoint.options),
          retry_(core_, *this, *this) {
        peer_.name = opening.endpoint.label();
        peer_.signature = signature.get();
        core_.add_link(peer_);
    }
    ~TcpOut() override {
        core_.loop().unwatch(connecting_watch_);
        core_.remove_link(peer_, "closed");
    }

    // Connects in the background, or waits for the result if `required`.
    SetupResult<void> begin(net::Resolver::Answer&& answer, bool required) {
        if (required) return connect_and_wait(answer);
        on_resolved(std::move(answer));
        return {};
    }

    std::size_t send(const wire::FrameView& frame) override { return peer_.up && core_.send(peer_, frame) ? 1 : 0; }
    [[nodiscard]] std::size_t queued_bytes() const override { return peer_.queued_bytes(); }
    void on_resolved(net::Resolver::Answer&& answer) override;
    void on_closed(TcpPeer& peer, std::string_view why) override;
    void on_io(net::IoEvents events) override;
    void on_timer(MonoTime now) override;

private:
    SetupResult<void> connect_and_wait(const net::Resolver::Answer& answer);
    SetupResult<void> connect_to(const net::Address& address);
    SetupResult<void> finish();
    void fail(const SetupError& error);
    void on_up_timer(MonoTime now);

    Core& core_;
    std::optional<net::Address> local_;
    TcpPeer peer_;
    std::vector<net::Address> addresses_;  // not yet tried; the next one is last
    net::TcpStream connecting_;
    net::WatchId connecting_watch_;
    Retry retry_;  // connecting: give up; down: retry; up: check for idle
    MonoTime up_since_{};
    bool was_up_ = false;
};

void TcpOut::on_resolved(net::Resolver::Answer&& answer) {
    if (!answer) return fail(answer.error());
    addresses_.assign(answer->rbegin(), answer->rend());
    if (local_) std::erase_if(addresses_, [&](const net::Address& a) { return a.family() != local_->family(); });
    if (addresses_.empty()) return fail(no_address());
    const net::Address next = addresses_.back();
    addresses_.pop_back();
    if (auto done = connect_to(next); !done) fail(done.error());
}

SetupResult<void> TcpOut::connect_to(const net::Address& address) {
    auto stream = net::TcpStream::start_connect(address, local_);
    if (!stream) return tl::unexpected(std::move(stream).error());
    auto watch = core_.loop().watch(stream->fd(), false, true, *this);
    if (!watch) return tl::unexpected(std::move(watch).error());
    connecting_ = std::move(*stream);
    connecting_watch_ = *watch;
    retry_.after(connect_limit);
    return {};
}

void TcpOut::on_io(net::IoEvents) {
    if (auto done = finish(); !done) fail(done.error());
}

SetupResult<void> TcpOut::finish() {
    core_.loop().unwatch(connecting_watch_);
    retry_.cancel();
    auto stream = std::move(connecting_);
    if (auto done = stream.finish_connect(); !done) return done;
    if (auto done = peer_.attach(std::move(stream)); !done) return done;
    addresses_.clear();
    up_since_ = core_.now();
    retry_.settle();
    if (std::exchange(was_up_, true)) counters.reconnects.add();
    if (const auto idle = info.endpoint.options.idle) retry_.after(*idle);
    core_.events.mark_up(peer_);
    return {};
}

// Tries the next address at once. After the last one it waits, then starts over; a name is resolved again.
void TcpOut::fail(const SetupError& error) {
    retry_.report(error.text, "trying again");
    while (!addresses_.empty()) {
        const net::Address next = addresses_.back();
        addresses_.pop_back();
        if (connect_to(next)) return;
    }
    retry_.fail_silently(error);
}

void TcpOut::on_closed(TcpPeer& peer, std::string_view why) {
    const bool lasted = core_.now() - up_since_ >= Retry::lasting || peer.last_heard > up_since_;
    core_.events.mark_down(peer, why);
    if (lasted) retry_.reset();
    retry_.later();
}

void TcpOut::on_timer(MonoTime now) {
    if (peer_.up) return on_up_timer(now);
    if (connecting_) {
        core_.loop().unwatch(connecting_watch_);
        const net::Address silent = connecting_.remote();
        connecting_ = {};
        return fail(no_answer(silent));
    }
    look_up(info.endpoint.address);
}

void TcpOut::on_up_timer(MonoTime now) {
    const Nanoseconds idle = *info.endpoint.options.idle;
    if (now - peer_.last_heard >= idle) return peer_.close("idle");
    retry_.after(peer_.last_heard + idle - now);
}

SetupResult<void> TcpOut::connect_and_wait(const net::Resolver::Answer& answer) {
    if (!answer) return tl::unexpected(answer.error());
    SetupError last = no_address();
    for (const net::Address& address : *answer) {
        if (local_ && address.family() != local_->family()) continue;
        auto done = connect_to(address);
        if (done && !connecting_.wait_connected(required_limit)) {
            core_.loop().unwatch(connecting_watch_);
            retry_.cancel();
            connecting_ = {};
            done = tl::unexpected(no_answer(address));
        } else if (done) {
            done = finish();
        }
        if (done) return {};
        last = std::move(done).error();
    }
    return tl::unexpected(std::move(last));
}

}  // namespace

Opened open_tcpout(Opening opening) { return open_destination<TcpOut>(std::move(opening)); }

}  // namespace mavloom::link::detail
