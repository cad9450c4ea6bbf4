// SPDX-License-Identifier: MIT
#include "mavloom/wire/unknown_ids.hpp"

#include <algorithm>

#include "mavloom/wire/frame_checksum.hpp"

namespace mavloom::wire {

static std::uint64_t key_of(const FrameView& frame) noexcept {
    return std::uint64_t{frame.id().value} << 16 | std::uint64_t{frame.system().value} << 8 | frame.component().value;
}

std::size_t UnknownIds::index_of(std::uint64_t key) const noexcept {
    return static_cast<std::size_t>(std::ranges::find(entries_, key, &Entry::key) - entries_.begin());
}

UnknownIds::Verdict UnknownIds::judge(const FrameView& frame) const noexcept {
    const int extra = crc_extra_of(frame);
    if (extra < 0) return Verdict::impossible;
    const auto index = index_of(key_of(frame));
    if (index == entries_.size() || entries_[index].agreed < confirmations) return Verdict::possible;
    return entries_[index].extra == extra ? Verdict::confirmed : Verdict::impossible;
}

bool UnknownIds::learn(const FrameView& frame) noexcept {
    const int fitting = crc_extra_of(frame);
    if (fitting < 0) return false;
    const auto extra = static_cast<std::uint8_t>(fitting);
    const auto key = key_of(frame);
    const auto index = index_of(key);
    if (index == entries_.size()) {
        if (index < capacity) entries_.push_back({key, extra, 1, 0, 0});
        return true;
    }
    auto& entry = entries_[index];
    if (entry.extra == extra) {
        entry.agreed = std::min<std::uint8_t>(entry.agreed + 1, confirmations);
        entry.rival_agreed = 0;
        return true;
    }
    const bool confirmed = entry.agreed >= confirmations;
    entry.rival_agreed = entry.rival == extra ? static_cast<std::uint8_t>(entry.rival_agreed + 1) : std::uint8_t{1};
    entry.rival = extra;
    if (confirmed && entry.rival_agreed < confirmations) return false;
    entry = {key, extra, confirmed ? entry.rival_agreed : std::uint8_t{1}, 0, 0};
    return true;
}

}  // namespace mavloom::wire
