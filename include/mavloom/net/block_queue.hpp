// SPDX-License-Identifier: MIT
// A queue of outgoing blocks (whole frames) for one link, bounded by bytes and by age. See docs/guide/queues.md.
//
// Until the queue reaches a bound, it is first in, first out and loses nothing. At the byte bound it drops whole
// blocks:
// - The least important class goes first. Class 0 is the most important.
// - Within the least important class, superseded blocks go before all others. A newer block with the same key
//   supersedes an older one; key 0 is never superseded.
// - After that, the oldest block goes.
// - A new block never displaces a block of a more important class. If that leaves too little room, the new block itself
//   is dropped.
// - A block that the kernel has taken in part is never dropped at a bound.
//
// Blocks lie back to back in one buffer, so that one system call can send many of them. The buffer grows with the
// queue: to twice the bytes that are queued, and in large queues to nine eighths of the bound. Each block takes 24
// bytes more. The queue frees its memory when a backlog has been sent. It allocates nothing in steady state. Not
// thread-safe.
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
        std::uint32_t dropped = 0;  // blocks lost by this push, including the new one if it was not queued
    };
    // A place between two blocks. Valid until the next push or expire.
    struct Position {
        std::size_t index = 0;
    };
    struct Gathered {
        std::size_t blocks = 0, bytes = 0, pieces = 0;
    };

    explicit BlockQueue(const Limits& limits) noexcept : limits_(limits) {}

    // Queues a copy of `block`, which has less than 16 MiB. Set `key` only if a newer block with the same key makes
    // this one worthless; otherwise pass 0.
    Pushed push(ByteView block, std::uint8_t block_class, std::uint64_t key, MonoTime now);
    // Drops blocks that are older than their class allows. Returns how many.
    std::uint32_t expire(MonoTime now) noexcept;
    // Drops everything, including a block that was sent in part. Returns how many blocks.
    std::uint32_t clear() noexcept;

    [[nodiscard]] bool empty() const noexcept { return blocks_ == 0; }
    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }
    [[nodiscard]] std::size_t blocks() const noexcept { return blocks_; }
    // How many blocks of each class `push` and `expire` have dropped so far.
    [[nodiscard]] const std::array<std::uint64_t, classes>& dropped() const noexcept { return dropped_; }
    // True if a stream has sent a part of the first block.
    [[nodiscard]] bool has_begun() const noexcept { return begun_ != 0; }
    // The memory that the queue has allocated, some of which it may not have touched yet.
    [[nodiscard]] std::size_t memory_bytes() const noexcept;

    // For datagrams. `gather` collects whole blocks, starting at `from`, into as few pieces as possible. It takes at
    // most `max_bytes` in total, but always takes the first block. It moves `from` behind the last block taken. At the
    // end of the queue it takes no block. After sending, remove the sent blocks with `pop`.
    [[nodiscard]] Position front() const noexcept { return {head_}; }
    [[nodiscard]] Gathered gather(Position& from, std::size_t max_bytes, std::span<iovec> room) const noexcept;
    void pop(Position until) noexcept;

    // For streams. `pieces` collects everything from the first unsent byte, as far as `room` goes. It stops before a
    // block that would exceed `max_bytes`, but always takes the first block. After sending, pass the number of bytes
    // that the kernel took to `consume`. It removes the blocks that are complete and returns how many. After a
    // reconnect, `rewind` makes the next stream start with the whole first block.
    [[nodiscard]] std::size_t pieces(std::span<iovec> room, std::size_t max_bytes = SIZE_MAX) const noexcept;
    std::size_t consume(std::size_t bytes) noexcept;
    void rewind() noexcept;

private:
    struct Entry {
        static constexpr std::uint32_t largest_size = (1u << 24) - 1, largest_class = (1u << 7) - 1;
        std::uint64_t key;
        MonoTime queued;
        std::uint32_t offset;
        std::uint32_t size : 24;
        std::uint32_t block_class : 7;
        std::uint32_t live : 1;
    };
    static_assert(sizeof(Entry) == 24);
    static constexpr std::size_t first_capacity = 16384;
    // When a backlog has been sent, the queue frees memory beyond this.
    static constexpr std::size_t kept_capacity = 65536, kept_entries = 2048;
    // From these sizes on, memory matters more than the time to close gaps.
    static constexpr std::size_t large_bytes = 262'144, large_blocks = 8192;
    // When the queue has run empty this many times in a row and needed little each time, it frees memory beyond
    // `kept_capacity`. A burst needed that memory, not steady traffic.
    static constexpr std::uint8_t rests_after = 255;

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
    void end_backlog() noexcept;
    void reserve(std::size_t size);
    void reserve_entry();
    void reserve_bytes(std::size_t size);
    void move_blocks(std::size_t capacity);
    void remove_dead_entries();
    void index_keys();
    void note_key(std::uint64_t key, std::size_t index);
    void grow_index();
    [[nodiscard]] std::uint32_t& slot_of(std::uint64_t key) noexcept;

    Limits limits_;
    std::unique_ptr<std::uint8_t[]> memory_;
    std::size_t capacity_ = 0, tail_ = 0;  // bytes
    // Oldest first. Entries before head_ are finished; later ones with `live` = false were dropped.
    std::vector<Entry> entries_;
    std::size_t head_ = 0;
    std::size_t begun_ = 0;  // bytes of entries_[head_] that a stream has already sent
    std::size_t bytes_ = 0, blocks_ = 0;
    std::array<std::size_t, classes> class_bytes_{};
    // Start of the search for the oldest block of each class: no droppable block of that class lies before it.
    std::array<std::size_t, classes> oldest_{};
    std::array<std::uint64_t, classes> dropped_{};

    bool has_backlog_ = false;     // the outlet was blocked, or the queue was jammed
    std::uint8_t small_uses_ = 0;  // consecutive times that the queue ran empty and had needed little

    // Used only while the queue is jammed: from the moment it reaches the byte bound until it is empty or rewound.
    // `newest_` is a hash table of keys: the index of a key's newest block plus one, or 0. `superseded_` lists the
    // blocks that have a newer one, in the order in which they were superseded.
    bool jammed_ = false;
    std::vector<std::uint32_t> newest_;
    std::size_t keys_ = 0;
    std::vector<std::uint32_t> superseded_;
    std::size_t next_superseded_ = 0;
};

}  // namespace mavloom::net
