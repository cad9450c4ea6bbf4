// SPDX-License-Identifier: MIT
// A ring's reader between the Python objects that share it, and what it gives out. Knows nothing of Python but how to stay out of its way; any thread.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mavloom/shm/ring_reader.hpp"
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
    [[nodiscard]] bool look() noexcept;
    void look_away() noexcept;
    // False: somebody looks. Success again and again.
    [[nodiscard]] bool release() noexcept;

private:
    static constexpr int released = -1;

    const std::shared_ptr<RingSource> source_;
    const std::vector<shm::RingRecord> records_;
    const std::vector<std::uint64_t> copies_;
    std::atomic<int> lookers_{0};
};

class RingSource : public std::enable_shared_from_this<RingSource> {
public:
    RingSource(shm::RingReader reader, bool lossless) : lossless_(lossless), reader_(std::move(reader)) {}

    enum class State : std::uint8_t { found, nothing, no_writer, removed, damaged, forked, closed, looked_at };
    // Up to `most` records, waiting until `deadline` or the end of a slice. Without the GIL. `nothing`: worth another call.
    [[nodiscard]] State read(std::size_t most, MonoTime deadline, std::shared_ptr<Lease>& out);
    // The same without waiting, also with the GIL; `nothing` also while another thread reads.
    [[nodiscard]] State poll(std::size_t most, std::shared_ptr<Lease>& out);
    void give_way() const { turns_.give_way(); }

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
    [[nodiscard]] State read_locked(std::size_t most, MonoTime deadline, std::shared_ptr<Lease>& out);
    [[nodiscard]] State view(std::size_t most, MonoTime deadline, std::shared_ptr<Lease>& out);
    [[nodiscard]] State copy(std::size_t most, MonoTime deadline, std::shared_ptr<Lease>& out);
    [[nodiscard]] shm::ReadResult<shm::RingRecord> next(MonoTime deadline);
    [[nodiscard]] bool release_current();
    [[nodiscard]] bool close_locked();

    const BeforeFork fork_;
    const bool lossless_;
    Turns turns_;
    std::atomic<bool> closed_{false}, abandoned_{false};
    std::atomic<std::uint64_t> missed_{0};
    // Guarded by turns_, but for its const members.
    shm::RingReader reader_;
    std::weak_ptr<Lease> current_;          // of a lossless reader: what it holds
    std::vector<shm::RingRecord> scratch_;  // likewise: where batches are read to
};

}  // namespace mavloom::python
