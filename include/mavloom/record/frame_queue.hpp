// SPDX-License-Identifier: MIT
// Frames on their way from a receiving thread to one that is slower at times: a bounded ring of bytes in anonymous memory. One writer thread, one
// reader thread. The writer never waits: what does not fit is refused, and the caller counts it. No allocation and no lock per frame; a
// system call only when the reader sleeps. Memory is touched as it is needed: while the reader keeps up, only the ring's first part is.
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

    // Writer. False when there is no room. Entries become visible at once; a sleeping reader is woken by `publish`.
    [[nodiscard]] bool push(const Entry& entry) noexcept;
    // Writer: after a batch.
    void publish() noexcept;
    // Writer: nothing follows. The reader gets what is left, then the end.
    void close() noexcept;

    // Reader: the next entry, or empty when there is none now.
    [[nodiscard]] std::optional<Entry> next() noexcept;
    // Reader: sleeps until there is something to read or the queue is closed and empty; false in the second case.
    [[nodiscard]] bool wait() noexcept;

    [[nodiscard]] std::size_t capacity() const noexcept { return capacity_; }
    // Writer: a moment's value.
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
    void look_at_head() noexcept;

    std::uint8_t* const memory_;
    const std::size_t capacity_;
    // Positions count bytes since the beginning and never wrap; each lies on a cache line of its own with what its owner remembers of the other.
    struct alignas(64) {
        std::atomic<std::uint64_t> position{0};
        std::atomic<std::uint64_t> restart_at{~std::uint64_t{0}};  // an empty queue went on from here at the ring's start
        std::uint64_t head_seen = 0;
        std::uint64_t restarted_to = 0;  // all before is read, even if the reader does not know yet
    } tail_;                             // the writer's
    struct alignas(64) {
        std::atomic<std::uint64_t> position{0};
        std::uint64_t tail_seen = 0;
        std::uint64_t release_to = 0;
    } head_;                                            // the reader's
    alignas(64) std::atomic<std::uint32_t> signal_{0};  // counts wake-ups; what `wait` sleeps on
    std::atomic<bool> sleeping_{false};
    std::atomic<bool> closed_{false};
};

}  // namespace mavloom::record
