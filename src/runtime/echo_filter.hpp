// SPDX-License-Identifier: MIT
// Knows the frames that were sent to a ring's inlet a moment ago: the router writes them into the ring as it does all others, and whoever sent them does
// not want them back. Private to module runtime; one owner thread; nothing allocates.
#pragma once

#include <array>
#include <bitset>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "mavloom/base/clock.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::runtime::detail {

class EchoFilter {
public:
    static constexpr Nanoseconds memory = std::chrono::seconds(2);  // as the router's (docs/guide/route.md)

    void remember(const wire::FrameView& frame, MonoTime now) noexcept {
        entries_[next_++ % entries_.size()] = {key_of(frame), now};
        systems_.set(frame.system().value);
    }
    // Whether anything was sent of that system: false for most frames, which need no further look.
    [[nodiscard]] bool knows(SystemId system) const noexcept { return systems_.test(system.value); }
    // Whether it was sent and not yet seen since.
    [[nodiscard]] bool takes_back(const wire::FrameView& frame, MonoTime now) noexcept {
        for (auto& entry : entries_) {
            if (entry.key != key_of(frame) || entry.sent == MonoTime{} || now - entry.sent > memory) continue;
            entry = {};
            return true;
        }
        return false;
    }

private:
    struct Entry {
        std::uint64_t key = 0;
        MonoTime sent{};
    };
    [[nodiscard]] static std::uint64_t key_of(const wire::FrameView& frame) noexcept {
        return std::uint64_t{frame.id().value} | std::uint64_t{frame.system().value} << 24 |
               std::uint64_t{frame.component().value} << 32 | std::uint64_t{frame.sequence()} << 40 |
               std::uint64_t{frame.checksum()} << 48;
    }

    std::array<Entry, 256> entries_{};
    std::size_t next_ = 0;
    std::bitset<256> systems_;
};

}  // namespace mavloom::runtime::detail
