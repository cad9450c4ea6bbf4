// SPDX-License-Identifier: MIT
// A ring's reader between the Python objects that share it, and what it gives out. Knows nothing of Python but how to stay out of its way; any thread.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "looks.hpp"
#include "mavloom/shm/ring_reader.hpp"
#include "ring_alarm.hpp"
#include "waiting.hpp"

namespace mavloom::python {

class RingSource;

// Records that were read together: copies, or (lossless) views into the ring. Views end with the next read, and that must wait for those who look at
// them. Immutable but for the count of these.
class Lease {
public:
    Lease(std::shared_ptr<RingSource> source, std::vector<shm::RingRecord> records)
        : source_(std::move(source)), records_(std::move(records)) {}
    Lease(std::vector<shm::RingRecord> records, std::vector<std::uint64_t> copies)
        : records_(std::move(records)), copies_(std::move(copies)) {}

    [[nodiscard]] const std::vector<shm::RingRecord>& records() const noexcept { return records_; }
    [[nodiscard]] bool is_copy() const noexcept { return source_ == nullptr; }
    // Where the ring is; null for copies. Keeps it mapped.
    [[nodiscard]] const std::shared_ptr<RingSource>& source() const noexcept { return source_; }

    // Whoever looks at the bytes does so between these two. False: they were released.
    [[nodiscard]] bool look() noexcept { return looks_.begin(); }
    void look_away() noexcept;
    // False: somebody looks. Success again and again.
    [[nodiscard]] bool release() noexcept { return looks_.finish(); }

private:
    const std::shared_ptr<RingSource> source_;
    const std::vector<shm::RingRecord> records_;
    const std::vector<std::uint64_t> copies_;
    Looks looks_;
};

// Some of a lease's records: those from `first` on.
struct Portion {
    std::shared_ptr<Lease> lease;
    std::size_t first = 0;
};

class RingSource : public std::enable_shared_from_this<RingSource> {
public:
    RingSource(shm::RingReader reader, bool lossless) : lossless_(lossless), reader_(std::move(reader)) {}

    enum class State : std::uint8_t { found, nothing, no_writer, removed, damaged, forked, closed, looked_at };
    // Reading is two steps, and what the first one found waits for the second, of whatever thread: a signal's handler may come between them.
    // Up to `most` records, where none wait yet. Waits until `deadline` or the end of a slice, without the GIL; MonoTime{}: not at all. `nothing`: worth
    // another call; it may have been another thread's turn.
    [[nodiscard]] State fetch(std::size_t most, MonoTime deadline);
    // One of them, or all that are left of what was read together. `nothing`: another thread took them, or has its turn.
    [[nodiscard]] State take(std::size_t most, Portion& out);
    void give_way() const { turns_.give_way(); }

    // For loops: a descriptor, made at the first call, that `arm` lets become readable when there may be something to fetch, or nothing ever will.
    [[nodiscard]] SetupResult<int> event_fd();
    void arm();

    // Ends the views of a lease, and tells the writer. False: somebody looks.
    [[nodiscard]] bool release(Lease& lease);
    // Gives the slot back. False: somebody looks at what was read last.
    [[nodiscard]] bool close();
    // Nobody will read or close it any more: closed as soon as nobody looks.
    void abandon();
    void nobody_looks();

    // In a forked child the ring is no longer held for the records.
    [[nodiscard]] const BeforeFork& fork() const noexcept { return fork_; }
    [[nodiscard]] bool holds() const noexcept { return reader_.holds(); }
    [[nodiscard]] bool is_lossless() const noexcept { return lossless_; }
    [[nodiscard]] bool is_closed() const noexcept { return closed_.load(std::memory_order_relaxed); }
    [[nodiscard]] const std::string& name() const noexcept { return reader_.name(); }
    [[nodiscard]] std::uint64_t missed() const noexcept { return missed_.load(std::memory_order_relaxed); }
    [[nodiscard]] bool writer_alive() const noexcept { return reader_.writer_alive(); }
    [[nodiscard]] bool is_removed() const noexcept { return reader_.is_retired() || !reader_.is_named(); }

private:
    // All of these with turns_ held.
    [[nodiscard]] State fill(std::size_t most, MonoTime deadline);
    [[nodiscard]] State view(std::size_t most, MonoTime deadline);
    [[nodiscard]] State copy(std::size_t most, MonoTime deadline);
    [[nodiscard]] shm::ReadResult<shm::RingRecord> next(MonoTime deadline);
    [[nodiscard]] bool release_current();
    [[nodiscard]] bool close_locked();

    // For the alarm: without waiting for a turn.
    [[nodiscard]] Nanoseconds nap();
    [[nodiscard]] RingAlarm* alarm();

    const BeforeFork fork_;
    const bool lossless_;
    Turns turns_;
    std::atomic<bool> closed_{false}, abandoned_{false};
    std::atomic<std::uint64_t> missed_{0};
    // Guarded by turns_, but for its const members.
    shm::RingReader reader_;
    Portion pending_;                       // was fetched, and not taken yet
    std::weak_ptr<Lease> current_;          // of a lossless reader: what it holds
    std::vector<shm::RingRecord> scratch_;  // likewise: where batches are read to

    std::mutex making_alarm_;
    std::unique_ptr<RingAlarm> alarm_;  // made under that mutex, and never changed
};

}  // namespace mavloom::python
