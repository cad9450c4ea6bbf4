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

// Records that were read together: copies, or (lossless) views into the ring. Views end with the next read of their thread, and that must wait for those
// who look at them; before one of another thread they become copies, for theirs may be about to look. Immutable but for that.
class Lease {
public:
    Lease(std::shared_ptr<RingSource> source, std::vector<shm::RingRecord> records)
        : source_(std::move(source)), records_(std::move(records)) {}
    Lease(std::vector<shm::RingRecord> records, std::vector<std::uint64_t> copies)
        : records_(std::move(records)), copies_(std::move(copies)) {}

    // Where the bytes are: look first, or they may move.
    [[nodiscard]] const std::vector<shm::RingRecord>& records() const noexcept;
    [[nodiscard]] bool is_copy() const noexcept { return source_ == nullptr || kept_.load() == Kept::copies; }
    // Where the ring is; null for copies. Keeps it mapped.
    [[nodiscard]] const std::shared_ptr<RingSource>& source() const noexcept { return source_; }

    // Whoever looks at the bytes does so between these two, but for copies of what was in the ring, which nobody ends.
    enum class Look : std::uint8_t { refused, counted, free };
    [[nodiscard]] Look look() noexcept;
    void look_away() noexcept;
    // Whether this thread is not among those that looked, and only one other is.
    [[nodiscard]] bool is_another_threads() const noexcept;
    // False: somebody looks. Success again and again.
    [[nodiscard]] bool release() noexcept { return looks_.finish(); }
    // Makes copies of views, while the ring is held for them. False: somebody looks.
    [[nodiscard]] bool keep();

private:
    enum class Kept : std::uint8_t { nothing, soon, copies };

    const std::shared_ptr<RingSource> source_;
    const std::vector<shm::RingRecord> records_;
    std::vector<std::uint64_t> copies_;
    std::vector<shm::RingRecord> kept_records_;  // the same, in copies_
    std::atomic<Kept> kept_{Kept::nothing};
    Looks looks_;
    std::atomic<std::uint64_t> looker_{0};  // the first
    std::atomic<bool> has_several_lookers_{false};
};

// Some of a lease's records: those from `first` on.
struct Portion {
    std::shared_ptr<Lease> lease;
    std::size_t first = 0;
};

class RingSource : public std::enable_shared_from_this<RingSource> {
public:
    RingSource(shm::RingReader reader, bool lossless) : lossless_(lossless), reader_(std::move(reader)) {}

    enum class State : std::uint8_t {
        found,
        nothing,
        no_writer,
        removed,
        damaged,
        forked,
        closed,
        looked_at,
        used_elsewhere
    };
    // Reading is two steps, and what the first one found waits for the second, of whatever thread: a signal's handler may come between them.
    // Up to `most` records, where none wait yet. Waits until `deadline` or the end of a slice, without the GIL; MonoTime{}: not at all. `nothing`: worth
    // another call; it may have been another thread's turn. `used_elsewhere`: another thread looks at what was read last.
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
    std::uint64_t taker_ = 0;               // of that; none where several took of it
    std::vector<shm::RingRecord> scratch_;  // likewise: where batches are read to

    std::mutex making_alarm_;
    std::unique_ptr<RingAlarm> alarm_;  // made under that mutex, and never changed
};

}  // namespace mavloom::python
