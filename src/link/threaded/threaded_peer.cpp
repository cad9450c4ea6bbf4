// SPDX-License-Identifier: MIT
#include "link/threaded/threaded_peer.hpp"

#include <cassert>

namespace mavloom::link::detail {

void ThreadedPeer::begin(PeerNumber number) {
    assert(number != 0 && messages_ == 0);
    number_ = number;
    last_heard = core_.now();
    // While nobody was connected, no frame was dropped for its age.
    expire(core_.now());
    is_scheduled = !queue.empty();
    if (is_scheduled) schedule();
}

void ThreadedPeer::end() {
    number_ = 0;
    for (; messages_ != 0; --messages_, first_ = (first_ + 1) % max_messages)
        counters.frames_not_sent.add(sending_[first_].frames);
    sent_bytes_ = 0;
    core_.outlets.forget(*this);
    if (border) border->drop(Way::in);
    is_scheduled = !queue.empty();
}

void ThreadedPeer::take(ByteView message, WallTime time) {
    if (!border) [[likely]] {
        hear(message, time);
    } else {
        border->take(Way::in, {.bytes = message, .time = time});
    }
}

void ThreadedPeer::hear(ByteView message, WallTime time) {
    if (number_ == 0) return;
    const std::uint64_t frames_before = counters.frames_in.value();
    parser_.parse(message, [&](const wire::ParseEvent& event) { core_.on_event(*this, event, time); });
    counters.implausible_unknown.set(parser_.counters().implausible_unknown.value());
    if (counters.frames_in.value() != frames_before) last_heard = core_.now();
}

void ThreadedPeer::note_sent(std::size_t bytes) {
    count_sent(bytes);
    if (!queue.empty()) schedule();
}

void ThreadedPeer::count_sent(std::size_t bytes) {
    sent_bytes_ += bytes;
    while (messages_ != 0 && sent_bytes_ >= sending_[first_].bytes) {
        counters.frames_out.add(sending_[first_].frames);
        counters.bytes_out.add(sending_[first_].bytes);
        sent_bytes_ -= sending_[first_].bytes;
        first_ = (first_ + 1) % max_messages;
        --messages_;
    }
}

void ThreadedPeer::flush() {
    while (number_ != 0 && messages_ < max_messages && !queue.empty()) send_one();
    is_scheduled = !queue.empty();
}

void ThreadedPeer::send_one() {
    std::array<iovec, pieces_per_message> pieces;
    auto until = queue.front();
    const auto gathered = queue.gather(until, max_message_bytes, pieces);
    assert(gathered.blocks != 0);
    const std::size_t sent = transport_.send(number_, std::span(pieces).first(gathered.pieces));
    queue.pop(until);
    sending_[(first_ + messages_) % max_messages] = {static_cast<std::uint32_t>(gathered.blocks),
                                                     static_cast<std::uint32_t>(gathered.bytes)};
    ++messages_;
    count_sent(sent);
}

}  // namespace mavloom::link::detail
