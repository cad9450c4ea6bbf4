// SPDX-License-Identifier: MIT
// Checks frames whose message id has no definition, and so no known CRC_EXTRA. For a given frame, only 256 of the
// 65,536 possible checksums correspond to a CRC_EXTRA. A source always uses the same CRC_EXTRA for a message id. This
// class learns that byte per (system, component, id) of one link and then checks frames as if the id were known. One
// owner thread; at most 256 entries, all allocated at construction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mavloom/base/ids.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::wire {

class UnknownIds {
public:
    static constexpr std::size_t capacity = 256;
    // This many agreeing frames confirm a byte, or replace a confirmed one.
    static constexpr std::uint8_t confirmations = 3;

    enum class Verdict : std::uint8_t {
        impossible,  // no CRC_EXTRA fits, or the one that fits is not the confirmed one: the frame is damaged
        possible,    // some CRC_EXTRA fits, but none is confirmed yet: check the surrounding bytes
        confirmed,   // the confirmed byte fits
    };

    UnknownIds() { entries_.reserve(capacity); }

    // Judges the frame; learns nothing.
    [[nodiscard]] Verdict judge(const FrameView& frame) const noexcept;
    // Learns from a frame that `judge` accepted, or rejected only because it disagrees with the confirmed byte. Returns
    // true if the caller should accept the frame. Returns false if no CRC_EXTRA fits, or if the one that fits differs
    // from the confirmed byte. After `confirmations` frames that agree on another byte, that byte becomes the confirmed
    // one.
    bool learn(const FrameView& frame) noexcept;

    [[nodiscard]] std::size_t size() const noexcept { return entries_.size(); }

private:
    struct Entry {
        std::uint64_t key = 0;
        std::uint8_t extra = 0, agreed = 0;  // the byte in use, and how many frames agreed (up to `confirmations`)
        std::uint8_t rival = 0, rival_agreed = 0;  // a different byte seen since, and how often
    };

    // Returns entries_.size() if the key is not there.
    [[nodiscard]] std::size_t index_of(std::uint64_t key) const noexcept;

    std::vector<Entry> entries_;
};

}  // namespace mavloom::wire
