// SPDX-License-Identifier: MIT
// PyRingWriter: the Python class RingWriter, a writer that several threads may share.
// Any thread. Call with the GIL held unless a comment states otherwise; a call that waits releases it meanwhile.
#pragma once

#include <nanobind/nanobind.h>

#include <atomic>
#include <condition_variable>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "integer.hpp"
#include "mavloom/feed/sliced_mutex.hpp"
#include "mavloom/shm/ring_writer.hpp"
#include "ring/pin_count.hpp"
#include "waiting.hpp"

namespace mavloom::python {

// Memory for one record that the user fills: room in the ring, or memory that is discarded afterwards because a full
// ring drops the record.
struct Claimed {
    explicit Claimed(ByteSpan room) : bytes(room) {}
    explicit Claimed(std::size_t length) : thrown_away(length), bytes(thrown_away), is_dropped(true) {}

    std::vector<std::uint8_t> thrown_away;
    const ByteSpan bytes;
    const bool is_dropped = false;
    PinCount pins;
    std::atomic<bool> given_up{false};
};

// Makes a RecordInfo from a user's arguments; the time is now unless given. Raises UsageError for a value that is out
// of range.
[[nodiscard]] shm::RecordInfo record_info(const OptionalInteger& time_ns, const Integer& link, const Integer& kind,
                                          const Integer& verdict);
[[nodiscard]] WallTime wall_time(const Integer& time_ns);

class PyRingWriter {
public:
    PyRingWriter(const std::string& name, const Integer& capacity, const std::string& full, const Integer& mode);
    PyRingWriter(const PyRingWriter&) = delete;
    PyRingWriter& operator=(const PyRingWriter&) = delete;
    ~PyRingWriter();

    // Waits while lossless readers hold the ring. Returns false if the record was dropped and counted (`drop_newest`).
    bool write(const nb::object& data, const shm::RecordInfo& info);
    void close(bool remove);
    // Closes a writer that the end of the interpreter did not destroy, because a daemon thread or a frame of such a
    // thread keeps it alive. Runs without Python, when those threads already sleep forever. A claim in use keeps its
    // writer open.
    void close_at_exit() noexcept;

    // Returns room for one record. Only one claim is open at a time: other threads wait until it is committed or given
    // up. If the claiming thread calls any other function that writes, it gets BufferError.
    [[nodiscard]] std::shared_ptr<Claimed> claim(std::size_t length);
    // Publishes the first `length` bytes; false if the record was dropped. Raises BufferError while the bytes are in
    // use, and ClosedError if the claim is over.
    bool commit(Claimed& claimed, const shm::RecordInfo& info, std::size_t length);
    // Gives the room back: at once, or when the bytes are no longer in use (`on_unpinned`). Neither needs the
    // GIL.
    void give_up(Claimed& claimed) noexcept;
    void on_unpinned(Claimed& claimed) noexcept;

    [[noreturn]] static void raise_over();
    [[noreturn]] static void raise_pinned();

    // Call without the GIL. Waits for room until `deadline`. Returns `removed` once the writer is closed.
    [[nodiscard]] shm::WriteResult<void> put(ByteView data, const shm::RecordInfo& info, MonoTime deadline);
    // Raises the exception for an error of `put` other than `full`.
    [[noreturn]] void raise(shm::WriteError error, std::size_t length) const;

    [[nodiscard]] const std::string& name() const noexcept { return name_; }
    [[nodiscard]] std::size_t longest() const noexcept { return longest_; }
    [[nodiscard]] bool waits() const noexcept { return when_full_ == shm::WhenFull::wait; }
    [[nodiscard]] bool created() const noexcept { return created_; }
    [[nodiscard]] bool is_removed();
    [[nodiscard]] std::uint64_t records();
    [[nodiscard]] std::uint64_t dropped();
    // Raises ClosedError if closed, and BufferError if this thread has a claim open.
    void check() const;

private:
    void check_open() const;
    // Waits until no claim is open and returns the lock. The lock is not owned if `deadline` or one slice has passed
    // first.
    [[nodiscard]] feed::SlicedMutex::Lock lock_until(MonoTime deadline);
    // Waits until no other thread has a claim open.
    void wait_for_claim_end();
    [[nodiscard]] shm::WriteResult<std::shared_ptr<Claimed>> claim_or_wait(std::size_t length);
    [[nodiscard]] shm::WriteResult<std::shared_ptr<Claimed>> claim_locked(std::size_t length, MonoTime deadline);
    enum class Committed : std::uint8_t { yes, dropped, over, pinned };
    [[nodiscard]] Committed commit_locked(Claimed& claimed, const shm::RecordInfo& info, std::size_t length);
    void end_claim() noexcept;
    // If there is no room at once, releases the GIL and waits for at most one slice.
    [[nodiscard]] shm::WriteResult<void> put_or_wait(ByteView data, const shm::RecordInfo& info);
    [[nodiscard]] shm::WriteResult<void> put_locked(ByteView data, const shm::RecordInfo& info, MonoTime deadline);
    [[nodiscard]] SetupResult<void> close_locked(bool remove);
    void note_counters();

    const ForkGuard fork_;
    const std::string name_;
    const shm::WhenFull when_full_;
    std::size_t longest_ = 0;
    bool created_ = false;
    feed::SlicedMutex mutex_;
    std::condition_variable_any claim_ended_;
    std::atomic<std::uint64_t> claimer_{0};  // thread with the open claim; set with mutex_ held
    std::atomic<bool> closed_{false};
    // Guarded by mutex_:
    std::optional<shm::RingWriter> writer_;  // empty once closed
    std::shared_ptr<Claimed> claim_;         // the open claim
    bool removed_ = false;                   // this writer closed and removed the ring
    std::uint64_t records_ = 0, dropped_ = 0;
};

}  // namespace mavloom::python
