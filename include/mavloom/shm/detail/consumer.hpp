// SPDX-License-Identifier: MIT
// The reader's side of the ring algorithm, over memory that is already mapped. RingReader handles slots, locks and
// liveness. One thread; allocates only at construction. docs/design/ring.md explains the algorithm, and
// docs/formats/ring.md its terms.
//
// A lossy reader copies a record, then checks whether the writer has announced (`intent`) that it may overwrite the
// record. If so, the reader discards the copy and continues at a mark. The mark's sequence number gives the exact
// number of records missed.
//
// A lossless reader keeps its bit in `holders` set while it looks at a record in place. The writer clears that bit
// before it overwrites anything that the reader holds.
#pragma once

#include <cassert>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "mavloom/shm/detail/ring_scan.hpp"
#include "mavloom/shm/record.hpp"

namespace mavloom::shm::detail {

template <class Words>
class Consumer {
public:
    Consumer() = default;
    // `slot` is the reader's slot, which it already owns. A reader without a slot leaves no trace in the ring
    // (read-only mapping). Lossless readers need a slot.
    Consumer(const RingMemory<Words>& ring, std::optional<unsigned> slot, bool lossless)
        : ring_(ring),
          slot_(slot),
          lossless_(lossless),
          copy_(lossless ? 0 : max_payload(ring.capacity) / sizeof(std::uint64_t) + 1) {
        assert(slot ? *slot < reader_slots : !lossless);
    }

    enum class Start : std::uint8_t { newest, oldest };
    // Moves to the next record that will be written, or to the oldest one in the ring. A lossless reader sets its hold
    // at that position. Returns false if the ring is damaged.
    [[nodiscard]] bool start(Start where) noexcept {
        for (int attempt = 0; attempt < max_attempts; ++attempt) {
            const std::uint64_t intent = ring_.control->intent.load(std::memory_order_acquire);
            const std::uint64_t tail = ring_.control->tail.load(std::memory_order_acquire);  // pairs with commit()
            auto at = where == Start::oldest ? find_mark(ring_, 0) : newest_mark(ring_);
            if (at && where == Start::newest) at = walk(ring_, *at, tail);
            // The writer has overtaken this reader, or the ring is damaged. It is damaged if the writer has not moved,
            // or if all attempts fail.
            if (!at) {
                if (ring_.control->intent.load(std::memory_order_acquire) == intent) return false;
                continue;
            }
            go_to(*at);
            if (!lossless_ || hold()) {
                publish();
                return true;
            }
        }
        return false;
    }

    enum class Found : std::uint8_t { record, empty, damaged };
    // Gets the next record. Releases the previous one, whose view becomes invalid.
    [[nodiscard]] Found next(RingRecord& out) noexcept {
        release();
        for (int attempt = 0; attempt < max_attempts; ++attempt) {
            if (position_ == tail_ && !load_tail()) return Found::empty;
            if (lossless_ && !has_hold()) {
                if (!hold()) {
                    if (!skip_ahead()) return Found::damaged;
                    continue;
                }
            }
            const Header header = load_header(ring_, position_);
            const std::uint64_t available = tail_ - position_;
            const std::uint64_t size = available > ring_.capacity ? 0 : size_of(ring_, position_, header, available);
            const bool is_record = size != 0 && !header.is_padding();
            if (is_record && !lossless_) copy_payload(static_cast<std::size_t>(header.state.length));
            if (overtaken()) {
                if (!lossless_ && !skip_ahead()) return Found::damaged;
                continue;
            }
            if (size == 0) return Found::damaged;
            after_ = position_ + size;
            if (!is_record) {
                position_ = after_;
                continue;
            }
            if (header.sequence != static_cast<std::uint32_t>(sequence_)) return Found::damaged;
            in_hand_ = true;
            out = in_place(header, position_, sequence_);
            if (!lossless_) out.data = {reinterpret_cast<const std::uint8_t*>(copy_.data()), out.data.size()};
            out.missed = std::exchange(missed_now_, 0);
            return Found::record;
        }
        return Found::damaged;
    }

    // For lossless readers. Passes up to `most` records (at least 1), but at most about 1/8 of the ring, to `visit`.
    // The records are contiguous in memory, and all stay in view until the next call. Returns `record`, or the reason
    // why there is none. After the first record, it stops at anything that is not a plain valid record; the next call
    // of next() handles that.
    template <class Visit>
    [[nodiscard]] Found visit(std::size_t most, Visit&& visit) noexcept {
        assert(lossless_ && most != 0);
        RingRecord record;
        const Found found = next(record);
        if (found != Found::record) return found;
        // Local copies: the compiler must assume that `visit` could change members.
        std::uint64_t position = position_, after = after_, sequence = sequence_;
        const std::uint64_t end = std::min(
            {tail_, position + ring_.left_in_lap(position), position + ring_.capacity / 8});
        visit(std::as_const(record));
        while (--most != 0 && after < end) {
            Header header;
            const std::uint64_t size = load_record(ring_, after, end, header);
            if (size == 0 || header.sequence != static_cast<std::uint32_t>(sequence + 1) || !has_hold()) break;
            position = std::exchange(after, after + size);
            visit(in_place(header, position, ++sequence));
        }
        position_ = position;
        after_ = after;
        sequence_ = sequence;
        return found;
    }

    // Ends the view of the last record. Reports the new position to the writer now or later, at the latest when
    // everything is read.
    void release() noexcept {
        if (!in_hand_) return;
        assert(after_ > position_ && after_ <= tail_);
        in_hand_ = false;
        position_ = after_;
        ++sequence_;
        if (position_ - published_ >= ring_.capacity / publish_parts) publish();
    }

    // Reports the position to the writer now.
    void publish() noexcept {
        if (!slot_) return;
        auto& slot = ring_.slots[*slot_];
        published_ = position_;
        slot.sequence.store(sequence_, std::memory_order_relaxed);
        slot.missed.store(missed_, std::memory_order_relaxed);
        // Sequentially consistent with Producer::sleep_for_room(). Also the release for the acquire in
        // Producer::for_each_holder().
        slot.position.store(position_, std::memory_order_seq_cst);
        auto& control = *ring_.control;
        if (!lossless_ || control.room_wanted.load(std::memory_order_seq_cst) == 0) return;
        control.room_wanted.store(0, std::memory_order_relaxed);
        control.rooms.fetch_add(1, std::memory_order_release);
        Words::wake(control.rooms);
    }

    // Sleeps until a commit, until the writer closes, or until `longest` is over. A reader without a slot may sleep for
    // all of `longest`, because the writer does not know about it.
    //
    // The first sleep after a record is a nap of at most `wake_interval`, without asking the writer for a wake-up.
    // While records arrive continuously, the writer therefore neither reads the clock nor makes a system call.
    //
    // The second sleep sets this reader's bit in `sleepers`, but is just as short, because the writer may overlook a
    // bit that was just set:
    // - commit() reads `sleepers` before its store of `tail` is visible to others.
    // - Producer::wake_readers() does nothing if it already ran within `wake_interval`.
    //
    // The bit stays set until awake().
    void sleep(Nanoseconds longest) noexcept {
        auto& control = *ring_.control;
        const std::uint32_t seen = control.wakes.load(
            std::memory_order_acquire);  // pairs with Producer::wake_readers_now()
        if (slot_ && rest_ != Rest::nap && !fall_asleep()) rest_ = Rest::asked;
        const bool is_short = slot_ && rest_ != Rest::known;
        if (is_short) longest = std::min(longest, wake_interval);
        if (!more_waits() && Words::sleep(control.wakes, seen, longest) && is_short)
            rest_ = rest_ == Rest::nap ? Rest::asked : Rest::known;
    }

    // Sets this reader's bit in `sleepers`, for a caller that sleeps on `wakes` by other means. The bit stays set until
    // awake(). Returns whether it was already set.
    [[nodiscard]] bool fall_asleep() noexcept {
        asleep_ = true;
        return (ring_.control->sleepers.fetch_or(bit(), std::memory_order_seq_cst) & bit()) != 0;
    }
    // Returns whether there is something that next() has not looked at. Call it after fall_asleep(): later commits then
    // see the bit, except perhaps during the first `wake_interval` (see sleep()).
    [[nodiscard]] bool more_waits() const noexcept {
        return ring_.control->tail.load(std::memory_order_seq_cst) != tail_ || retired();
    }

    // Call after the last sleep() of a wait. The writer then no longer needs to wake this reader.
    void awake() noexcept {
        rest_ = Rest::nap;
        if (std::exchange(asleep_, false)) ring_.control->sleepers.fetch_and(~bit(), std::memory_order_relaxed);
    }

    // Returns whether the bytes read from the current view are valid. False once an evicting writer has removed this
    // reader's hold.
    [[nodiscard]] bool holds() const noexcept {
        // A read-modify-write, because its release keeps the caller's earlier plain loads before it. On ARM, a plain
        // load could overtake them.
        return (ring_.control->holders.fetch_or(0, std::memory_order_acq_rel) & bit()) != 0;
    }

    [[nodiscard]] bool retired() const noexcept { return ring_.control->retired.load(std::memory_order_acquire) != 0; }
    // Returns whether all committed records are read.
    [[nodiscard]] bool drained() const noexcept {
        return (in_hand_ ? after_ : position_) == ring_.control->tail.load(std::memory_order_acquire);
    }
    [[nodiscard]] std::uint64_t position() const noexcept { return position_; }
    [[nodiscard]] std::uint64_t sequence() const noexcept { return sequence_; }
    [[nodiscard]] std::uint64_t missed() const noexcept { return missed_; }
    [[nodiscard]] bool lossless() const noexcept { return lossless_; }

private:
    enum class Rest : std::uint8_t {
        nap,    // no wake-up requested
        asked,  // the bit is set, but the writer may overlook it
        known,  // the writer sees the bit: it has been set for `wake_interval`
    };
    // No writer overtakes a reader this many times in a row, so failing this often means damage.
    static constexpr int max_attempts = 10'000;
    static constexpr std::uint64_t publish_parts = 16;

    [[nodiscard]] std::uint64_t bit() const noexcept {
        assert(slot_.has_value());
        return std::uint64_t{1} << *slot_;
    }

    void go_to(Mark mark) noexcept {
        assert(mark.position % record_alignment == 0);
        position_ = after_ = mark.position;
        sequence_ = mark.sequence;
        tail_ = position_;
        in_hand_ = false;
    }

    [[nodiscard]] bool load_tail() noexcept {
        tail_ = ring_.control->tail.load(std::memory_order_acquire);  // pairs with Producer::commit()
        if (tail_ != position_) return true;
        if (published_ != position_) publish();
        return false;
    }

    // Sequentially consistent with Producer::extend(): either the writer sees this hold, or this reader sees its
    // announcement.
    [[nodiscard]] bool hold() noexcept {
        auto& control = *ring_.control;
        publish();
        control.holders.fetch_or(bit(), std::memory_order_seq_cst);
        if (control.intent.load(std::memory_order_seq_cst) <= position_ + ring_.capacity) return true;
        control.holders.fetch_and(~bit(), std::memory_order_release);
        return false;
    }

    // An acquire load is enough, because the caller's earlier loads acquire too. It pairs with Producer::drop_holds().
    // A reader that sees bytes of a later lap therefore also sees that its bit is gone.
    [[nodiscard]] bool has_hold() const noexcept {
        return (ring_.control->holders.load(std::memory_order_acquire) & bit()) != 0;
    }

    // Call after all reads of the record. Those loads acquire, so this load cannot move before them.
    [[nodiscard]] bool overtaken() const noexcept {
        if (lossless_) return !has_hold();
        return ring_.control->intent.load(std::memory_order_acquire) > position_ + ring_.capacity;
    }

    // Handles being lapped. Continues at a mark at least 1/4 of the ring away from being overwritten, so as not to be
    // lapped again at once.
    [[nodiscard]] bool skip_ahead() noexcept {
        const auto mark = find_mark(ring_, ring_.capacity / 4);
        if (!mark) return true;  // overtaken again, or damaged; next() limits the attempts
        if (mark->position < position_ || mark->sequence < sequence_) return false;
        missed_now_ += mark->sequence - sequence_;
        missed_ += mark->sequence - sequence_;
        go_to(*mark);
        return true;
    }

    void copy_payload(std::size_t length) noexcept {
        const auto* word = ring_.word(position_) + record_header_bytes / sizeof(std::uint64_t);
        const std::size_t words = (length + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t);
        assert(words <= copy_.size());
        // Acquire: pairs with the release store of the same word in Producer::store_payload().
        for (std::size_t i = 0; i < words; ++i) copy_[i] = word[i].load(std::memory_order_acquire);
    }

    [[nodiscard]] RingRecord in_place(const Header& header, std::uint64_t position,
                                      std::uint64_t sequence) const noexcept {
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(ring_.word(position)) + record_header_bytes;
        return {{bytes, static_cast<std::size_t>(header.state.length)},
                {WallTime{Nanoseconds{header.time_ns}}, LinkId{header.link}, header.state.kind, header.state.verdict},
                position,
                sequence,
                0};
    }

    RingMemory<Words> ring_;
    std::optional<unsigned> slot_;
    bool lossless_ = false;
    bool asleep_ = false;  // its bit in `sleepers` may be set
    Rest rest_ = Rest::nap;
    bool in_hand_ = false;         // the record at position_ was returned to the caller
    std::uint64_t position_ = 0;   // of the record in hand, or of the next one
    std::uint64_t after_ = 0;      // end of the record in hand
    std::uint64_t sequence_ = 0;   // of the record at position_
    std::uint64_t tail_ = 0;       // the ring's tail, as last read
    std::uint64_t published_ = 0;  // the position_ that the writer knows
    std::uint64_t missed_ = 0;
    std::uint64_t missed_now_ = 0;     // since the last record that was returned
    std::vector<std::uint64_t> copy_;  // of the record in hand, for lossy readers
};

}  // namespace mavloom::shm::detail
