// SPDX-License-Identifier: MIT
#include "mavloom/feed/newest_frames.hpp"

#include <limits>

namespace mavloom::feed {

NewestFrames::Key NewestFrames::key_of(const wire::FrameView& frame, const dialect::Message* definition) {
    const auto* field = definition == nullptr ? nullptr : message::instance_field(*definition);
    return {frame.id().value, frame.source(),
            field == nullptr ? message::Instance() : message::instance_of(*definition, *field, frame.payload())};
}

void NewestFrames::put(const Key& key, const FrameRing::Head& head, const wire::FrameView& frame, MonoTime now) {
    ++frames_;
    auto* const kept = place_of(key);
    if (kept == nullptr) {
        ++not_kept_;
        return;
    }
    kept->head = head;
    kept->arrived = now;
    kept->number = frames_;
    const auto bytes = frame.bytes();
    kept->bytes.assign(bytes.begin(), bytes.end());
}

NewestFrames::Entry* NewestFrames::place_of(const Key& key) {
    if (const auto found = entries_.find(key); found != entries_.end()) return &found->second;
    if (entries_.size() == capacity) return nullptr;
    return &entries_.emplace(key, Entry{}).first->second;
}

const NewestFrames::Entry* NewestFrames::find(const dialect::Filter& filter,
                                              const std::optional<message::Instance>& instance,
                                              MonoTime not_before) const {
    const Entry* newest = nullptr;
    for (const auto& [key, kept] : entries_) {
        if (instance && key.instance != *instance) continue;
        if (kept.arrived < not_before || (newest != nullptr && kept.number < newest->number)) continue;
        if (filter.admits(kept.frame())) newest = &kept;
    }
    return newest;
}

bool NewestFrames::has(MessageId id) const {
    const auto first = entries_.lower_bound(Key{id.value, {}, std::numeric_limits<std::int64_t>::min()});
    return first != entries_.end() && first->first.id == id.value;
}

}  // namespace mavloom::feed
