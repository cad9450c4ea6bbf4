// SPDX-License-Identifier: MIT
// Computes the frame loss of one link from sequence numbers, and detects restarts of its vehicles. Sequences are
// tracked per source (system, component), so several sources, redundant copies and reordering do not count as loss.
// Call `update` for every well-formed frame of the link, including those with unknown ids and those that are filtered
// later, but not for echoes. One owner thread. Allocates when it sees a new source (at most `max_sources`), never for a
// known one.
//
// Let d be the signed 8-bit difference between the received and the expected sequence number:
// - 0: the frame is in order.
// - 1 to 100: a gap; d frames are lost.
// - -30 to -1: a duplicate, if the same bytes were received before or if d is -1. Otherwise it is a late frame, which
//   reduces the loss by one.
// - any other value: a resync, which counts no loss.
//
// A restart is detected when `time_boot_ms` falls by more than `boot_tolerance_ms` between two frames of the same
// message and source. For SYSTEM_TIME, one such frame is enough, from any component. Other messages count only from
// autopilots (component 1), and the next frame of that message must confirm the fall.
// A `time_boot_ms` of 0 means that the sender's clock does not run yet. See docs/guide/routing.md, "The rules".
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
    std::uint64_t lost = 0;  // late frames are already subtracted
    std::uint64_t late = 0;
    std::uint64_t duplicate = 0;
    std::uint64_t resync = 0;  // jumps that are not loss: a restart, or another sender with the same id
    bool no_sequence = false;  // the sender repeats the same sequence number in every frame
};

// A limit that several trackers share: how many sources they may have together, beyond the first few of each tracker.
// It bounds the memory that a sender can use by inventing ids on many links, and leaves room for the sources of other
// links.
class SourceBudget {
public:
    explicit SourceBudget(std::size_t sources) noexcept : left_(sources) {}

private:
    friend class SequenceTracker;
    std::size_t left_;
};

class SequenceTracker {
public:
    static constexpr std::size_t max_sources = 4096;
    static constexpr std::size_t own_sources = 16;  // sources of each tracker that no budget limits

    enum class Verdict : std::uint8_t { first, good, gap, late, duplicate, resync, reboot, no_sequence, untracked };
    // How one frame changed the totals. A gap raises `lost`, and a late frame lowers it by one. A reboot reverts the
    // counts that its jump in the sequence caused.
    struct Update {
        Verdict verdict = Verdict::good;
        std::int32_t lost = 0, late = 0, duplicate = 0, resync = 0;
    };
    // A smaller fall means that two frames arrived out of order.
    static constexpr std::uint32_t boot_tolerance_ms = 1000;

    SequenceTracker();
    SequenceTracker(const SequenceTracker&) = delete;
    SequenceTracker& operator=(const SequenceTracker&) = delete;
    ~SequenceTracker();

    // Takes sources beyond `own_sources` from `budget`, which must outlive the tracker. Call it before `update`.
    void limit_by(SourceBudget& budget) noexcept { budget_ = &budget; }
    // `info` is null for an id without definition. Returns a reference that is valid until the next call.
    const Update& update(const FrameView& frame, const MessageInfo* info = nullptr);
    // Forgets the expected sequence numbers: the next frame of each source is treated as its first. The totals stay.
    void restart() noexcept;

    // All sources, in the order in which they were first heard. `lost` is never negative.
    [[nodiscard]] std::span<const SequenceStats> sources() const noexcept { return stats_; }
    [[nodiscard]] SequenceStats total() const noexcept;
    // The number of frames from sources for which there was no room.
    [[nodiscard]] std::uint64_t untracked() const noexcept { return untracked_; }

private:
    // Recent frames remembered per source, to distinguish duplicates from late frames.
    static constexpr std::size_t window = 32;
    // A sender that repeats its sequence number this many times in a row is assumed not to count at all.
    static constexpr std::uint8_t constant_after = 8;

    struct Clock {  // time_boot_ms of one message
        std::uint32_t id = 0;
        std::uint32_t newest_ms = 0;
        bool fell = false;  // the last frame's value was lower than newest_ms
    };
    enum class ClockVerdict : std::uint8_t { unknown, runs, restarted };

    struct State {
        // The frame with sequence number s has its fingerprint at [s % window]; 0: none.
        std::array<std::uint32_t, window> recent{};
        std::uint8_t expected = 0;
        std::uint8_t repeats = 0;
        bool fresh = true;  // no sequence number is expected yet
        std::uint8_t clock_count = 0;
        std::array<Clock, 4> clocks{};  // the first messages that have a clock
        // Changes of the totals since the clock last advanced; a restart reverts them.
        Update since_clock_ran{};
    };

    [[nodiscard]] std::size_t find_or_add(Source source);
    std::size_t add(Source source);
    [[nodiscard]] bool has_room() noexcept;
    [[nodiscard]] const Update& changed(const Update& update) noexcept;
    [[nodiscard]] static Update judge(SequenceStats& stats, State& state, const FrameView& frame) noexcept;
    [[nodiscard]] static bool note_repeat(SequenceStats& stats, State& state) noexcept;
    [[nodiscard]] static Update count_duplicate(SequenceStats& stats) noexcept;
    [[nodiscard]] static Update count_late(SequenceStats& stats) noexcept;
    [[nodiscard]] static ClockVerdict watch_clock(State& state, const FrameView& frame,
                                                  const MessageInfo& info) noexcept;
    [[nodiscard]] static ClockVerdict read_clock(State& state, MessageId id, std::uint32_t boot_ms) noexcept;
    [[nodiscard]] static Update restarted(SequenceStats& stats, State& state, const FrameView& frame,
                                          const Update& update) noexcept;

    // A table from source to index, in pages of 64 components of one system. Each place holds an index into stats_ plus
    // one, or 0 if the source was not heard. Pages without a heard source share page 0, which stays empty.
    static constexpr std::size_t page_size = 64, page_count = 65536 / page_size;
    [[nodiscard]] static std::size_t page_number(Source source) noexcept;
    [[nodiscard]] std::size_t place_of(Source source) const noexcept;

    std::vector<std::uint16_t> index_of_;
    std::array<std::uint16_t, page_count> page_of_{};
    std::vector<SequenceStats> stats_;
    std::vector<State> states_;
    std::uint64_t untracked_ = 0;
    SourceBudget* budget_ = nullptr;
    Update changed_;  // what `update` returned last, unless the frame was good
};

// Most frames change no total.
inline constexpr SequenceTracker::Update no_loss{};

}  // namespace mavloom::wire
