// SPDX-License-Identifier: MIT
// The binary layout of a ring, as specified in docs/formats/ring.md.
//
// Every field that another process may change is an atomic word. The template parameter `Words` supplies the word
// types, so that tests can substitute their own. Nothing here allocates or blocks.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>

#include "mavloom/shm/detail/words.hpp"

namespace mavloom::shm {

static_assert(std::endian::native == std::endian::little, "the format counts little-endian");

inline constexpr std::array<char, 8> ring_magic{'M', 'V', 'L', 'R', 'I', 'N', 'G', '\0'};
inline constexpr std::uint16_t ring_major = 1;  // rings of another major version are rejected
inline constexpr std::uint16_t ring_minor = 0;  // a higher minor version only uses reserved fields
inline constexpr std::uint32_t byte_order_mark = 0x01020304;

inline constexpr std::size_t reader_slots = 64;  // one bit each in 64-bit words
inline constexpr std::size_t mark_count = 64;
inline constexpr std::size_t slots_offset = 4096;
inline constexpr std::size_t data_offset = 16384;
inline constexpr std::size_t record_header_bytes = 24;
inline constexpr std::size_t record_alignment = 8;

inline constexpr std::uint64_t min_capacity = 64 << 10;
inline constexpr std::uint64_t max_capacity = std::uint64_t{1} << 36;
inline constexpr std::uint64_t default_capacity = 8 << 20;
inline constexpr std::size_t max_record_bytes = 64 << 10;

// The longest payload that a ring accepts, in bytes. The limit ensures that a record, the padding before it, and the
// range announced for overwriting fit into the ring together.
[[nodiscard]] constexpr std::size_t max_payload(std::uint64_t capacity) noexcept {
    return static_cast<std::size_t>(std::min<std::uint64_t>(max_record_bytes, capacity / 4 - record_header_bytes));
}
// Bytes that a record with a payload of `length` bytes occupies in the ring.
[[nodiscard]] constexpr std::uint64_t record_size(std::uint64_t length) noexcept {
    return (record_header_bytes + length + record_alignment - 1) & ~std::uint64_t{record_alignment - 1};
}

// Written before the ring gets its name, and never changed.
struct Identity {
    std::array<char, 8> magic = ring_magic;
    std::uint16_t major = ring_major;
    std::uint16_t minor = ring_minor;
    std::uint32_t byte_order = byte_order_mark;
    std::uint64_t capacity = default_capacity;  // size of the record area in bytes, a power of two
    std::uint32_t data_begin = data_offset;     // offset of the record area in bytes
    std::uint32_t slots = reader_slots;
    std::int64_t created_ns = 0;  // Unix time
    std::uint32_t creator_pid = 0;
    std::uint32_t reserved = 0;
    std::array<std::uint64_t, 2> reserved_too{};
};
static_assert(sizeof(Identity) == 64);
static_assert(offsetof(Identity, magic) == 0 && offsetof(Identity, major) == 8 && offsetof(Identity, minor) == 10 &&
              offsetof(Identity, byte_order) == 12 && offsetof(Identity, capacity) == 16 &&
              offsetof(Identity, data_begin) == 24 && offsetof(Identity, slots) == 28 &&
              offsetof(Identity, created_ns) == 32 && offsetof(Identity, creator_pid) == 40);

// Where a record begins, and how many records were written before it.
template <class Words>
struct MarkWords {
    typename Words::Word64 position;
    typename Words::Word64 sequence;
};
static_assert(sizeof(MarkWords<SharedWords>) == 16);

// Words that change together share 128 bytes, because processors fetch cache lines in pairs. All others are kept apart.
template <class Words>
struct RingControl {
    Identity identity;
    // About the writer, for display.
    typename Words::Word32 writer_pid;        // 0 after a clean close
    typename Words::Word32 when_full;         // WhenFull
    typename Words::Word64 writer_opened_ns;  // Unix time
    typename Words::Word64 writers;           // number of writers so far, including the current one
    typename Words::Word64 dropped;           // records that were not written because the ring was full
    typename Words::Word64 evictions;         // holds that the writer removed (evict, dead readers)
    std::array<std::uint64_t, 3> reserved_1;
    // Stored at each commit.
    alignas(128) typename Words::Word64 tail;  // end of the committed records; only increases
    typename Words::Word64 records;            // number of committed records
    // Stored once per 1/64 of the capacity, and when readers come and go.
    alignas(128) typename Words::Word64 intent;  // everything more than `capacity` bytes before this may be overwritten
    typename Words::Word64 holders;              // slots whose position the writer may not pass
    typename Words::Word64 attached;             // slots in use, or left behind by a killed reader
    // Read at each commit. Stored by readers that go to sleep, and when the ring is removed.
    alignas(128) typename Words::Word64 sleepers;  // slots of sleeping readers
    typename Words::Word32 wakes;                  // futex that readers sleep on; counts wake-ups
    typename Words::Word32 retired;                // not 0: the ring was removed or replaced by another file
    // Used by the writer to sleep while the ring is full.
    alignas(128) typename Words::Word32 room_wanted;  // not 0 while the writer sleeps
    typename Words::Word32 rooms;                     // futex that the writer sleeps on; counts wake-ups
    std::array<std::uint64_t, 63> reserved_2;
    std::array<MarkWords<Words>, mark_count> marks;  // one for each 1/64 of the capacity
};
static_assert(offsetof(RingControl<SharedWords>, writer_pid) == 64 &&
              offsetof(RingControl<SharedWords>, when_full) == 68 &&
              offsetof(RingControl<SharedWords>, writer_opened_ns) == 72 &&
              offsetof(RingControl<SharedWords>, writers) == 80 && offsetof(RingControl<SharedWords>, dropped) == 88 &&
              offsetof(RingControl<SharedWords>, evictions) == 96);
static_assert(offsetof(RingControl<SharedWords>, tail) == 128 && offsetof(RingControl<SharedWords>, records) == 136);
static_assert(offsetof(RingControl<SharedWords>, intent) == 256 && offsetof(RingControl<SharedWords>, holders) == 264 &&
              offsetof(RingControl<SharedWords>, attached) == 272);
static_assert(offsetof(RingControl<SharedWords>, sleepers) == 384 && offsetof(RingControl<SharedWords>, wakes) == 392 &&
              offsetof(RingControl<SharedWords>, retired) == 396);
static_assert(offsetof(RingControl<SharedWords>, room_wanted) == 512 && offsetof(RingControl<SharedWords>, rooms) == 516);
static_assert(offsetof(RingControl<SharedWords>, marks) == 1024 && sizeof(RingControl<SharedWords>) == 2048);

// One registered reader. The reader that holds the lock on the slot's byte owns the slot.
template <class Words>
struct alignas(128) ReaderSlot {
    typename Words::Word64 position;  // the reader needs nothing before it
    typename Words::Word64 sequence;  // sequence number of the record at `position`
    typename Words::Word64 missed;    // records that this reader missed because the writer lapped it
    std::array<std::uint64_t, 5> reserved_1;
    typename Words::Word32 pid;                     // for display
    typename Words::Word32 lossless;                // 0 or 1
    typename Words::Word64 opened_ns;               // Unix time
    std::array<typename Words::Word64, 2> program;  // first 16 bytes of the program's name, padded with NULs
    std::array<std::uint64_t, 4> reserved_2;
};
static_assert(sizeof(ReaderSlot<SharedWords>) == 128);
static_assert(offsetof(ReaderSlot<SharedWords>, position) == 0 && offsetof(ReaderSlot<SharedWords>, sequence) == 8 &&
              offsetof(ReaderSlot<SharedWords>, missed) == 16 && offsetof(ReaderSlot<SharedWords>, pid) == 64 &&
              offsetof(ReaderSlot<SharedWords>, lossless) == 68 && offsetof(ReaderSlot<SharedWords>, opened_ns) == 72 &&
              offsetof(ReaderSlot<SharedWords>, program) == 80);
static_assert(slots_offset + reader_slots * sizeof(ReaderSlot<SharedWords>) <= data_offset);

// The first word of a record. Offsets: length at byte 0, kind at 4, verdict at 6, flags at 7.
struct RecordState {
    // Length of the payload. -1 - length until the record is committed. In a padding record, the size of the whole
    // record.
    std::int32_t length = 0;
    std::uint16_t kind = 0;
    std::uint8_t verdict = 0;
    std::uint8_t flags = 0;
};
static_assert(sizeof(RecordState) == 8 && offsetof(RecordState, length) == 0 && offsetof(RecordState, kind) == 4 &&
              offsetof(RecordState, verdict) == 6 && offsetof(RecordState, flags) == 7);
inline constexpr std::uint8_t padding_flag = 1;

[[nodiscard]] constexpr std::uint64_t pack(RecordState state) noexcept { return std::bit_cast<std::uint64_t>(state); }
[[nodiscard]] constexpr RecordState unpack(std::uint64_t word) noexcept { return std::bit_cast<RecordState>(word); }

// Pointers into a mapped ring. Does not own the memory.
template <class Words>
struct RingMemory {
    RingControl<Words>* control = nullptr;
    ReaderSlot<Words>* slots = nullptr;
    typename Words::Word64* data = nullptr;
    std::uint64_t capacity = 0;

    [[nodiscard]] typename Words::Word64* word(std::uint64_t position) const noexcept {
        assert(position % record_alignment == 0);
        return data + (position & (capacity - 1)) / sizeof(std::uint64_t);
    }
    [[nodiscard]] std::uint64_t mark_distance() const noexcept { return capacity / mark_count; }
    // Bytes from `position` to the end of the current lap.
    [[nodiscard]] std::uint64_t left_in_lap(std::uint64_t position) const noexcept {
        return capacity - (position & (capacity - 1));
    }
};

}  // namespace mavloom::shm
