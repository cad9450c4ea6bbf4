// SPDX-License-Identifier: MIT
#include "mavloom/link/transport.hpp"

namespace mavloom::link {

using Kind = Mailbox::Event::Kind;

// A batch frees its memory after more than this.
static constexpr std::size_t kept_bytes = std::size_t{1} << 20;

static void put_bytes(Mailbox::Batch& batch, Mailbox::Event event, ByteView bytes) {
    event.offset = batch.bytes.size();
    event.size = bytes.size();
    batch.bytes.insert(batch.bytes.end(), bytes.begin(), bytes.end());
    batch.events.push_back(event);
}

static void put_text(Mailbox::Batch& batch, Mailbox::Event event, std::string_view text) {
    put_bytes(batch, event, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

void Mailbox::Batch::clear() noexcept {
    events.clear();
    bytes.clear();
    peers.clear();
    errors.clear();
}

// Calls put(batch_) under the lock, and wakes Links for the first event. Returns what `put` returns.
template <class Put>
bool Mailbox::add(Put&& put) {
    {
        const std::lock_guard lock(mutex_);
        if (is_closed_) return true;
        const bool is_first = batch_.events.empty();
        if (!put(batch_)) return false;
        if (!is_first) return true;
    }
    arrived_.notify_one();
    wake_();
    return true;
}

void Mailbox::join(const NewPeer& peer) {
    (void)add([&](Batch& batch) {
        // A transport that Links lets call again may have ended the last connection without a word.
        std::erase_if(waiting_, [](const auto& other) { return other.second == 0; });
        batch.events.push_back({.kind = Kind::join, .peer = peer.number, .offset = batch.peers.size()});
        batch.peers.push_back(peer);
        return true;
    });
}

void Mailbox::leave(PeerNumber peer, std::string_view why) {
    (void)add([&](Batch& batch) {
        waiting_.erase(peer);
        put_text(batch, {.kind = Kind::leave, .peer = peer}, why);
        return true;
    });
}

void Mailbox::fail(const SetupError& error) {
    (void)add([&](Batch& batch) {
        batch.events.push_back({.kind = Kind::fail, .offset = batch.errors.size()});
        batch.errors.push_back(error);
        return true;
    });
}

void Mailbox::notice(std::string_view text) {
    (void)add([&](Batch& batch) {
        put_text(batch, {.kind = Kind::notice}, text);
        return true;
    });
}

bool Mailbox::deliver(PeerNumber peer, ByteView message, WallTime time) {
    return add([&](Batch& batch) {
        const std::size_t bytes = message.size() + sizeof(Event);
        std::size_t& waiting = waiting_[peer];
        const bool is_full = waiting != 0 && (waiting + bytes > max_peer_bytes || all_waiting_ + bytes > max_bytes);
        was_full_ = was_full_ || is_full;
        if (is_full) return false;
        waiting += bytes;
        all_waiting_ += bytes;
        put_bytes(batch, {.kind = Kind::message, .peer = peer, .time = time}, message);
        return true;
    });
}

void Mailbox::note_sent(PeerNumber peer, std::size_t bytes) {
    (void)add([&](Batch& batch) {
        const bool goes_on = !batch.events.empty() && batch.events.back().kind == Kind::sent &&
                             batch.events.back().peer == peer;
        if (goes_on) batch.events.back().size += bytes;
        else batch.events.push_back({.kind = Kind::sent, .peer = peer, .size = bytes});
        return true;
    });
}

bool Mailbox::exchange(Batch& read) {
    if (read.bytes.capacity() > kept_bytes) read = {};
    read.clear();
    const std::lock_guard lock(mutex_);
    std::swap(read, batch_);
    for (auto& [peer, bytes] : waiting_) bytes = 0;
    all_waiting_ = 0;
    return std::exchange(was_full_, false);
}

void Mailbox::wait(std::chrono::milliseconds limit) {
    std::unique_lock lock(mutex_);
    arrived_.wait_for(lock, limit, [&] { return !batch_.events.empty(); });
}

void Mailbox::close() {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
}

}  // namespace mavloom::link
