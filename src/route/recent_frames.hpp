// SPDX-License-Identifier: MIT
// A table of recent frames, to recognize copies and echoes. For each frame it keeps a hash of its bytes, the links that
// received it, and the links that it was sent to.
//
// Memory is fixed: each bucket has four places, and a new frame evicts the oldest. Private to module route; one owner
// thread.
#pragma once

#include <cassert>
#include <cstdint>
#include <vector>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/clock.hpp"
#include "route/link_set.hpp"
#include "route/zeroed_array.hpp"

namespace mavloom::route {

// A 64-bit hash of a frame's bytes, of which there must be at least 8. Never 0.
[[nodiscard]] std::uint64_t hash_of(ByteView frame, std::uint64_t seed) noexcept;

class RecentFrames {
public:
    // Makes room for about `capacity` frames, with link sets of `words` words, and keeps the remembered frames. With a
    // capacity of 0 the table is inactive.
    void resize(std::size_t capacity, std::size_t words);
    [[nodiscard]] bool active() const noexcept { return places_ != 0; }

    // Prefetches the frame's bucket into the cache.
    void prefetch(std::uint64_t hash) const noexcept {
        const std::uint64_t* place = &cells_[bucket(hash)];
        for (std::size_t i = 0; i < ways; ++i, place += stride_) __builtin_prefetch(place, 1);
    }

    // Returns whether the frame is known. `index` becomes its place, or the first place of its bucket if it is unknown.
    // The index is valid until the next `put` or `resize`.
    [[nodiscard]] bool find(std::uint64_t hash, std::size_t& index) noexcept;
    // Starts a new entry, with empty link sets, at the place that `find` returned. If the frame was not `found`, this
    // evicts the oldest of the bucket and updates `index`. Returns true if the evicted entry was younger than `window`.
    bool put(std::uint64_t hash, MonoTime now, Nanoseconds window, bool found, std::size_t& index) noexcept;

    [[nodiscard]] MonoTime time(std::size_t index) const noexcept { return MonoTime(Nanoseconds(time_ns(index))); }
    [[nodiscard]] Words heard(std::size_t index) noexcept { return &cells_[index + 2]; }
    [[nodiscard]] Words sent(std::size_t index) noexcept { return heard(index) + words_; }

    // Call when a new link takes a slot while remembered frames may still hold the bit of the slot's previous link.
    // From then on, `find` removes that bit from frames up to `now`. `window`: how long frames are remembered.
    // Allocates.
    void retake(Slot slot, MonoTime now, Nanoseconds window);

private:
    static constexpr std::size_t ways = 4;
    static constexpr std::size_t max_bytes = 8u << 20;

    // A place's index is the index of its first cell.
    [[nodiscard]] std::size_t bucket(std::uint64_t hash) const noexcept {
        return (static_cast<std::size_t>(hash) & (places_ - 1) & ~(ways - 1)) * stride_;
    }
    [[nodiscard]] std::size_t end() const noexcept { return places_ * stride_; }
    [[nodiscard]] std::uint64_t hash(std::size_t index) const noexcept { return cells_[index]; }
    [[nodiscard]] std::int64_t time_ns(std::size_t index) const noexcept {
        return static_cast<std::int64_t>(cells_[index + 1]);
    }

    [[gnu::noinline]] void remove_stale(std::size_t index) noexcept;

    // Each place holds the hash (0 if empty), the time, and the sets `heard` and `sent`. With up to 64 links, a bucket
    // takes two cache lines.
    ZeroedArray<std::uint64_t> cells_;
    std::size_t places_ = 0;  // a power of two
    std::size_t words_ = 0, stride_ = 0;
    std::int64_t last_retake_ns_ = 0;
    std::vector<std::uint64_t> retaken_;  // set of slots
    std::vector<std::int64_t> taken_ns_;  // by slot; of those in retaken_
};

inline bool RecentFrames::find(std::uint64_t wanted, std::size_t& index) noexcept {
    assert(active());
    std::size_t i = index = bucket(wanted);
    for (std::size_t way = 0; way < ways; ++way, i += stride_) {
        if (hash(i) != wanted) continue;
        index = i;
        if (time_ns(i) <= last_retake_ns_) [[unlikely]]
            remove_stale(i);
        return true;
    }
    return false;
}

inline bool RecentFrames::put(std::uint64_t new_hash, MonoTime now, Nanoseconds window, bool found,
                              std::size_t& index) noexcept {
    assert(index < end() && index % stride_ == 0);
    bool evicted_young = false;
    if (!found) {
        std::size_t i = index;
        for (std::size_t way = 1; way < ways; ++way)
            if (i += stride_; time_ns(i) < time_ns(index)) index = i;
        evicted_young = hash(index) != 0 && now - time(index) < window;
    }
    cells_[index] = new_hash;
    cells_[index + 1] = static_cast<std::uint64_t>(now.time_since_epoch().count());
    each_word(words_, [&](std::size_t w) { heard(index)[w] = sent(index)[w] = 0; });
    return evicted_young;
}

}  // namespace mavloom::route
