// SPDX-License-Identifier: MIT
// A queue of whole blocks on their way out, bounded by bytes and by age. Until a bound is reached it is first in, first out, and nothing
// is lost. At the bound whole blocks go, the least important class first (the highest number): of the last class first those that a newer
// block with the same key has superseded, then the oldest; an arriving block never displaces a more important one. Key 0 is never
// superseded. A block of which a part is with the kernel already is never dropped.
//
// Blocks lie one behind the other in one piece of memory, so that many leave as one. It grows with what is queued (at most twice the bound)
// and is given back after a jam; in steady state nothing allocates. Not thread-safe. DESIGN.md rule 2; docs/guide/queues.md.
#pragma once

#include <sys/uio.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/clock.hpp"

namespace mavloom::net {

class BlockQueue {
public:
    static constexpr std::uint8_t classes = 3;

    struct Limits {
        std::size_t max_bytes = std::size_t{1} << 20;
        std::array<Nanoseconds, classes> max_age{std::chrono::seconds(10), std::chrono::seconds(10),
                                                 std::chrono::seconds(1)};
    };
    struct Pushed {
        bool queued = false;
        std::uint32_t dropped = 0;  // blocks lost by this push, the new one included when it was not queued
    };
    // A place between blocks; valid until the next push or expire.
    struct Position {
        std::size_t index = 0;
    };
    struct Gathered {
        std::size_t blocks = 0, bytes = 0, pieces = 0;
    };

    explicit BlockQueue(const Limits& limits) noexcept : limits_(limits) {}

    // `key` other than 0 only for blocks that a newer one makes worthless.
    Pushed push(ByteView block, std::uint8_t block_class, std::uint64_t key, MonoTime now);
    // Drops what is older than its class may be; returns how many.
    std::uint32_t expire(MonoTime now) noexcept;
    // Drops everything, a block begun included; returns how many.
    std::uint32_t clear() noexcept;

    [[nodiscard]] bool empty() const noexcept { return blocks_ == 0; }
    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }
    [[nodiscard]] std::size_t blocks() const noexcept { return blocks_; }

    // Datagrams: whole blocks from `from` on, together at most `max_bytes` (the first always), as few pieces as they lie in. Moves `from`
    // behind the last. No blocks: the end. What was sent is then taken off by `pop`.
    [[nodiscard]] Position front() const noexcept { return {head_}; }
    [[nodiscard]] Gathered gather(Position& from, std::size_t max_bytes, std::span<iovec> room) const noexcept;
    void pop(Position until) noexcept;

    // Streams: everything from the first unsent byte on, as far as `room` goes, and no block more than fits `max_bytes` (the first always);
    // `consume` takes off what the kernel took and returns the blocks that are thereby whole. `rewind` makes the next stream begin with the
    // whole block.
    [[nodiscard]] std::size_t pieces(std::span<iovec> room, std::size_t max_bytes = SIZE_MAX) const noexcept;
    std::size_t consume(std::size_t bytes) noexcept;
    void rewind() noexcept;

private:
    struct Entry {
        std::uint64_t key;
        MonoTime queued;
        std::uint32_t offset, size;
        std::uint8_t block_class;
        bool live;
    };
    struct Newest {
        std::uint64_t key = 0;
        std::uint32_t index = 0;
    };
    static constexpr std::size_t first_capacity = 16384;
    static constexpr std::size_t kept_capacity = 65536;  // memory beyond it is given back when a jam is over

    Pushed push_when_full(ByteView block, std::uint8_t block_class, std::uint64_t key, MonoTime now);
    void append(ByteView block, std::uint8_t block_class, std::uint64_t key, MonoTime now);
    [[nodiscard]] bool make_room(std::size_t size, std::uint8_t block_class, std::uint64_t key, std::uint32_t& dropped);
    [[nodiscard]] bool drop_one(std::uint8_t block_class) noexcept;
    [[nodiscard]] bool drop_superseded() noexcept;
    [[nodiscard]] std::size_t droppable(std::uint8_t block_class) const noexcept;
    [[nodiscard]] bool oldest(std::uint8_t block_class) noexcept;
    [[nodiscard]] bool pinned(std::size_t index) const noexcept { return index == head_ && begun_ != 0; }
    void drop(std::size_t index) noexcept;
    void drop_from_head() noexcept;
    void reset() noexcept;
    void reserve(std::size_t size);
    void compact(std::size_t capacity);
    void index_keys();
    void note_key(std::uint64_t key, std::size_t index);
    [[nodiscard]] Newest& slot_of(std::uint64_t key) noexcept;

    Limits limits_;
    std::unique_ptr<std::uint8_t[]> memory_;
    std::size_t capacity_ = 0, tail_ = 0;  // bytes
    std::vector<Entry> entries_;           // by age; those before head_ are gone, dead ones lie between
    std::size_t head_ = 0;
    std::size_t begun_ = 0;  // bytes of entries_[head_] that a stream already took
    std::size_t bytes_ = 0, blocks_ = 0;
    std::array<std::size_t, classes> class_bytes_{};
    std::array<std::size_t, classes> oldest_{};  // where to look for the oldest of each class: none lies before

    // Only while jammed, that is, from the first time the byte bound was reached until the queue was empty or rewound: the newest block of
    // each key, and those that have a newer one, in the order in which they were superseded.
    bool jammed_ = false;
    std::vector<Newest> newest_;
    std::size_t keys_ = 0;
    std::vector<std::uint32_t> superseded_;
    std::size_t next_superseded_ = 0;
};

}  // namespace mavloom::net
