// SPDX-License-Identifier: MIT
// Frames whose id has no definition, and so no CRC_EXTRA, can still be told from noise: only 256 of the 65,536 possible checksums are reachable
// by some CRC_EXTRA, and one source always uses the same. This class learns that byte per (system, component, id) of one link and from then on
// checks it like a known one. One owner thread; at most 256 entries, all allocated at construction.
// Source: routing.md section 5.4, DESIGN.md section 4.
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
    static constexpr std::uint8_t confirmations = 3;  // agreeing frames that make a byte the learned one, or replace it

    enum class Verdict : std::uint8_t {
        impossible,  // no CRC_EXTRA gives this checksum, or not the learned one: damaged
        possible,    // fits, but nothing is learned yet: needs the plausibility of its surroundings
        confirmed,   // fits the learned byte
    };

    UnknownIds() { entries_.reserve(capacity); }

    // Looks only; learns nothing.
    [[nodiscard]] Verdict judge(const FrameView& frame) const noexcept;
    // The frame was accepted, or was refused only because it does not agree with the learned byte: updates the memory. Returns false in the
    // second case, until as many others agree with each other as it takes to relearn.
    bool learn(const FrameView& frame) noexcept;

    [[nodiscard]] std::size_t size() const noexcept { return entries_.size(); }

private:
    struct Entry {
        std::uint64_t key = 0;
        std::uint8_t extra = 0, agreed = 0;        // the byte in use and how many frames agreed (up to `confirmations`)
        std::uint8_t rival = 0, rival_agreed = 0;  // a different byte seen since
    };

    // entries_.size() where the key is not there.
    [[nodiscard]] std::size_t index_of(std::uint64_t key) const noexcept;

    std::vector<Entry> entries_;
};

}  // namespace mavloom::wire
