// SPDX-License-Identifier: MIT
// class RingWriter. Any thread; the GIL is needed by none of it but `write` and `close`.
#pragma once

#include <nanobind/nanobind.h>

#include <atomic>
#include <condition_variable>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "integer.hpp"
#include "looks.hpp"
#include "mavloom/shm/ring_writer.hpp"
#include "waiting.hpp"

namespace mavloom::python {

// Room in the ring that is being filled; or, where a full ring drops the record, memory that is thrown away.
struct Claimed {
    explicit Claimed(ByteSpan room) : bytes(room) {}
    explicit Claimed(std::size_t length) : thrown_away(length), bytes(thrown_away), is_dropped(true) {}

    std::vector<std::uint8_t> thrown_away;
    const ByteSpan bytes;
    const bool is_dropped = false;
    Looks looks;
    std::atomic<bool> given_up{false};
};

// As users give it: now unless a time is given; UsageError for what is out of range.
[[nodiscard]] shm::RecordInfo record_info(const OptionalInteger& time_ns, const Integer& link, const Integer& kind,
                                          const Integer& verdict);
[[nodiscard]] WallTime wall_time(const Integer& time_ns);

class PyRingWriter {
public:
    PyRingWriter(const std::string& name, const Integer& capacity, const std::string& full, const Integer& mode);
    PyRingWriter(const PyRingWriter&) = delete;
    PyRingWriter& operator=(const PyRingWriter&) = delete;
    ~PyRingWriter();

    // Waits while lossless readers hold the ring. False: the record was dropped, and counted (`drop_newest`).
    bool write(const nb::object& data, const shm::RecordInfo& info);
    void close(bool remove);
    // For a writer that the interpreter's end did not destroy: a daemon thread's, or one that such a thread's frames keep alive. No Python any more;
    // its threads wait for ever. A claim that somebody looks at keeps its writer open.
    void close_at_exit() noexcept;

    // Room for one record. One is open at a time: other threads wait until it is committed or given up, and its own gets BufferError from all that writes.
    [[nodiscard]] std::shared_ptr<Claimed> claim(std::size_t length);
    // Publishes the first `length` bytes; false: dropped. BufferError while somebody looks at them, ClosedError for a claim that is over.
    bool commit(Claimed& claimed, const shm::RecordInfo& info, std::size_t length);
    // At once, or as soon as nobody looks.
    void give_up(Claimed& claimed) noexcept;
    void nobody_looks(Claimed& claimed) noexcept;

    [[noreturn]] static void raise_over();
    [[noreturn]] static void raise_looked_at();

    // Without the GIL: waits for room until `deadline`. `removed` once it is closed.
    [[nodiscard]] shm::WriteResult<void> put(ByteView data, const shm::RecordInfo& info, MonoTime deadline);
    // What `put` says that is neither success nor `full`.
    [[noreturn]] void raise(shm::WriteError error, std::size_t length) const;

    [[nodiscard]] const std::string& name() const noexcept { return name_; }
    [[nodiscard]] std::size_t longest() const noexcept { return longest_; }
    [[nodiscard]] bool waits() const noexcept { return when_full_ == shm::WhenFull::wait; }
    [[nodiscard]] bool created() const noexcept { return created_; }
    [[nodiscard]] bool is_removed();
    [[nodiscard]] std::uint64_t records();
    [[nodiscard]] std::uint64_t dropped();
    // Raises ClosedError; BufferError where this thread has a claim open.
    void check() const;

private:
    void check_open() const;
    // The turn to write, with no claim open; not owned: not yet, or not before the deadline.
    [[nodiscard]] Turns::Lock turn(MonoTime deadline);
    // With the GIL. Until no other thread's claim is open.
    void let_claim_end();
    [[nodiscard]] shm::WriteResult<std::shared_ptr<Claimed>> claim_or_wait(std::size_t length);
    [[nodiscard]] shm::WriteResult<std::shared_ptr<Claimed>> claim_locked(std::size_t length, MonoTime deadline);
    enum class Committed : std::uint8_t { yes, dropped, over, looked_at };
    [[nodiscard]] Committed commit_locked(Claimed& claimed, const shm::RecordInfo& info, std::size_t length);
    void end_claim() noexcept;
    // With the GIL, which is let go where there is no room at once, for a slice at most.
    [[nodiscard]] shm::WriteResult<void> put_or_wait(ByteView data, const shm::RecordInfo& info);
    [[nodiscard]] shm::WriteResult<void> put_locked(ByteView data, const shm::RecordInfo& info, MonoTime deadline);
    [[nodiscard]] SetupResult<void> close_locked(bool remove);
    void note_counters();

    const BeforeFork fork_;
    const std::string name_;
    const shm::WhenFull when_full_;
    std::size_t longest_ = 0;
    bool created_ = false;
    Turns turns_;
    std::condition_variable_any claim_ended_;
    std::atomic<std::uint64_t> claimer_{0};  // whose thread's claim is open; set with turns_ held
    std::atomic<bool> closed_{false};
    // Guarded by turns_.
    std::optional<shm::RingWriter> writer_;  // empty once closed
    std::shared_ptr<Claimed> claim_;         // that is open
    bool removed_ = false;                   // with the ring
    std::uint64_t records_ = 0, dropped_ = 0;
};

}  // namespace mavloom::python
