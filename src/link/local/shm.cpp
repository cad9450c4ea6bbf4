// SPDX-License-Identifier: MIT
// shm:// as a destination: sends frames to the inlet RUN/NAME.in, a Unix datagram socket that takes one whole frame
// per datagram. The inlet comes and goes with its router. Queued frames survive its absence until they are too old.
#include <fmt/format.h>

#include <algorithm>

#include "link/local/inlet.hpp"
#include "link/retry.hpp"
#include "mavloom/endpoint/checks.hpp"
#include "mavloom/net/run_folder.hpp"
#include "mavloom/shm/ring_info.hpp"

namespace mavloom::link::detail {

namespace {

// One byte, so that `gather` never adds a second frame to a datagram.
constexpr std::size_t one_frame = 1;
// Room for one frame: the queue stores each frame contiguously, so one piece is enough and the other is spare.
constexpr std::size_t max_pieces = 2;

class InletSender final : public OpenEndpoint, public Outlet, public net::IoHandler, public net::TimerHandler {
public:
    explicit InletSender(Opening& opening)
        : OpenEndpoint(opening),
          core_(opening.core),
          peer_(*this, opening.id, opening.endpoint.options),
          retry_(core_, *this, *this) {
        peer_.name = opening.endpoint.label();
        peer_.signature = signature.get();
        core_.add_link(peer_);
    }
    ~InletSender() override {
        core_.outlets.forget(*this);
        core_.loop().unwatch(watch_);
        core_.remove_link(peer_, "closed");
    }

    SetupResult<void> connect();
    void connect_or_retry();

    std::size_t send(const wire::FrameView& frame) override { return peer_.up && core_.send(peer_, frame) ? 1 : 0; }
    [[nodiscard]] std::size_t queued_bytes() const override { return peer_.queue.bytes(); }

    void flush() override;
    [[nodiscard]] bool blocked() const override { return !peer_.queue.empty(); }
    void expire(MonoTime now) override { peer_.counters.queue_age.add(peer_.queue.expire(now)); }
    void on_io(net::IoEvents events) override;
    void on_timer(MonoTime now) override {
        if (retry_.fired(now) && !socket_) connect_or_retry();
    }

private:
    struct Peer final : Link {
        Peer(InletSender& o, EndpointId owner, const endpoint::EndpointOptions& options)
            : Link(owner, options), inlet(o) {}
        void schedule() override { inlet.core_.outlets.schedule(inlet); }
        InletSender& inlet;
    };

    [[nodiscard]] bool fill(net::SendBatch& batch);
    [[nodiscard]] bool submit(net::SendBatch& batch);
    void took(std::size_t frames);
    void skip_one();
    void wait_for_room(bool waits);
    void lose();

    Core& core_;
    Peer peer_;
    net::LocalSender socket_;
    net::WatchId watch_;
    Retry retry_;
    MonoTime up_since_{};
    bool full_ = false, has_sent_ = false, was_up_ = false, reported_no_inlet_ = false;
};

SetupResult<void> InletSender::connect() {
    auto socket = net::connect_in_run_folder(info.endpoint.path, inlet_suffix);
    if (!socket) return tl::unexpected(std::move(socket.error()));
    auto watch = core_.loop().watch(socket->fd(), false, false, *this);
    if (!watch) return tl::unexpected(std::move(watch.error()));
    socket_ = std::move(*socket);
    watch_ = *watch;
    up_since_ = core_.now();
    has_sent_ = false;
    full_ = false;
    retry_.settle();
    retry_.reset();
    if (std::exchange(was_up_, true)) counters.reconnects.add();
    if (std::exchange(reported_no_inlet_, false))
        core_.events.notice(info.id, fmt::format("{}: its inlet is served now", info.endpoint.label()));
    // The same name that the ring's router gives this link.
    peer_.name = fmt::format("shm://{}#{}", info.endpoint.path, socket_.own_address());
    core_.events.mark_up(peer_);
    if (!peer_.queue.empty()) core_.outlets.schedule(*this);
    return {};
}

bool ring_exists(const std::string& name) {
    const auto names = shm::ring_names();
    return std::ranges::find(names, name) != names.end();
}

// The writer of an existing ring may never serve an inlet. That case is reported once, with its own text.
void InletSender::connect_or_retry() {
    auto done = connect();
    if (done) return;
    const bool is_absent = done.error().code == SetupCode::not_found && !was_up_;
    if (!is_absent || (!reported_no_inlet_ && !ring_exists(info.endpoint.path))) return retry_.fail(done.error());
    if (!std::exchange(reported_no_inlet_, true))
        core_.events.notice(info.id, fmt::format("{}: no program serves the inlet of this ring; frames sent to it are "
                                                 "dropped until one does",
                                                 info.endpoint.label()));
    retry_.fail_silently(done.error());
}

// The far side's router has ended. This only shows when a frame is sent, so a new router may already be running.
// A socket that refuses right after every connect is retried with back-off.
void InletSender::lose() {
    core_.loop().unwatch(watch_);
    socket_ = {};
    core_.events.mark_down(peer_, "the router is gone");
    const bool worked = has_sent_ || core_.now() - up_since_ >= Retry::initial_delay;
    if (!worked || !connect()) retry_.later();
}

void InletSender::on_io(net::IoEvents events) {
    if (!events.writable) return;
    wait_for_room(false);
    core_.outlets.schedule(*this);
}

void InletSender::wait_for_room(bool waits) {
    if (std::exchange(full_, waits) != waits) core_.loop().change(watch_, false, waits);
}

void InletSender::flush() {
    net::SendBatch& batch = core_.send_batch;
    while (socket_ && !full_ && fill(batch))
        if (!submit(batch)) break;
    peer_.is_scheduled = !peer_.queue.empty();
}

bool InletSender::fill(net::SendBatch& batch) {
    batch.clear();
    auto position = peer_.queue.front();
    while (!batch.full() && batch.room().size() >= max_pieces) {
        const auto gathered = peer_.queue.gather(position, one_frame, batch.room());
        if (gathered.blocks == 0) break;
        batch.add(nullptr, gathered.pieces);
    }
    return batch.size() != 0;
}

// Returns false if no more can be sent now.
bool InletSender::submit(net::SendBatch& batch) {
    const auto sent = socket_.send(batch, 0);
    if (sent) {
        took(*sent);
        return true;
    }
    if (sent.error() == net::IoError::would_block) {
        wait_for_room(true);
    } else if (sent.error() == net::IoError::refused || sent.error() == net::IoError::closed) {
        lose();
    } else {
        skip_one();
        return true;
    }
    return false;
}

void InletSender::took(std::size_t frames) {
    has_sent_ = true;
    std::array<iovec, max_pieces> pieces;
    auto position = peer_.queue.front();
    for (; frames != 0; --frames) {
        const auto gathered = peer_.queue.gather(position, one_frame, pieces);
        peer_.counters.frames_out.add(gathered.blocks);
        peer_.counters.bytes_out.add(gathered.bytes);
    }
    peer_.queue.pop(position);
}

// Drops a frame that the kernel rejects.
void InletSender::skip_one() {
    std::array<iovec, max_pieces> pieces;
    auto position = peer_.queue.front();
    peer_.counters.frames_not_sent.add(peer_.queue.gather(position, one_frame, pieces).blocks);
    peer_.queue.pop(position);
    counters.send_errors.add();
}

SetupResult<void> check_inlet(const endpoint::Endpoint& endpoint) {
    const auto& options = endpoint.options;
    if (!options.from_oldest && !options.lossless) return {};
    return setup_error(SetupCode::usage,
                       fmt::format("{}: '{}' applies to a ring that is read; this one is a destination",
                                   endpoint.label(), options.lossless ? "lossless" : "from"));
}

}  // namespace

Opened open_shm(Opening opening) {
    const endpoint::Endpoint& endpoint = opening.endpoint;
    if (auto checked = check_inlet(endpoint); !checked) return tl::unexpected(std::move(checked.error()));
    auto inlet = std::make_unique<InletSender>(opening);
    if (!endpoint.options.required) inlet->connect_or_retry();
    else if (auto done = inlet->connect(); !done)
        return tl::unexpected(std::move(done.error()).within(endpoint.label()));
    return inlet;
}

}  // namespace mavloom::link::detail
