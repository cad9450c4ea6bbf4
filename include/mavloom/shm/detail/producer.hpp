// SPDX-License-Identifier: MIT
// The writer's side of the ring algorithm, over memory that is already mapped. RingWriter handles locks, policies and
// waiting. One thread; allocates nothing. docs/design/ring.md explains the algorithm, and docs/formats/ring.md its
// terms.
//
//   claim   announces what will be overwritten (`intent`), checks that no reader holds it (`holders`), and marks the
//           record as being written
//   commit  stores the length, the marks and `tail`, then wakes sleeping readers
//
// A writer that is killed at any point leaves `tail` unchanged. Every record before `tail` is complete; anything after
// it is ignored.
#pragma once

#include <bit>
#include <cassert>
#include <cstring>
#include <limits>

#include "mavloom/base/bytes.hpp"
#include "mavloom/shm/detail/ring_scan.hpp"
#include "mavloom/shm/record.hpp"

namespace mavloom::shm::detail {

template <class Words>
class Producer {
public:
    Producer() = default;
    explicit Producer(const RingMemory<Words>& ring) noexcept : ring_(ring) {}

    // Finds where the last writer stopped, whatever it was doing. Returns false if the ring is damaged. Requires that
    // no other writer is alive.
    [[nodiscard]] bool recover() noexcept {
        auto& control = *ring_.control;
        tail_ = control.tail.load(std::memory_order_acquire);  // pairs with commit() of the last writer
        intent_ = control.intent.load(std::memory_order_acquire);
        if (tail_ % record_alignment != 0 || intent_ < tail_ || intent_ - tail_ > ring_.capacity) return false;
        const auto mark = newest_mark(ring_);
        const auto end = mark ? walk(ring_, *mark, tail_) : std::nullopt;
        if (!end || end->position != tail_) return false;
        sequence_ = end->sequence;
        control.records.store(sequence_, std::memory_order_relaxed);
        next_mark_ = (tail_ / ring_.mark_distance() + 1) * ring_.mark_distance();
        limit_ = plain_ = tail_;
        return true;
    }

    enum class Room : std::uint8_t { there, held, removed };

    // Makes room for a record with `length` bytes of payload (at most max_payload()). Discards an earlier claim. On
    // success, `payload` is valid.
    [[nodiscard]] Room claim(std::size_t length) noexcept {
        assert(length <= max_payload(ring_.capacity));
        const std::uint64_t size = record_size(length);
        if (ring_.control->retired.load(std::memory_order_relaxed) != 0) return Room::removed;
        if (tail_ + size <= plain_) start_ = tail_;
        else if (!claim_farther(size)) return Room::held;
        assert(start_ + size <= limit_ && size <= ring_.left_in_lap(start_));
        claimed_ = length;
        auto* const record = record_ = ring_.word(start_);
        record->store(pack({-1 - static_cast<std::int32_t>(length), 0, 0, 0}), std::memory_order_release);
        return Room::there;
    }

    // The memory into which the caller writes the claimed payload with plain stores. A lossy reader that is lapped at
    // that moment may copy a mixture of old and new bytes. It then discards the copy (see extend()).
    [[nodiscard]] std::uint8_t* payload() const noexcept {
        assert(record_ != nullptr);
        return reinterpret_cast<std::uint8_t*>(record_ + header_words);
    }

    // Fills the payload through atomic words instead. Each store releases and pairs with the acquire in
    // Consumer::copy_payload().
    void store_payload(ByteView bytes) noexcept {
        assert(record_ != nullptr && bytes.size() <= claimed_);
        auto* word = record_ + header_words;
        const std::uint8_t* from = bytes.data();
        const std::uint8_t* const end = from + bytes.size();
        constexpr std::ptrdiff_t word_bytes = sizeof(std::uint64_t), words_at_once = 4;
        for (; end - from >= words_at_once * word_bytes; from += words_at_once * word_bytes, word += words_at_once) {
#pragma GCC unroll 4
            for (std::ptrdiff_t i = 0; i < words_at_once; ++i)
                word[i].store(load_le<std::uint64_t>(from + i * word_bytes), std::memory_order_release);
        }
        for (; end - from >= word_bytes; from += word_bytes, ++word)
            word->store(load_le<std::uint64_t>(from), std::memory_order_release);
        if (from != end) word->store(load_rest(bytes, static_cast<std::size_t>(end - from)), std::memory_order_release);
    }

    // Publishes the first `length` bytes of the claim. `length` must not exceed the claimed length.
    void commit(const RecordInfo& info, std::size_t length) noexcept {
        assert(record_ != nullptr && length <= claimed_ && start_ >= tail_);
        auto& control = *ring_.control;
        store_header(info, length);
        const std::uint64_t end = start_ + record_size(length), sequence = ++sequence_;
        if (end >= next_mark_) set_marks(end);
        assert(end <= limit_ && end < next_mark_);
        control.records.store(sequence, std::memory_order_relaxed);
        tail_ = end;
        control.tail.store(
            end, std::memory_order_release);  // pairs with the acquire loads of `tail` in Consumer and ring_scan.hpp
        if (control.sleepers.load(std::memory_order_relaxed) != 0) wake_readers();
    }

    [[nodiscard]] std::size_t claimed() const noexcept { return claimed_; }
    [[nodiscard]] std::uint64_t tail() const noexcept { return tail_; }
    [[nodiscard]] std::uint64_t records() const noexcept { return sequence_; }

    // Returns the slots whose readers block a record of `length` bytes.
    [[nodiscard]] std::uint64_t blockers(std::size_t length) const noexcept {
        const std::uint64_t size = record_size(length);
        const std::uint64_t left = ring_.left_in_lap(tail_);
        const std::uint64_t end = tail_ + (size <= left ? 0 : left) + size;
        std::uint64_t found = 0;
        for_each_holder([&](unsigned slot, std::uint64_t limit) {
            if (limit < end) found |= std::uint64_t{1} << slot;
        });
        return found;
    }

    // Removes the holds of these slots' readers. A reader notices that before it reads the next record.
    void drop_holds(std::uint64_t slots) noexcept {
        ring_.control->holders.fetch_and(~slots, std::memory_order_seq_cst);
    }

    // Sleeps until a reader releases something, or until `longest` is over.
    void sleep_for_room(std::size_t length, Nanoseconds longest) noexcept {
        auto& control = *ring_.control;
        const std::uint32_t seen = control.rooms.load(std::memory_order_acquire);
        // Sequentially consistent with Consumer::publish(): either the reader sees that room is wanted, or blockers()
        // sees the position that it released.
        control.room_wanted.store(1, std::memory_order_seq_cst);
        if (blockers(length) != 0) Words::sleep(control.rooms, seen, longest);
        control.room_wanted.store(0, std::memory_order_relaxed);
    }

    // Wakes all sleeping readers, at most once per `wake_interval`. If the last wake-up is more recent than that, does
    // nothing. A wake-up clears all bits, so a reader whose bit is set has set it after the last wake-up. It wakes by
    // itself, because its first sleep with the bit set lasts at most `wake_interval` (Consumer::sleep()). For the same
    // reason, commit() need not order its load of `sleepers` after its store of `tail`. A reader that it overlooks
    // checks again by itself.
    [[gnu::noinline]] void wake_readers() noexcept {
        const MonoTime now = Words::now();
        if (now < next_wake_) return;
        next_wake_ = now + wake_interval;
        wake_readers_now();
    }
    void wake_readers_now() noexcept {
        auto& control = *ring_.control;
        control.sleepers.store(0, std::memory_order_relaxed);
        control.wakes.fetch_add(1, std::memory_order_release);  // pairs with the acquire in Consumer::sleep()
        Words::wake(control.wakes);
    }

private:
    static constexpr std::size_t header_words = record_header_bytes / sizeof(std::uint64_t);

    // The slow path of claim(), for the end of a lap and for a record that extends beyond limit_.
    [[nodiscard, gnu::noinline]] bool claim_farther(std::uint64_t size) noexcept {
        const std::uint64_t left = ring_.left_in_lap(tail_);
        const std::uint64_t padding = size <= left ? 0 : left;
        assert(padding < size);
        const std::uint64_t end = tail_ + padding + size;
        if (end > limit_ && !extend(end)) return false;
        if (padding != 0) store_state(tail_, {static_cast<std::int32_t>(padding), 0, 0, padding_flag});
        start_ = tail_ + padding;
        plain_ = std::min(limit_, tail_ + left);
        return true;
    }

    // Loads the last `count` bytes (fewer than a word), padded with zeros.
    [[nodiscard]] static std::uint64_t load_rest(ByteView bytes, std::size_t count) noexcept {
        assert(count != 0 && count < sizeof(std::uint64_t) && count <= bytes.size());
        if (bytes.size() >= sizeof(std::uint64_t))
            return load_le<std::uint64_t>(bytes.data() + bytes.size() - sizeof(std::uint64_t)) >>
                   8 * (sizeof(std::uint64_t) - count);
        std::uint64_t word = 0;
        std::memcpy(&word, bytes.data(), count);
        return word;
    }

    void store_state(std::uint64_t position, RecordState state) noexcept {
        ring_.word(position)->store(pack(state), std::memory_order_release);  // pairs with load_header()
    }

    void store_header(const RecordInfo& info, std::size_t length) noexcept {
        auto* const record = record_;
        record[1].store(info.link.value | sequence_ << 32,
                        std::memory_order_release);  // all three pair with load_header()
        record[2].store(static_cast<std::uint64_t>(info.time.time_since_epoch().count()), std::memory_order_release);
        record[0].store(pack({static_cast<std::int32_t>(length), info.kind, info.verdict, 0}),
                        std::memory_order_release);
    }

    // The current commit spans tail_ to `end`, with padding up to start_. sequence_ already counts it.
    [[gnu::noinline]] void set_marks(std::uint64_t end) noexcept {
        for (; next_mark_ <= end; next_mark_ += ring_.mark_distance()) {
            const bool in_padding = next_mark_ <= start_;
            auto& mark = ring_.control->marks[next_mark_ / ring_.mark_distance() % mark_count];
            mark.position.store(in_padding ? start_ : end, std::memory_order_release);  // both pair with load_mark()
            mark.sequence.store(in_padding ? sequence_ - 1 : sequence_, std::memory_order_release);
        }
    }

    // Extends limit_, up to which the writer may write. Checks the readers' holds again, then announces (`intent`) up
    // to the end of the 1/64 part that contains `end`. Returns false if readers block the way.
    [[nodiscard]] bool extend(std::uint64_t end) noexcept {
        const std::uint64_t distance = ring_.mark_distance();
        std::uint64_t wanted = std::min((end + distance - 1) / distance * distance, held_limit());
        if (wanted < end) return false;
        if (wanted > intent_) {
            intent_ = wanted;
            // Sequentially consistent with Consumer::hold(): either the reader sees this intent, or held_limit() sees
            // its hold. The load of `holders` in held_limit() also keeps the plain stores of payload() behind this
            // store, on x86 and ARM alike. No processor moves a sequentially consistent load before a sequentially
            // consistent store, or a later store before that load.
            ring_.control->intent.store(intent_, std::memory_order_seq_cst);
            wanted = std::min(wanted, held_limit());
        }
        limit_ = std::max(limit_, wanted);
        assert(limit_ <= intent_ && intent_ - tail_ <= ring_.capacity);
        return wanted >= end;
    }

    [[nodiscard]] std::uint64_t held_limit() const noexcept {
        std::uint64_t limit = std::numeric_limits<std::uint64_t>::max();
        for_each_holder([&](unsigned, std::uint64_t of_slot) { limit = std::min(limit, of_slot); });
        return limit;
    }

    template <class Visit>
    void for_each_holder(Visit&& visit) const noexcept {
        std::uint64_t holders = ring_.control->holders.load(std::memory_order_seq_cst);
        for (; holders != 0; holders &= holders - 1) {
            const auto slot = static_cast<unsigned>(std::countr_zero(holders));
            // Acquire: pairs with Consumer::publish(). The reader has finished with all bytes before this position.
            const std::uint64_t position = ring_.slots[slot].position.load(std::memory_order_acquire);
            // Ignores a position that no reader can have. It is damaged, or Consumer::hold() is about to give it up.
            if (tail_ - position <= ring_.capacity) visit(slot, position + ring_.capacity);
        }
    }

    RingMemory<Words> ring_;
    std::uint64_t tail_ = 0;
    std::uint64_t limit_ = 0;  // the writer may write up to here without checking the holds
    std::uint64_t plain_ = 0;  // the same, but within the lap of tail_
    std::uint64_t next_mark_ = 0;
    std::uint64_t sequence_ = 0;
    std::uint64_t start_ = 0;                   // position of the claimed record
    typename Words::Word64* record_ = nullptr;  // its address
    std::size_t claimed_ = 0;
    std::uint64_t intent_ = 0;
    MonoTime next_wake_{};
};

}  // namespace mavloom::shm::detail
