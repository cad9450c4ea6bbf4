// SPDX-License-Identifier: MIT
// SharedRingReader: a ring's reader that several Python objects share. Lease: the records that it returned. Neither
// calls Python, except to release the GIL. Any thread.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "mavloom/feed/ring_alarm.hpp"
#include "mavloom/feed/sliced_mutex.hpp"
#include "mavloom/shm/ring_reader.hpp"
#include "ring/pin_count.hpp"
#include "waiting.hpp"

namespace mavloom::python {

class SharedRingReader;

// Records that were read together: copies, or views into the ring (lossless). Views end or become copies:
// - The next read of the thread that took the views ends them. It fails while they are in use.
// - The next read of another thread waits while they are in use. It then replaces them by copies, because the first
//   thread may be about to use them again.
class Lease {
public:
    Lease(std::shared_ptr<SharedRingReader> source, std::vector<shm::RingRecord> records)
        : ring_reader_(std::move(source)), records_(std::move(records)) {}
    Lease(std::vector<shm::RingRecord> records, std::vector<std::uint64_t> copies)
        : records_(std::move(records)), copies_(std::move(copies)) {}

    // The records and where their bytes are. Call `pin` first: without it, the bytes may move.
    [[nodiscard]] const std::vector<shm::RingRecord>& records() const noexcept;
    [[nodiscard]] bool is_copy() const noexcept { return ring_reader_ == nullptr || kept_.load() == Kept::copies; }
    // The ring's reader, which keeps the ring mapped; null for records that were copied when they were read.
    [[nodiscard]] const std::shared_ptr<SharedRingReader>& ring_reader() const noexcept { return ring_reader_; }

    // Call `pin` before using the bytes.
    // - `counted`: call `unpin` afterwards.
    // - `free`: the views became copies, which never end. Do not call `unpin`.
    // - `refused`: the bytes have ended.
    enum class Pin : std::uint8_t { refused, counted, free };
    [[nodiscard]] Pin pin() noexcept;
    void unpin() noexcept;
    // Returns false if this thread has pinned them, or if several threads have.
    [[nodiscard]] bool is_another_threads() const noexcept;
    // Ends the records. Returns false while they are in use. Once it has returned true, later calls return true, too.
    [[nodiscard]] bool release() noexcept { return pins_.finish(); }
    // Replaces views by copies while the ring is still held for them. Returns false while they are in use.
    [[nodiscard]] bool keep();

private:
    enum class Kept : std::uint8_t { nothing, soon, copies };

    const std::shared_ptr<SharedRingReader> ring_reader_;
    const std::vector<shm::RingRecord> records_;
    std::vector<std::uint64_t> copies_;
    std::vector<shm::RingRecord> kept_records_;  // records_, with the data in copies_
    std::atomic<Kept> kept_{Kept::nothing};
    PinCount pins_;
    std::atomic<std::uint64_t> pinned_by_{0};  // the first thread that pinned them
    std::atomic<bool> is_pinned_by_several_{false};
};

// Part of a lease: its records from `first` on.
struct Portion {
    std::shared_ptr<Lease> lease;
    std::size_t first = 0;
};

class SharedRingReader : public std::enable_shared_from_this<SharedRingReader> {
public:
    SharedRingReader(shm::RingReader reader, bool lossless) : lossless_(lossless), reader_(std::move(reader)) {}

    enum class State : std::uint8_t {
        found,
        nothing,
        no_writer,
        removed,
        damaged,
        forked,
        closed,
        pinned,
        used_elsewhere
    };
    // Reading takes two steps, because a signal handler may run between them: `fetch` makes records pending, and
    // `take`, by any thread, takes them. `fetch` reads up to `most` records, unless some are pending already. It waits
    // until `deadline`, but at most for one slice (SlicedMutex); with MonoTime{} it does not wait. To wait, call it
    // without the GIL. `nothing`: call again; another thread may have had the reader. `used_elsewhere`: another thread
    // is using the records that were read last.
    [[nodiscard]] State fetch(std::size_t most, MonoTime deadline);
    // Takes one pending record (`most` is 1), or all of them. `nothing`: another thread took them or has the mutex.
    [[nodiscard]] State take(std::size_t most, Portion& out);
    void yield_to_waiters() const { mutex_.yield_to_waiters(); }

    // For event loops: returns a descriptor, created at the first call. After `arm` it becomes readable when there may
    // be something to fetch, or when nothing ever will be.
    [[nodiscard]] SetupResult<int> event_fd();
    void arm();

    // Ends the views of a lease and lets the writer pass them. Returns false while they are in use.
    [[nodiscard]] bool release(Lease& lease);
    // Gives the reader slot back. Returns false while the records that were read last are in use.
    [[nodiscard]] bool close();
    // `abandon`: the owner is gone. Closes the reader at once, or as soon as its records are no longer in use
    // (`on_unpinned`).
    void abandon();
    void on_unpinned();

    // In a forked child, the ring is no longer held for the records.
    [[nodiscard]] const ForkGuard& fork() const noexcept { return fork_; }
    [[nodiscard]] bool holds() const noexcept { return reader_.holds(); }
    [[nodiscard]] bool is_lossless() const noexcept { return lossless_; }
    [[nodiscard]] bool is_closed() const noexcept { return closed_.load(std::memory_order_relaxed); }
    [[nodiscard]] const std::string& name() const noexcept { return reader_.name(); }
    [[nodiscard]] std::uint64_t missed() const noexcept { return missed_.load(std::memory_order_relaxed); }
    [[nodiscard]] bool writer_alive() const noexcept { return reader_.writer_alive(); }
    [[nodiscard]] bool is_removed() const noexcept { return reader_.is_retired() || !reader_.is_named(); }

private:
    // Call these with mutex_ held.
    [[nodiscard]] State fill(std::size_t most, MonoTime deadline);
    [[nodiscard]] State view(std::size_t most, MonoTime deadline);
    [[nodiscard]] State copy(std::size_t most, MonoTime deadline);
    [[nodiscard]] shm::ReadResult<shm::RingRecord> next(MonoTime deadline);
    [[nodiscard]] bool release_current();
    [[nodiscard]] bool close_locked();

    // For the alarm: these never wait for the mutex.
    [[nodiscard]] Nanoseconds sleep_time();
    [[nodiscard]] feed::RingAlarm* alarm();

    const ForkGuard fork_;
    const bool lossless_;
    feed::SlicedMutex mutex_;
    std::atomic<bool> closed_{false}, abandoned_{false};
    std::atomic<std::uint64_t> missed_{0};
    // Guarded by mutex_, except for const members of reader_:
    shm::RingReader reader_;
    Portion pending_;                       // fetched, but not taken yet
    std::weak_ptr<Lease> current_;          // the lease that a lossless reader holds
    std::uint64_t taker_ = 0;               // the thread that took from current_; 0 if several did
    std::vector<shm::RingRecord> scratch_;  // lossless: the buffer for batches

    std::mutex making_alarm_;
    std::unique_ptr<feed::RingAlarm> alarm_;  // created with making_alarm_ held, then never changed
};

}  // namespace mavloom::python
