// SPDX-License-Identifier: MIT
#include "route/recent_frames.hpp"

#include <algorithm>
#include <bit>
#include <cassert>

#include "mavloom/base/secret_hash.hpp"

namespace mavloom::route {

std::uint64_t hash_of(ByteView frame, std::uint64_t seed) noexcept {
    constexpr std::uint64_t k0 = 0x9e3779b97f4a7c15u, k1 = 0xd6e8feb86659fd93u;
    assert(frame.size() >= sizeof(std::uint64_t));
    const std::uint8_t* p = frame.data();
    std::size_t left = frame.size();
    std::uint64_t h = seed ^ folded_product(k0 ^ left, k1 ^ seed);
    for (; left > 16; left -= 16, p += 16)
        h = folded_product(load_le<std::uint64_t>(p) ^ k0, load_le<std::uint64_t>(p + 8) ^ k1 ^ h);
    // Mixes the last 8 to 16 bytes. If fewer than 8 are left, it reads some earlier bytes again.
    const std::uint8_t* const end = p + left;
    const std::uint64_t first = left >= 8 ? load_le<std::uint64_t>(p) : 0;
    h = folded_product(first ^ k1, load_le<std::uint64_t>(end - 8) ^ k0 ^ h);
    h = folded_product(h ^ k0, k1);
    return h == 0 ? 1 : h;
}

void RecentFrames::resize(std::size_t capacity, std::size_t words) {
    const std::size_t stride = 2 + 2 * words;
    if (capacity != 0) {
        capacity = std::bit_ceil(std::max<std::size_t>(capacity, 64));
        while (capacity > 4096 && capacity * stride * sizeof(std::uint64_t) > max_bytes) capacity /= 2;
    }
    assert(capacity == 0 || std::has_single_bit(capacity));
    if (capacity == places_ && words == words_) return;
    RecentFrames grown;
    grown.words_ = words;
    grown.stride_ = stride;
    grown.places_ = capacity;
    grown.cells_ = ZeroedArray<std::uint64_t>(capacity * stride);
    const std::size_t kept = std::min(words, words_);
    for (std::size_t i = 0; i < end() && capacity != 0; i += stride_) {
        if (hash(i) == 0) continue;
        std::size_t at = 0;
        const bool found = grown.find(hash(i), at);
        grown.put(hash(i), time(i), Nanoseconds{}, found, at);
        assign(grown.heard(at), heard(i), kept);
        assign(grown.sent(at), sent(i), kept);
    }
    grown.last_retake_ns_ = last_retake_ns_;
    grown.retaken_ = std::move(retaken_);
    grown.taken_ns_ = std::move(taken_ns_);
    *this = std::move(grown);
}

void RecentFrames::retake(Slot slot, MonoTime now, Nanoseconds window) {
    const std::int64_t now_ns = now.time_since_epoch().count();
    if (now_ns - last_retake_ns_ >= window.count()) std::ranges::fill(retaken_, 0);
    assert(slot < 64 * words_);
    retaken_.resize(words_);
    taken_ns_.resize(64 * words_);
    route::insert(retaken_.data(), slot);
    taken_ns_[slot] = last_retake_ns_ = now_ns;
}

void RecentFrames::remove_stale(std::size_t index) noexcept {
    assert(retaken_.size() <= words_ && taken_ns_.size() == 64 * retaken_.size());
    for (std::size_t w = 0; w < retaken_.size(); ++w)
        each_in_word((heard(index)[w] | sent(index)[w]) & retaken_[w], static_cast<Slot>(64 * w), [&](Slot slot) {
            if (time_ns(index) > taken_ns_[slot]) return;
            erase(heard(index), slot);
            erase(sent(index), slot);
        });
}

}  // namespace mavloom::route
