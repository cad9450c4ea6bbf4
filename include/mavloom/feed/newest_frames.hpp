// SPDX-License-Identifier: MIT
// NewestFrames: a copy of the newest frame of each source, message id and instance. Bounded, so that forged sources
// cannot fill the memory. Not synchronized.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/dialect/filter.hpp"
#include "mavloom/feed/frame_ring.hpp"
#include "mavloom/message/instance.hpp"

namespace mavloom::feed {

class NewestFrames {
public:
    // How many frames are kept. Once that many are kept, frames with a new source, id or instance are only counted.
    static constexpr std::size_t capacity = 16'384;

    struct Entry {
        FrameRing::Head head;
        MonoTime arrived{};
        std::uint64_t number = 0;  // counts all frames: the highest number is the newest
        std::vector<std::uint8_t> bytes;

        [[nodiscard]] wire::FrameView frame() const noexcept { return wire::FrameView::unchecked(bytes); }
    };
    struct Key {
        std::uint32_t id = 0;
        Source source;
        message::Instance instance;
        friend auto operator<=>(const Key&, const Key&) = default;
    };

    // `definition` is null for a message that the dialect does not define.
    [[nodiscard]] static Key key_of(const wire::FrameView& frame, const dialect::Message* definition);

    // Keeps a copy of the frame, in place of the previous one with the same key.
    void put(const Key& key, const FrameRing::Head& head, const wire::FrameView& frame, MonoTime now);
    // Returns the newest frame that matches the filter and `instance` and arrived at `not_before` or later; null if
    // there is none. Valid until the next `put`.
    [[nodiscard]] const Entry* find(const dialect::Filter& filter, const std::optional<message::Instance>& instance,
                                    MonoTime not_before) const;
    [[nodiscard]] bool has(MessageId id) const;
    // Frames that were not kept because the table was full.
    [[nodiscard]] std::uint64_t not_kept() const noexcept { return not_kept_; }

private:
    [[nodiscard]] Entry* place_of(const Key& key);

    std::map<Key, Entry> entries_;
    std::uint64_t frames_ = 0, not_kept_ = 0;
};

}  // namespace mavloom::feed
