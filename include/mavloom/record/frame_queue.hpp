// SPDX-License-Identifier: MIT
// A bounded queue of frames from a receiving thread to a thread that may be slower at times. It is a ring of bytes in
// anonymous memory.
//
// One writer thread and one reader thread. The writer never waits: `push` refuses a frame that does not fit, and the
// caller counts it. No frame costs an allocation or a lock. A system call occurs only when the reader sleeps or wakes.
// While the reader keeps up, only the first part of the ring's memory is ever touched.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::record {

class FrameQueue {
public:
    struct Entry {
        WallTime time{};
        LinkId link;
        wire::FrameView frame;  // valid until the next `next()`
    };

    // `capacity_bytes` is rounded up to a power of two, at least 64 KiB.
    [[nodiscard]] static SetupResult<std::unique_ptr<FrameQueue>> create(std::size_t capacity_bytes);
    ~FrameQueue();
    FrameQueue(const FrameQueue&) = delete;
    FrameQueue& operator=(const FrameQueue&) = delete;

    // Writer: appends a copy of the entry. Returns false if there is no room. The reader sees the entry at once, but
    // only `publish` wakes a sleeping reader.
    [[nodiscard]] bool push(const Entry& entry) noexcept;
    // Writer: wakes a sleeping reader. Call it after each batch of `push`.
    void publish() noexcept;
    // Writer: wakes a sleeping reader even if there is no entry, so that it can look after its file.
    void wake() noexcept;
    // Writer: ends the queue. The reader still gets the remaining entries, then the end.
    void close() noexcept;

    // Reader: returns the next entry, or nothing if the queue is empty now.
    [[nodiscard]] std::optional<Entry> next() noexcept;
    // Reader: sleeps until there is an entry to read, or until `wake`, and returns true. Returns false if the queue is
    // closed and empty.
    [[nodiscard]] bool wait() noexcept;

    [[nodiscard]] std::size_t capacity() const noexcept { return capacity_; }
    // Writer: returns an upper bound of the bytes in use, because the reader may free entries meanwhile.
    [[nodiscard]] std::size_t used_bytes() const noexcept;

private:
    struct Header;
    FrameQueue(std::uint8_t* memory, std::size_t capacity) noexcept : memory_(memory), capacity_(capacity) {}
    [[nodiscard]] std::uint8_t* at(std::uint64_t position) const noexcept {
        return memory_ + (position & (capacity_ - 1));
    }
    [[nodiscard]] std::size_t to_end(std::uint64_t position) const noexcept {
        return capacity_ - (position & (capacity_ - 1));
    }
    void load_head() noexcept;

    std::uint8_t* const memory_;
    const std::size_t capacity_;
    // Positions count bytes since the start and never wrap. Each position has its own cache line, together with its
    // owner's cached copy of the other position.
    struct alignas(64) {
        std::atomic<std::uint64_t> position{0};
        // From this position the writer jumped back to the start of the ring, because the queue was empty.
        std::atomic<std::uint64_t> restart_at{~std::uint64_t{0}};
        std::uint64_t head_seen = 0;
        // Everything before this position counts as read, even if the reader has not noticed the jump yet.
        std::uint64_t restarted_to = 0;
    } tail_;  // written by the writer
    struct alignas(64) {
        std::atomic<std::uint64_t> position{0};
        std::uint64_t tail_seen = 0;
        std::uint64_t release_to = 0;
    } head_;                                            // written by the reader
    alignas(64) std::atomic<std::uint32_t> signal_{0};  // counts wake-ups; `wait` sleeps on it
    std::atomic<bool> sleeping_{false};
    std::atomic<bool> closed_{false};
    std::atomic<bool> woken_{false};
};

}  // namespace mavloom::record
