// SPDX-License-Identifier: MIT
// A reader's side of the algorithm, over memory that is there already: slots, locks and liveness are RingReader's. One thread; allocates at
// construction.
//
// A lossy reader copies a record and then looks whether the writer may have begun to overwrite it (`intent`): if so, the copy is thrown away, and the
// reader goes on at a mark, which says how many records lie before it. A lossless one keeps its bit in `holders` set while it looks at a record in
// place; the writer clears that bit before it overwrites anything that is held.
#pragma once

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
    // `slot`: of this reader, already its own; none: it leaves no trace in the ring (a mapping that is only readable). Lossless readers need one.
    Consumer(const RingMemory<Words>& ring, std::optional<unsigned> slot, bool lossless)
        : ring_(ring),
          slot_(slot),
          lossless_(lossless),
          copy_(lossless ? 0 : max_payload(ring.capacity) / sizeof(std::uint64_t) + 1) {}

    enum class Start : std::uint8_t { newest, oldest };
    // To the next record that will be written, or to the oldest one that is there. False: the ring is damaged. A lossless reader holds from here on.
    [[nodiscard]] bool start(Start where) noexcept {
        for (int attempt = 0; attempt < most_attempts; ++attempt) {
            const std::uint64_t intent = ring_.control->intent.load(std::memory_order_acquire);
            const std::uint64_t tail = ring_.control->tail.load(std::memory_order_acquire);  // pairs with commit()
            auto at = where == Start::oldest ? find_mark(ring_, 0) : newest_mark(ring_);
            if (at && where == Start::newest) at = walk(ring_, *at, tail);
            if (!at) {  // overtaken, or damaged: the latter where the writer did not move on, or after so many attempts
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
    // The next record. Releases the one before, whose view ends.
    [[nodiscard]] Found next(RingRecord& out) noexcept {
        release();
        for (int attempt = 0; attempt < most_attempts; ++attempt) {
            if (position_ == tail_ && !look_for_more()) return Found::empty;
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

    // Of a lossless reader: gives up to `most` records (at least one is wanted) and about an eighth of the ring to `visit`, in one piece of memory
    // and all in view until the next call. `record` unless there is none to give. What follows the first is given as far as it is plain to see:
    // next() tells what else stands there.
    template <class Visit>
    [[nodiscard]] Found visit(std::size_t most, Visit&& visit) noexcept {
        RingRecord record;
        const Found found = next(record);
        if (found != Found::record) return found;
        // Local, for `visit` could change a member, for all that the compiler knows.
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

    // Ends the view of the last record. The writer may learn of it later, at the latest when all is read.
    void release() noexcept {
        if (!in_hand_) return;
        in_hand_ = false;
        position_ = after_;
        ++sequence_;
        if (position_ - published_ >= ring_.capacity / publish_parts) publish();
    }

    // Tells the writer at once.
    void publish() noexcept {
        if (!slot_) return;
        auto& slot = ring_.slots[*slot_];
        published_ = position_;
        slot.sequence.store(sequence_, std::memory_order_relaxed);
        slot.missed.store(missed_, std::memory_order_relaxed);
        // Sequentially consistent with Producer::sleep_for_room(), and a release for the acquire in Producer::for_each_holder().
        slot.position.store(position_, std::memory_order_seq_cst);
        auto& control = *ring_.control;
        if (!lossless_ || control.room_wanted.load(std::memory_order_seq_cst) == 0) return;
        control.room_wanted.store(0, std::memory_order_relaxed);
        control.rooms.fetch_add(1, std::memory_order_release);
        Words::wake(control.rooms);
    }

    // Sleeps until something is committed, the writer goes, or `longest` is over; a reader without a slot for all of it.
    //
    // The first sleep behind a record is a nap of `wake_distance` at most that the writer is not asked to end: while records come thick, he neither looks
    // at the clock nor makes a system call. He may overlook a bit that was just set (commit() looks at `sleepers` before others see its `tail`,
    // Producer::wake_readers() wakes nobody twice in a while), so that the second is short, too. The bit stays set until awake().
    void sleep(Nanoseconds longest) noexcept {
        auto& control = *ring_.control;
        const std::uint32_t seen = control.wakes.load(
            std::memory_order_acquire);  // pairs with Producer::wake_readers_now()
        if (slot_ && rest_ != Rest::nap && !fall_asleep()) rest_ = Rest::asked;
        const bool is_short = slot_ && rest_ != Rest::known;
        if (is_short) longest = std::min(longest, wake_distance);
        if (!more_waits() && Words::sleep(control.wakes, seen, longest) && is_short)
            rest_ = rest_ == Rest::nap ? Rest::asked : Rest::known;
    }

    // For a sleep elsewhere on `wakes`, until awake(): sets this reader's bit. Whether it was set before.
    [[nodiscard]] bool fall_asleep() noexcept {
        asleep_ = true;
        return (ring_.control->sleepers.fetch_or(bit(), std::memory_order_seq_cst) & bit()) != 0;
    }
    // Whether something waits that next() has not looked at. Behind fall_asleep(): a later commit sees the bit, but for one that the writer makes within
    // `wake_distance` (see sleep()).
    [[nodiscard]] bool more_waits() const noexcept {
        return ring_.control->tail.load(std::memory_order_seq_cst) != tail_ || retired();
    }

    // After the last sleep() of a wait: the writer need not wake this reader.
    void awake() noexcept {
        rest_ = Rest::nap;
        if (std::exchange(asleep_, false)) ring_.control->sleepers.fetch_and(~bit(), std::memory_order_relaxed);
    }

    // Whether what was read of the view of the last record is what was written: false once a writer that evicts has taken this reader's hold.
    [[nodiscard]] bool holds() const noexcept {
        // A read-modify-write, whose release keeps the caller's plain loads before it: a load could be ahead of them, on ARM.
        return (ring_.control->holders.fetch_or(0, std::memory_order_acq_rel) & bit()) != 0;
    }

    [[nodiscard]] bool retired() const noexcept { return ring_.control->retired.load(std::memory_order_acquire) != 0; }
    // Whether all that was committed is read.
    [[nodiscard]] bool drained() const noexcept {
        return (in_hand_ ? after_ : position_) == ring_.control->tail.load(std::memory_order_acquire);
    }
    [[nodiscard]] std::uint64_t position() const noexcept { return position_; }
    [[nodiscard]] std::uint64_t sequence() const noexcept { return sequence_; }
    [[nodiscard]] std::uint64_t missed() const noexcept { return missed_; }
    [[nodiscard]] bool lossless() const noexcept { return lossless_; }

private:
    enum class Rest : std::uint8_t {
        nap,    // unasked
        asked,  // the bit is set, and may be overlooked
        known,  // the writer sees it: has been set for `wake_distance`
    };
    static constexpr int most_attempts = 10'000;  // a writer is not faster so many times running; damage is
    static constexpr std::uint64_t publish_parts = 16;

    [[nodiscard]] std::uint64_t bit() const noexcept { return std::uint64_t{1} << *slot_; }

    void go_to(Mark mark) noexcept {
        position_ = after_ = mark.position;
        sequence_ = mark.sequence;
        tail_ = position_;
        in_hand_ = false;
    }

    [[nodiscard]] bool look_for_more() noexcept {
        tail_ = ring_.control->tail.load(std::memory_order_acquire);  // pairs with Producer::commit()
        if (tail_ != position_) return true;
        if (published_ != position_) publish();
        return false;
    }

    // Sequentially consistent with Producer::extend(): either the writer sees this hold, or its announcement is seen here.
    [[nodiscard]] bool hold() noexcept {
        auto& control = *ring_.control;
        publish();
        control.holders.fetch_or(bit(), std::memory_order_seq_cst);
        if (control.intent.load(std::memory_order_seq_cst) <= position_ + ring_.capacity) return true;
        control.holders.fetch_and(~bit(), std::memory_order_release);
        return false;
    }

    // Enough behind loads that acquire. Acquire: pairs with Producer::drop_holds(). Bytes of a later lap are seen only by who sees the bit gone.
    [[nodiscard]] bool has_hold() const noexcept {
        return (ring_.control->holders.load(std::memory_order_acquire) & bit()) != 0;
    }

    // After all that was read of the record: its loads acquired, so that this one is not ahead of them.
    [[nodiscard]] bool overtaken() const noexcept {
        if (lossless_) return !has_hold();
        return ring_.control->intent.load(std::memory_order_acquire) > position_ + ring_.capacity;
    }

    // Lapped. Goes on a quarter of the ring before the writer, so as not to be lapped at once again.
    [[nodiscard]] bool skip_ahead() noexcept {
        const auto mark = find_mark(ring_, ring_.capacity / 4);
        if (!mark) return true;  // overtaken meanwhile, or damaged: next() tries so many times
        if (mark->position < position_ || mark->sequence < sequence_) return false;
        missed_now_ += mark->sequence - sequence_;
        missed_ += mark->sequence - sequence_;
        go_to(*mark);
        return true;
    }

    void copy_payload(std::size_t length) noexcept {
        const auto* word = ring_.word(position_) + record_header_bytes / sizeof(std::uint64_t);
        const std::size_t words = (length + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t);
        // Acquire: pairs with the release of the same word in Producer::store_payload().
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
    bool in_hand_ = false;         // the record at position_ was given out
    std::uint64_t position_ = 0;   // of the record in hand, or of the next
    std::uint64_t after_ = 0;      // behind the record in hand
    std::uint64_t sequence_ = 0;   // of the record at position_
    std::uint64_t tail_ = 0;       // of the ring, as last seen
    std::uint64_t published_ = 0;  // position_ as the writer knows it
    std::uint64_t missed_ = 0;
    std::uint64_t missed_now_ = 0;     // since the last record that was given out
    std::vector<std::uint64_t> copy_;  // of the record in hand, where it is not held in place
};

}  // namespace mavloom::shm::detail
