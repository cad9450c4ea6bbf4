// SPDX-License-Identifier: MIT
// A link's own loss, from sequence numbers: per (system, component) of one link, so that several sources, redundant copies and reordering are
// not taken for loss. Feed it every well-framed frame of the link, those of unknown id and those that are filtered later included.
// One owner thread. Allocates when a new source is heard (at most `max_sources`), never for a known one.
//
// With d = the signed 8-bit distance to the expected number (routing.md section 6): 0 is good; 1 to 100 a gap of d lost frames; -30 to -1
// a duplicate (the same bytes were heard) or a late frame (one fewer lost); anything else a resync, which counts no loss.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mavloom/base/ids.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::wire {

struct SequenceStats {
    Source source;
    std::uint64_t received = 0;
    std::uint64_t lost = 0;  // after late frames were taken back
    std::uint64_t late = 0;
    std::uint64_t duplicate = 0;
    std::uint64_t resync = 0;  // jumps too long to be loss: a reboot, another sender with the same id
    bool no_sequence = false;  // the sender does not count: always the same number
};

class SequenceTracker {
public:
    static constexpr std::size_t max_sources = 4096;

    enum class Verdict : std::uint8_t { first, good, gap, late, duplicate, resync, no_sequence, untracked };
    struct Update {
        Verdict verdict = Verdict::good;
        std::int16_t lost = 0;  // how the loss changed: up by a gap, down by one for a late frame that was counted
    };

    SequenceTracker();

    Update update(const FrameView& frame);
    // The next frame of each source is taken for its first: what came before has no bearing on it. The sums stay.
    void restart() noexcept;

    // All sources heard, in the order they were first heard. `lost` of a source never falls below zero.
    [[nodiscard]] std::span<const SequenceStats> sources() const noexcept { return stats_; }
    [[nodiscard]] SequenceStats total() const noexcept;
    // Frames of sources beyond `max_sources`.
    [[nodiscard]] std::uint64_t untracked() const noexcept { return untracked_; }

private:
    static constexpr std::size_t window = 32;  // recent frames remembered per source, to tell a duplicate from a late one
    static constexpr std::uint8_t constant_after = 8;  // equal numbers in a row that mark a sender without sequence

    struct State {
        std::array<std::uint32_t, window> recent{};  // fingerprint of the frame with sequence number s at [s % window]; 0: none
        std::uint8_t expected = 0;
        std::uint8_t repeats = 0;
        bool fresh = true;  // nothing is expected yet
    };

    [[nodiscard]] std::size_t find_or_add(Source source);
    [[nodiscard]] Update judge(SequenceStats& stats, State& state, const FrameView& frame) noexcept;

    std::vector<std::uint16_t> index_of_;  // per 256 * system + component: index plus one, 0 unheard; pages allocated per system
    std::array<std::uint16_t, 256> page_of_{};
    std::vector<SequenceStats> stats_;
    std::vector<State> states_;
    std::uint64_t untracked_ = 0;
};

}  // namespace mavloom::wire
