// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>

#include "link/udp/udp.hpp"
#include "mavloom/net/neighbours.hpp"

namespace mavloom::link::detail {

// Start a datagram only with room for this many pieces. Frames are contiguous in the queue, so few are needed. A
// datagram that would need more is cut short here.
static constexpr std::size_t min_pieces = 64;
// An ICMP error of an earlier datagram makes the next send fail without being tried. More errors may arrive between
// attempts, so a send is tried up to this many times.
static constexpr int max_refusals = 3;
static constexpr std::chrono::milliseconds retry_after{1};
static constexpr std::size_t max_unsplit = 1500 - 20 - 8;  // MTU of Ethernet, less the headers of IPv4 and UDP

void UdpPeer::schedule() { port->schedule(*this); }

void UdpPeer::hear(ByteView bytes, WallTime time) {
    if (up) port->hear(*this, bytes, time);
}

bool UdpPeer::note_heard(MonoTime now, std::size_t bytes) noexcept {
    bool confirms = false;
    if (has_allowance()) [[unlikely]] {
        confirms = now - first_heard >= confirmed_after;
        if (confirms) lift_allowance();
        else extend_allowance(answers_per_byte * static_cast<std::int64_t>(bytes));
    }
    last_heard = now;
    ++datagrams;
    listens_ = true;
    end_refusal();
    return confirms;
}

void UdpPeer::move_to(const net::Address& where) noexcept {
    if (where == address) return;
    address = where;
    listens_ = false;
    end_refusal();
}

void UdpPeer::note_refusal(MonoTime now) noexcept {
    listens_ = false;
    begin_refusal(now + refusal_holds);
    counters.refused.add(std::exchange(unsettled_frames_, 0));
    unsettled_bytes_ = 0;
}

void UdpPeer::note_missing(std::uint32_t interface, MonoTime now) noexcept {
    interface_ = interface;
    missing_until_ = now + announced_within;
}

void UdpPeer::note_found() noexcept {
    missing_until_ = {};
    end_refusal();
}

void UdpPeer::search(MonoTime now) noexcept {
    if (searches_.take(now)) net::look_for(address, interface_);
}

void UdpPeer::count_sent(std::uint32_t frames, std::uint32_t bytes, MonoTime now) noexcept {
    if (is_refused(now)) return counters.refused.add(frames);
    unsettled_frames_ += frames;
    unsettled_bytes_ += bytes;
    if (listens_) settle();
}

void UdpPeer::settle() noexcept {
    counters.frames_out.add(std::exchange(unsettled_frames_, 0));
    counters.bytes_out.add(std::exchange(unsettled_bytes_, 0));
}

UdpPeer* UdpOwner::find_peer(UdpPort& port, const net::Address& address) const { return port.peers().find(address); }

UdpPort::~UdpPort() {
    core_.outlets.forget(*this);
    core_.loop().cancel_timer(retry_);
    core_.loop().unwatch(watch_);
}

SetupResult<void> UdpPort::open(const net::Address& local, const net::UdpOptions& options) {
    auto socket = net::UdpSocket::open(local, options);
    if (!socket) return owner_.bind_errors.complete(std::move(socket).error(), local);
    auto watch = core_.loop().watch(socket->fd(), true, false, *this);
    if (!watch) return tl::unexpected(std::move(watch).error());
    core_.loop().unwatch(watch_);
    refresh_kernel_drops();
    socket_ = std::move(*socket);
    watch_ = *watch;
    last_drops_ = 0;
    blocked_ = false;
    return {};
}

void UdpPort::forget(UdpPeer& peer) noexcept {
    peers_.remove(peer.address);
    std::erase(waiting_, &peer);
    std::erase(unsettled_, &peer);
    for (Part& part : parts_)
        if (part.peer == &peer) part.peer = nullptr;
}

void UdpPort::refresh_kernel_drops() noexcept {
    if (!socket_) return;
    const std::uint32_t drops = socket_.kernel_drops();
    // The kernel's counter wraps at 2^32; unsigned subtraction stays correct.
    counters_.kernel_drop.add(drops - last_drops_);
    last_drops_ = drops;
}

void UdpPort::on_io(net::IoEvents events) {
    if (events.failed) take_failures();
    if (events.writable && blocked_) {
        blocked_ = false;
        core_.loop().change(watch_, true, false);
        core_.outlets.schedule(*this);
    }
    if (events.readable) receive();
}

void UdpPort::take_failures() {
    while (const auto failure = socket_.take_failure()) {
        counters_.send_errors.add();
        const bool nobody_there = failure->error == net::IoError::refused || failure->error == net::IoError::unreachable;
        UdpPeer* const peer = owner_.find_peer(*this, failure->to);
        if (peer != nullptr && nobody_there) {
            peer->note_refusal(core_.now());
            owner_.on_refused(*peer, failure->reporter);
        }
        owner_.on_send_error(failure->error, peer);
    }
}

// Refusals of datagrams sent in one turn are read in the next.
void UdpPort::settle_sent() noexcept {
    for (UdpPeer* const peer : unsettled_) peer->settle();
    unsettled_.clear();
    unsettled_turn_ = core_.turns();
}

void UdpPort::settle() {
    if (unsettled_.empty()) return;
    take_failures();
    settle_sent();
}

void UdpPort::on_timer(MonoTime) {
    retry_ = {};
    for (UdpPeer* peer : waiting_) peer->held = false;
    core_.outlets.schedule(*this);
}

void UdpPort::receive() {
    net::ReceiveBatch& batch = core_.receive_batch;
    const auto most = core_.reads_all ? net::ReceiveBatch::slots : budget_.limit();
    const auto count = socket_.receive(batch, most);
    // would_block, or an ICMP error. on_io also receives that error as `failed`.
    if (!count) return;
    if (*count == most) core_.note_more_waits();
    budget_.spend(*count, batch.bytes(), [&] { receive(batch); });
}

[[gnu::always_inline]] inline void UdpPort::parse(UdpPeer& peer, ByteView bytes, WallTime time) {
    const std::uint64_t frames_before = peer.counters.frames_in.value();
    peer.parser.parse(bytes, [&](const wire::ParseEvent& event) { core_.on_event(peer, event, time); });
    peer.counters.implausible_unknown.set(peer.parser.counters().implausible_unknown.value());
    if (peer.counters.frames_in.value() == frames_before) return;
    if (peer.note_heard(core_.now(), bytes.size())) [[unlikely]]
        owner_.on_confirmed(peer);
}

[[gnu::cold]] void UdpPort::hear(UdpPeer& peer, ByteView bytes, WallTime time) { parse(peer, bytes, time); }

[[gnu::noinline]] static void pass_stages(UdpPeer& peer, ByteView bytes, WallTime time) {
    peer.border->take(Way::in, {.bytes = bytes, .time = time});
}

void UdpPort::receive(const net::ReceiveBatch& batch) {
    for (std::size_t i = 0; i < batch.size(); ++i) {
        const net::Datagram datagram = batch[i];
        if (datagram.bytes.size() > max_unsplit) [[unlikely]]
            counters_.long_datagrams.add();
        UdpPeer* const peer = owner_.peer_of(*this, datagram);
        if (peer == nullptr) continue;
        const WallTime time = receive_time(datagram);
        if (peer->border) [[unlikely]] {
            pass_stages(*peer, datagram.bytes, time);
        } else {
            parse(*peer, datagram.bytes, time);
        }
    }
}

void UdpPort::expire(MonoTime now) {
    for (UdpPeer* peer : waiting_)
        if (blocked_ || peer->held || peer->is_missing(now)) peer->counters.queue_age.add(peer->queue.expire(now));
}

// Adds the peer's queue to the batch, unless its host is missing.
[[gnu::always_inline]] inline void UdpPort::gather(UdpPeer& peer) {
    if (peer.is_missing(core_.now())) [[unlikely]] {
        peer.search(core_.now());
        return;
    }
    net::SendBatch& batch = core_.send_batch;
    auto position = peer.queue.front();
    while (!peer.held) {
        if ((batch.full() || batch.room().size() < min_pieces) && (!submit() || peer.held)) break;
        const auto gathered = peer.queue.gather(position, mtu_bytes_, batch.room());
        if (gathered.blocks == 0) break;
        batch.add(&peer.address, gathered.pieces);
        parts_.push_back(
            {&peer, position, static_cast<std::uint32_t>(gathered.blocks), static_cast<std::uint32_t>(gathered.bytes)});
    }
}

void UdpPort::flush() {
    if (blocked_) return;
    core_.send_batch.clear();
    parts_.clear();
    for (std::size_t i = 0; i < waiting_.size() && !blocked_; ++i) gather(*waiting_[i]);
    if (!blocked_) submit();
    std::erase_if(waiting_, [](UdpPeer* peer) {
        peer->is_scheduled = !peer->queue.empty();
        peer->held = peer->held && peer->is_scheduled;
        return !peer->is_scheduled;
    });
    waits_ = !waiting_.empty();
}

// Sends the batch. Returns false if the kernel accepts no more for now. Unsent datagrams stay queued.
bool UdpPort::submit() {
    net::SendBatch& batch = core_.send_batch;
    assert(parts_.size() == batch.size() && "each datagram has its part");
    int refusals = 0;
    for (std::size_t first = 0; first < batch.size();) {
        const auto sent = socket_.send(batch, first);
        if (!sent) {
            recover(first, sent.error(), refusals);
            if (blocked_) break;
            continue;
        }
        for (std::size_t i = first; i < first + *sent; ++i) account(parts_[i]);
        first += *sent;
        refusals = 0;
    }
    batch.clear();
    parts_.clear();
    return !blocked_;
}

void UdpPort::account(const Part& part) noexcept {
    core_.note_datagram(part.frames);
    if (part.peer == nullptr) return;
    assert(!part.peer->held && "its datagrams keep their order");
    UdpPeer& peer = *part.peer;
    peer.queue.pop(part.until);
    if (unsettled_turn_ != core_.turns()) settle_sent();
    const bool was_settled = peer.is_settled();
    peer.count_sent(part.frames, part.bytes, core_.now());
    if (was_settled && !peer.is_settled()) unsettled_.push_back(&peer);
}

// Leaves `index` at the datagram to continue with.
void UdpPort::recover(std::size_t& index, net::IoError error, int& refusals) {
    if (error == net::IoError::would_block) return block();
    if (error == net::IoError::no_buffers) return hold(index);
    const bool may_be_of_another = error == net::IoError::refused || error == net::IoError::unreachable;
    if (may_be_of_another) take_failures();
    if (may_be_of_another && ++refusals < max_refusals) return;
    refusals = 0;
    counters_.send_errors.add();
    if (const Part& part = parts_[index++]; part.peer != nullptr) {
        part.peer->counters.frames_not_sent.add(part.frames);
        part.peer->queue.pop(part.until);
    }
    owner_.on_send_error(error, nullptr);
}

void UdpPort::block() {
    blocked_ = true;
    core_.loop().change(watch_, true, true);
}

// ENOBUFS means that a device queue is full, and no event reports when it has room again. Other peers may be
// reachable through another device, so only this peer waits. All its datagrams, which are adjacent in the batch, wait
// with it, to keep their order.
void UdpPort::hold(std::size_t& index) {
    UdpPeer* const peer = parts_[index].peer;
    if (peer != nullptr) peer->held = true;
    while (index < parts_.size() && parts_[index].peer == peer) ++index;
    if (!retry_.valid()) retry_ = core_.loop().start_timer(core_.now() + retry_after, *this);
}

}  // namespace mavloom::link::detail
