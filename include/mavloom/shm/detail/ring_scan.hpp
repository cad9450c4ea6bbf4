// SPDX-License-Identifier: MIT
// Functions that readers and writers use to scan a ring: load record headers, find marks, count records.
//
// Another process wrote the data, so nothing that is read is trusted until it has been checked. Any thread; allocates
// nothing.
#pragma once

#include <cassert>
#include <optional>

#include "mavloom/shm/layout.hpp"

namespace mavloom::shm::detail {

// Minimum time between two wake-ups of the readers by the writer.
inline constexpr Nanoseconds wake_interval = std::chrono::milliseconds(1);

struct Header {
    RecordState state;
    std::uint32_t link = 0;
    std::uint32_t sequence = 0;  // only the low 32 bits
    std::int64_t time_ns = 0;

    [[nodiscard]] bool is_padding() const noexcept { return state.flags == padding_flag; }
};

// Each load acquires and pairs with the release store of the same word in Producer::store_header(). So a reader that
// sees a word of a later lap also sees the `intent` announced before it.
template <class Word>
void load_tags(const Word* word, Header& header) noexcept {
    const std::uint64_t tags = word[1].load(std::memory_order_acquire);
    header.link = static_cast<std::uint32_t>(tags);
    header.sequence = static_cast<std::uint32_t>(tags >> 32);
    header.time_ns = static_cast<std::int64_t>(word[2].load(std::memory_order_acquire));
}

template <class Words>
[[nodiscard]] Header load_header(const RingMemory<Words>& ring, std::uint64_t position) noexcept {
    const auto* word = ring.word(position);
    Header header;
    header.state = unpack(word[0].load(std::memory_order_acquire));
    if (header.is_padding()) return header;  // the first word may be all that is left of the lap
    if (ring.left_in_lap(position) < record_header_bytes) return header;
    load_tags(word, header);
    return header;
}

// Returns the distance to the next record, or 0 if there is no valid record here. `available`: bytes from `position` to
// the tail.
template <class Words>
[[nodiscard]] std::uint64_t size_of(const RingMemory<Words>& ring, std::uint64_t position, const Header& header,
                                    std::uint64_t available) noexcept {
    const std::uint64_t left = ring.left_in_lap(position);
    const std::int32_t length = header.state.length;
    if (length < 0 || header.state.flags > padding_flag) return 0;
    if (header.is_padding()) return static_cast<std::uint64_t>(length) == left && left <= available ? left : 0;
    if (static_cast<std::size_t>(length) > max_payload(ring.capacity)) return 0;
    const std::uint64_t size = record_size(static_cast<std::uint64_t>(length));
    return size <= left && size <= available ? size : 0;
}

// Loads the header of a record that ends at `end` or before, and returns the record's size. Returns 0 for anything
// else. `end` must be in the same lap, at most 1/8 of the ring ahead.
template <class Words>
[[nodiscard, gnu::always_inline]] inline std::uint64_t load_record(const RingMemory<Words>& ring, std::uint64_t position,
                                                                   std::uint64_t end, Header& header) noexcept {
    assert(position < end && end - position <= ring.left_in_lap(position));
    const auto* word = ring.word(position);
    header.state = unpack(word[0].load(std::memory_order_acquire));
    const auto length = static_cast<std::uint32_t>(header.state.length);
    if (header.state.flags != 0 || length > max_record_bytes) return 0;
    const std::uint64_t size = record_size(length);
    if (size > end - position) return 0;
    load_tags(word, header);
    return size;
}

struct Mark {
    std::uint64_t position = 0;
    std::uint64_t sequence = 0;
};

// Loads mark `number`: the first record that begins at or after position number * capacity / 64. Returns nothing if the
// writer has overtaken the mark.
template <class Words>
[[nodiscard]] std::optional<Mark> load_mark(const RingMemory<Words>& ring, std::uint64_t number,
                                            std::uint64_t tail) noexcept {
    const auto& words = ring.control->marks[number % mark_count];
    // Both acquire and pair with the release stores in Producer::set_marks().
    const Mark mark{words.position.load(std::memory_order_acquire), words.sequence.load(std::memory_order_acquire)};
    const std::uint64_t begin = number * ring.mark_distance();
    // Before the writer replaces a mark, it raises `intent` to at least the start of the replacement, which lies one
    // lap later.
    const std::uint64_t intent = ring.control->intent.load(std::memory_order_acquire);
    if (intent >= begin + ring.capacity || mark.position < begin || mark.position > tail) return std::nullopt;
    if (mark.position % record_alignment != 0) return std::nullopt;
    return mark;
}

// Returns the oldest mark that is at least `margin` bytes away from being overwritten. Returns the newest mark if none
// is that far away.
template <class Words>
[[nodiscard]] std::optional<Mark> find_mark(const RingMemory<Words>& ring, std::uint64_t margin) noexcept {
    const std::uint64_t tail = ring.control->tail.load(std::memory_order_acquire);  // pairs with Producer::commit()
    const std::uint64_t edge = ring.control->intent.load(std::memory_order_acquire) + margin;
    const std::uint64_t newest = tail / ring.mark_distance();
    const std::uint64_t oldest = edge < ring.capacity ? 0 : (edge - ring.capacity) / ring.mark_distance() + 1;
    for (std::uint64_t number = std::min(oldest, newest); number <= newest && number + mark_count > newest; ++number)
        if (const auto mark = load_mark(ring, number, tail)) return mark;
    return std::nullopt;
}

// Returns the newest mark. For a reader, the result is empty if the writer has overtaken that mark.
template <class Words>
[[nodiscard]] std::optional<Mark> newest_mark(const RingMemory<Words>& ring) noexcept {
    const std::uint64_t tail = ring.control->tail.load(std::memory_order_acquire);  // pairs with Producer::commit()
    return load_mark(ring, tail / ring.mark_distance(), tail);
}

// Walks from record to record up to `tail`. Returns nothing if it meets an invalid record or the writer overtakes it.
template <class Words>
[[nodiscard]] std::optional<Mark> walk(const RingMemory<Words>& ring, Mark at, std::uint64_t tail) noexcept {
    while (at.position < tail) {
        const Header header = load_header(ring, at.position);
        const std::uint64_t size = size_of(ring, at.position, header, tail - at.position);
        if (size == 0 || ring.control->intent.load(std::memory_order_acquire) > at.position + ring.capacity)
            return std::nullopt;
        if (!header.is_padding() && header.sequence != static_cast<std::uint32_t>(at.sequence++)) return std::nullopt;
        at.position += size;
    }
    return at;
}

}  // namespace mavloom::shm::detail
