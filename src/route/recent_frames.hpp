// SPDX-License-Identifier: MIT
// The frames of the last moments by the hash of their bytes, with the links that each was heard on and sent to: what is needed to know a copy
// or an echo. Fixed memory: four places to a bucket, of which the oldest gives way. Private to module route; one owner thread.
#pragma once

#include <cstdint>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/clock.hpp"
#include "route/link_set.hpp"
#include "route/zeroed_array.hpp"

namespace mavloom::route {

// 64 bits over the bytes of a frame (8 or more), never 0.
[[nodiscard]] std::uint64_t hash_of(ByteView frame, std::uint64_t seed) noexcept;

class RecentFrames {
public:
    // Room for about `capacity` frames and links in `words` words each, keeping what there is. With a capacity of 0 it remembers nothing.
    void resize(std::size_t capacity, std::size_t words);
    [[nodiscard]] bool active() const noexcept { return places_ != 0; }

    // Has the frame's bucket fetched from memory meanwhile.
    void prefetch(std::uint64_t hash) const noexcept {
        const std::uint64_t* place = &cells_[bucket(hash) * stride_];
        for (std::size_t i = 0; i < ways; ++i, place += stride_) __builtin_prefetch(place, 1);
    }

    // False where the frame is not known. `index` is then its bucket's first place, else where it is; valid until the next `put` or `resize`.
    [[nodiscard]] bool find(std::uint64_t hash, std::size_t& index) const noexcept;
    // Begins anew for the frame that was `found` at `index`, or was not: heard and sent nowhere. True if one younger than `window` had to give
    // way.
    bool put(std::uint64_t hash, MonoTime now, Nanoseconds window, bool found, std::size_t& index) noexcept;

    [[nodiscard]] MonoTime time(std::size_t index) const noexcept { return MonoTime(Nanoseconds(time_ns(index))); }
    [[nodiscard]] Words heard(std::size_t index) noexcept { return &cells_[index * stride_ + 2]; }
    [[nodiscard]] Words sent(std::size_t index) noexcept { return heard(index) + words_; }

    // The link is gone and its slot will be another's.
    void forget(Slot slot) noexcept;

private:
    static constexpr std::size_t ways = 4;
    static constexpr std::size_t most_bytes = 8u << 20;

    [[nodiscard]] std::size_t bucket(std::uint64_t hash) const noexcept {
        return static_cast<std::size_t>(hash) & (places_ - 1) & ~(ways - 1);
    }
    [[nodiscard]] std::uint64_t hash(std::size_t index) const noexcept { return cells_[index * stride_]; }
    [[nodiscard]] std::int64_t time_ns(std::size_t index) const noexcept {
        return static_cast<std::int64_t>(cells_[index * stride_ + 1]);
    }

    // A place is its hash (0: empty), time and the sets heard and sent, side by side: a bucket of up to 64 links is two cache lines.
    ZeroedArray<std::uint64_t> cells_;
    std::size_t places_ = 0;  // a power of two
    std::size_t words_ = 0, stride_ = 0;
};

inline bool RecentFrames::find(std::uint64_t wanted, std::size_t& index) const noexcept {
    const std::size_t first = index = bucket(wanted);
    for (std::size_t i = first; i < first + ways; ++i) {
        if (hash(i) != wanted) continue;
        index = i;
        return true;
    }
    return false;
}

inline bool RecentFrames::put(std::uint64_t new_hash, MonoTime now, Nanoseconds window, bool found,
                              std::size_t& index) noexcept {
    bool gave_way = false;
    if (!found) {
        const std::size_t first = index;
        for (std::size_t i = first + 1; i < first + ways; ++i)
            if (time_ns(i) < time_ns(index)) index = i;
        gave_way = hash(index) != 0 && now - time(index) < window;
    }
    cells_[index * stride_] = new_hash;
    cells_[index * stride_ + 1] = static_cast<std::uint64_t>(now.time_since_epoch().count());
    each_word(words_, [&](std::size_t w) { heard(index)[w] = sent(index)[w] = 0; });
    return gave_way;
}

}  // namespace mavloom::route
