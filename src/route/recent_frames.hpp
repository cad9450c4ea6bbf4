// SPDX-License-Identifier: MIT
// The frames of the last moments by the hash of their bytes, with the links that each was heard on and sent to: what is needed to know a copy
// or an echo. Fixed memory: four places to a bucket, of which the oldest gives way. Private to module route; one owner thread.
#pragma once

#include <cstdint>
#include <vector>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/clock.hpp"
#include "route/link_set.hpp"

namespace mavloom::route {

// 64 bits over the bytes of a frame (8 or more), never 0.
[[nodiscard]] std::uint64_t hash_of(ByteView frame, std::uint64_t seed) noexcept;

class RecentFrames {
public:
    // Room for about `capacity` frames and links in `words` words each, keeping what there is. With a capacity of 0 it remembers nothing.
    void resize(std::size_t capacity, std::size_t words);
    [[nodiscard]] bool active() const noexcept { return !entries_.empty(); }

    // False where the frame is not known. `index` is then its bucket's first place, else where it is; valid until the next `put` or `resize`.
    [[nodiscard]] bool find(std::uint64_t hash, std::size_t& index) const noexcept;
    // Begins anew for the frame that was `found` at `index`, or was not: heard and sent nowhere. True if one younger than `window` had to give
    // way.
    bool put(std::uint64_t hash, MonoTime now, Nanoseconds window, bool found, std::size_t& index) noexcept;

    [[nodiscard]] MonoTime time(std::size_t index) const noexcept { return entries_[index].time; }
    [[nodiscard]] Words heard(std::size_t index) noexcept { return &sets_[2 * words_ * index]; }
    [[nodiscard]] Words sent(std::size_t index) noexcept { return heard(index) + words_; }

    // The link is gone and its slot will be another's.
    void forget(Slot slot) noexcept;

private:
    static constexpr std::size_t ways = 4;
    static constexpr std::size_t most_set_bytes = 8u << 20;

    struct Entry {
        std::uint64_t hash = 0;  // 0: empty
        MonoTime time = MonoTime::min();
    };

    [[nodiscard]] std::size_t bucket(std::uint64_t hash) const noexcept {
        return static_cast<std::size_t>(hash) & (entries_.size() - 1) & ~(ways - 1);
    }

    std::vector<Entry> entries_;       // a power of two
    std::vector<std::uint64_t> sets_;  // of each entry: heard, sent
    std::size_t words_ = 0;
};

}  // namespace mavloom::route
