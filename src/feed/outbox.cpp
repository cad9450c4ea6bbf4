// SPDX-License-Identifier: MIT
#include "feed/outbox.hpp"

#include <algorithm>
#include <utility>

namespace mavloom::feed {

Outbox::Entry::Entry(link::EndpointId to, const wire::FrameView& frame)
    : to_(to), size_(static_cast<std::uint16_t>(frame.size())) {
    std::ranges::copy(frame.bytes(), bytes_.begin());
}

Outbox::Put Outbox::put(link::EndpointId to, const wire::FrameView& frame) {
    std::unique_lock lock(mutex_);
    room_made_.wait(lock, [&] { return entries_.size() < capacity || closed_; });
    if (closed_) return Put::closed;
    const bool was_empty = entries_.empty();
    entries_.emplace_back(to, frame);
    return was_empty ? Put::first : Put::queued;
}

std::vector<Outbox::Entry> Outbox::take() {
    std::vector<Entry> taken;
    const std::lock_guard lock(mutex_);
    if (entries_.empty()) return taken;
    taken.swap(entries_);
    room_made_.notify_all();
    return taken;
}

std::vector<Outbox::Entry> Outbox::close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    room_made_.notify_all();
    return std::exchange(entries_, {});
}

}  // namespace mavloom::feed
