// SPDX-License-Identifier: MIT
// A link's own loss, from sequence numbers: per (system, component) of one link, so that several sources, redundant copies and reordering are
// not taken for loss. And the restarts of its vehicles, whose sequence numbers begin anew. Feed it every well-framed frame of the link, those of
// unknown id and those that are filtered later included, but no echoes.
// One owner thread. Allocates when a new source is heard (at most `max_sources`), never for a known one.
//
// With d = the signed 8-bit distance to the expected number: 0 is good; 1 to 100 a gap of d lost frames; -30 to -1 a duplicate (the same bytes
// were heard) or a late frame (one fewer lost); anything else a resync, which counts no loss.
//
// A restart shows by `time_boot_ms` that falls by more than `boot_tolerance_ms`, within one message of one source: SYSTEM_TIME of any source at
// once, other messages of autopilots (component 1) when the next frame of that message confirms it. 0 means that the sender has no clock yet.
// docs/guide/routing.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mavloom/base/ids.hpp"
#include "mavloom/wire/frame.hpp"
#include "mavloom/wire/message_table.hpp"

namespace mavloom::wire {

struct SequenceStats {
    Source source;
    std::uint64_t received = 0;
    std::uint64_t lost = 0;  // after late frames were taken back
    std::uint64_t late = 0;
    std::uint64_t duplicate = 0;
    std::uint64_t resync = 0;  // jumps that are no loss: a restart, another sender with the same id
    bool no_sequence = false;  // the sender does not count: always the same number
};

class SequenceTracker {
public:
    static constexpr std::size_t max_sources = 4096;

    enum class Verdict : std::uint8_t { first, good, gap, late, duplicate, resync, reboot, no_sequence, untracked };
    // How one frame changed the sums. A gap raises `lost`, a late frame takes one back, a reboot all that its jump was taken for.
    struct Update {
        Verdict verdict = Verdict::good;
        std::int32_t lost = 0, late = 0, duplicate = 0, resync = 0;
    };
    // A clock that fell by less is two frames that overtook each other.
    static constexpr std::uint32_t boot_tolerance_ms = 1000;

    SequenceTracker();

    // `info` is null for an id without definition.
    Update update(const FrameView& frame, const MessageInfo* info = nullptr);
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

    struct Clock {  // time_boot_ms of one message
        std::uint32_t id;
        std::uint32_t newest_ms;
        bool fell;  // the last frame's was lower
    };
    enum class ClockVerdict : std::uint8_t { says_nothing, runs, restarted };

    struct State {
        std::array<std::uint32_t, window> recent{};  // fingerprint of the frame with sequence number s at [s % window]; 0: none
        std::uint8_t expected = 0;
        std::uint8_t repeats = 0;
        bool fresh = true;  // nothing is expected yet
        std::uint8_t clock_count = 0;
        std::array<Clock, 4> clocks{};  // of the first messages that had one
        Update since_clock_ran{};       // how the sums changed since: what a restart takes back
    };

    [[nodiscard]] std::size_t find_or_add(Source source);
    [[nodiscard]] static Update judge(SequenceStats& stats, State& state, const FrameView& frame) noexcept;
    static void watch_clock(SequenceStats& stats, State& state, const FrameView& frame, const MessageInfo& info,
                            Update& update) noexcept;
    [[nodiscard]] static ClockVerdict read_clock(State& state, MessageId id, std::uint32_t boot_ms) noexcept;

    std::vector<std::uint16_t> index_of_;  // per 256 * system + component: index plus one, 0 unheard; pages allocated per system
    std::array<std::uint16_t, 256> page_of_{};
    std::vector<SequenceStats> stats_;
    std::vector<State> states_;
    std::uint64_t untracked_ = 0;
};

}  // namespace mavloom::wire
