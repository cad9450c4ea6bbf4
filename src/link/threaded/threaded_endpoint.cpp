// SPDX-License-Identifier: MIT
#include "link/threaded/threaded_endpoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>

#include "link/resolve_and_open.hpp"

namespace mavloom::link::detail {

// By scheme; null: the program has no such transport.
static std::array<std::atomic<CreateTransport>, endpoint::scheme_rows.size()> created_by{};

static std::size_t index(endpoint::Scheme scheme) noexcept { return static_cast<std::size_t>(scheme); }

bool has_transport(endpoint::Scheme scheme) noexcept { return created_by[index(scheme)].load() != nullptr; }

}  // namespace mavloom::link::detail

void mavloom::link::register_transport(endpoint::Scheme scheme, CreateTransport create) noexcept {
    detail::created_by[detail::index(scheme)].store(create);
}

namespace mavloom::link::detail {

ThreadedEndpoint::ThreadedEndpoint(Opening& opening)
    : OpenEndpoint(opening),
      NameUser(opening.core.look_ups),
      core_(opening.core),
      mailbox_(std::make_shared<Mailbox>([wake = core_.loop().wake_handle()] { net::EventLoop::wake(*wake); })),
      transport_(created_by[index(opening.endpoint.scheme)].load()(opening.endpoint, mailbox_)),
      retry_(opening.core, *this, *this) {}

ThreadedEndpoint::~ThreadedEndpoint() { mailbox_->close(); }

static std::size_t cost_of(const Mailbox::Event& event) noexcept {
    return sizeof event + (event.kind == Mailbox::Event::Kind::message ? event.size : 0);
}

void ThreadedEndpoint::on_wake() {
    const auto& events = batch_.events;
    const bool is_new = next_ == events.size();
    if (is_new && !fetch()) return;
    const std::size_t most = core_.reads_all ? SIZE_MAX : budget_.limit();
    std::size_t end = next_, bytes = 0;
    for (; end != events.size() && bytes < most; ++end) bytes += cost_of(events[end]);
    budget_.spend(bytes, bytes, [&] {
        while (next_ != end) handle_next();
    });
    if (is_new && end == events.size()) return;  // what has come since `fetch` wakes the loop itself
    core_.note_more_waits();
    core_.loop().wake();
}

// Handles one event, so that no frame is handled outside a turn. Returns false if none came in time.
bool ThreadedEndpoint::await_event(MonoTime end) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - mono_now());
    if (next_ == batch_.events.size()) mailbox_->wait(left);
    if (next_ == batch_.events.size() && !fetch()) return false;
    handle_next();
    core_.loop().wake();  // for the others
    return true;
}

// Returns false if nothing has arrived. The next event then wakes the loop.
bool ThreadedEndpoint::fetch() {
    if (mailbox_->exchange(batch_)) transport_->resume();
    next_ = 0;
    return !batch_.events.empty();
}

void ThreadedEndpoint::handle(const Mailbox::Event& event) {
    using Kind = Mailbox::Event::Kind;
    const bool has_bytes = event.kind == Kind::message || event.kind == Kind::leave || event.kind == Kind::notice;
    const ByteView bytes = has_bytes ? batch_.bytes_of(event) : ByteView{};
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    switch (event.kind) {
        case Kind::join: return on_join(batch_.peers[event.offset]);
        case Kind::leave: return on_leave(event.peer, text);
        case Kind::fail: return on_fail(batch_.errors[event.offset]);
        case Kind::notice: return core_.events.notice(info.id, fmt::format("{}: {}", info.label(), text));
        case Kind::message:
            if (ThreadedPeer* const peer = find(event.peer)) peer->take(bytes, event.time);
            return;
        case Kind::sent:
            if (ThreadedPeer* const peer = find(event.peer)) peer->note_sent(event.size);
    }
}

namespace {

// Each client is a link.
class ThreadedIn final : public ThreadedEndpoint {
public:
    explicit ThreadedIn(Opening& opening)
        : ThreadedEndpoint(opening), peers_(core_, *this), policy_(opening.endpoint.options.max_peers) {}
    ~ThreadedIn() override {
        core_.loop().cancel_timer(expiry_);
        transport_.reset();
    }

    SetupResult<void> open(const std::vector<net::Address>& addresses) {
        if (auto done = transport_->open(addresses); !done) return done;
        info.local_port = transport_->local_port();
        core_.events.notice(info.id, info.label() + ": listening");
        if (const auto idle = info.endpoint.options.idle)
            expiry_ = core_.loop().start_timer(core_.now() + *idle, *this);
        return {};
    }

    std::size_t send(const wire::FrameView& frame) override { return peers_.send(frame); }
    [[nodiscard]] std::size_t queued_bytes() const override { return peers_.queued_bytes(); }
    [[nodiscard]] bool is_sending() const override {
        return std::ranges::any_of(by_number_, [](const auto& known) { return known.second->is_sending(); });
    }
    bool close_link(LinkId link) override {
        ThreadedPeer* const peer = peers_.find(link);
        if (peer != nullptr) close(*peer, "closed");
        return peer != nullptr;
    }
    void on_resolved(net::Resolver::Answer&& answer) override {
        auto done = answer ? open(*answer) : tl::unexpected(answer.error());
        if (!done) retry_.fail(done.error());
    }
    void on_timer(MonoTime now) override {
        if (expiry_.valid() && expiry_.when <= now)
            expiry_ = core_.loop().start_timer(
                peers_.expire(now, *info.endpoint.options.idle, [&](ThreadedPeer& peer) { close(peer, "idle"); }),
                *this);
        if (retry_.fired(now)) look_up(info.endpoint.address);
    }

private:
    void on_join(const NewPeer& arrived) override {
        if (peers_.is_full() && !make_room(arrived)) {
            counters.peers_refused.add();
            return transport_->close(arrived.number, "max_peers is reached");
        }
        auto peer = std::make_unique<ThreadedPeer>(core_, *transport_, info.id, info.endpoint.options);
        peer->name = fmt::format("{}#{}", info.label(), arrived.address ? arrived.address->text() : "client");
        if (arrived.address) peer->crowd = PeerPolicy::crowd_of(*arrived.address);
        const auto& options = info.endpoint.options;
        const Rank near = arrived.address ? core_.rank_of(options, *arrived.address) : Rank::own;
        const Rank rank = arrived.is_foreign && !options.trusted.value_or(false) ? Rank::stranger : near;
        by_number_.emplace(arrived.number, peer.get());
        peers_.add(std::move(peer), rank).begin(arrived.number);
    }
    void on_leave(PeerNumber number, std::string_view why) override {
        ThreadedPeer* const peer = find(number);
        if (peer == nullptr) return;
        peer->finish();
        remove(*peer, why);
    }
    // Closes a silent client for a newcomer.
    [[nodiscard]] bool make_room(const NewPeer& arrived) {
        ThreadedPeer* const first = peers_.to_close_for(arrived.address.value_or(net::Address{}), policy_, core_.now());
        if (first == nullptr) return false;
        counters.peers_evicted.add();
        close(*first, "max_peers is reached, and this client was silent longest");
        return true;
    }
    void close(ThreadedPeer& peer, std::string_view why) {
        transport_->close(peer.number(), why);
        remove(peer, why);
    }
    void remove(ThreadedPeer& peer, std::string_view why) {
        by_number_.erase(peer.number());
        peer.end();
        peers_.remove(peer, why);
    }
    ThreadedPeer* find(PeerNumber number) override {
        const auto found = by_number_.find(number);
        return found == by_number_.end() ? nullptr : found->second;
    }

    PeerList<ThreadedPeer> peers_;
    PeerPolicy policy_;
    std::unordered_map<PeerNumber, ThreadedPeer*> by_number_;
    net::TimerId expiry_;
};

// Calls one far side, again and again. The endpoint is one link.
class ThreadedOut final : public ThreadedEndpoint {
public:
    ThreadedOut(Opening& opening, std::optional<net::Address>)
        : ThreadedEndpoint(opening), peer_(core_, *transport_, opening.id, opening.endpoint.options) {
        peer_.name = opening.endpoint.label();
        peer_.signature = signature.get();
        core_.add_link(peer_);
    }
    ~ThreadedOut() override {
        transport_.reset();
        core_.remove_link(peer_, "closed");
    }

    SetupResult<void> begin(net::Resolver::Answer&& answer, bool required) {
        const auto addresses = answer ? static_cast<int>(answer->size()) : 0;
        on_resolved(std::move(answer));
        if (!required) return {};
        const MonoTime end = mono_now() + required_limit * addresses;
        while (!peer_.up && !failure && mono_now() < end && await_event(end)) {}
        if (peer_.up) return {};
        return failure ? tl::unexpected(*failure) : setup_error(SetupCode::unreachable, "the far side does not answer");
    }

    std::size_t send(const wire::FrameView& frame) override { return peer_.up && core_.send(peer_, frame) ? 1 : 0; }
    [[nodiscard]] std::size_t queued_bytes() const override { return peer_.queued_bytes(); }
    [[nodiscard]] bool is_sending() const override { return peer_.is_sending(); }
    void on_resolved(net::Resolver::Answer&& answer) override {
        auto done = answer ? transport_->open(*answer) : tl::unexpected(answer.error());
        if (!done) on_fail(done.error());
    }
    void on_timer(MonoTime now) override {
        if (!retry_.fired(now)) return;
        if (peer_.up) check_idle(now);
        else look_up(info.endpoint.address);
    }

private:
    static constexpr std::chrono::seconds required_limit{5};

    void on_join(const NewPeer& arrived) override {
        peer_.begin(arrived.number);
        up_since_ = core_.now();
        failure.reset();
        retry_.settle();
        if (std::exchange(was_up_, true)) counters.reconnects.add();
        if (const auto idle = info.endpoint.options.idle) retry_.after(*idle);
        core_.events.mark_up(peer_);
    }
    void on_leave(PeerNumber number, std::string_view why) override {
        if (number != peer_.number()) return;
        peer_.finish();
        const bool lasted = core_.now() - up_since_ >= Retry::lasting || peer_.last_heard > up_since_;
        peer_.end();
        core_.events.mark_down(peer_, why);
        if (lasted) retry_.reset();
        retry_.later();
    }
    void on_fail(const SetupError& error) override { retry_.fail(error); }
    void check_idle(MonoTime now) {
        const Nanoseconds idle = *info.endpoint.options.idle;
        if (now - peer_.last_heard < idle) return retry_.after(peer_.last_heard + idle - now);
        transport_->close(peer_.number(), "idle");
        on_leave(peer_.number(), "idle");
    }
    ThreadedPeer* find(PeerNumber number) override { return number == peer_.number() ? &peer_ : nullptr; }

    ThreadedPeer peer_;
    MonoTime up_since_{};
    bool was_up_ = false;
};

}  // namespace

Opened open_threaded(Opening opening) {
    return opening.endpoint.listens() ? open_listening<ThreadedIn>(std::move(opening))
                                      : open_destination<ThreadedOut>(std::move(opening));
}

}  // namespace mavloom::link::detail
