// SPDX-License-Identifier: MIT
// class RingWriter. Any thread; the GIL is needed by none of it but `write` and `close`.
#pragma once

#include <nanobind/nanobind.h>

#include <optional>
#include <string>

#include "mavloom/shm/ring_writer.hpp"
#include "waiting.hpp"

namespace mavloom::python {

class PyRingWriter {
public:
    PyRingWriter(const std::string& name, std::int64_t capacity, const std::string& full, std::int64_t mode);

    // Waits while lossless readers hold the ring. False: the record was dropped, and counted (`drop_newest`).
    bool write(const nb::object& data, std::optional<std::int64_t> time_ns, std::int64_t link, std::int64_t kind,
               std::int64_t verdict);
    void close(bool remove);

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
    void check() const;  // raises ClosedError

private:
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
    std::atomic<bool> closed_{false};
    // Guarded by turns_.
    std::optional<shm::RingWriter> writer_;  // empty once closed
    bool removed_ = false;                   // with the ring
    std::uint64_t records_ = 0, dropped_ = 0;
};

}  // namespace mavloom::python
