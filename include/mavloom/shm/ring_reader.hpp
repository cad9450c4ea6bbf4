// SPDX-License-Identifier: MIT
// Reads records from a shared-memory ring (docs/formats/ring.md). Up to 64 readers, in any processes, can register.
//
//     auto reader = shm::RingReader::open("px4");
//     while (const auto record = reader->read()) use(record->data);
//
// A *lossy* reader gets copies and never blocks the writer. If the writer laps it, `missed` in the next record is the
// exact number of records lost. A *lossless* reader gets views into the ring, and the writer may not overwrite the
// record in view. A writer with the `evict` policy may overwrite it; `missed` then counts the records lost.
//
// One owner thread; move-only. After opening, a reader allocates nothing and makes system calls only to wait.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "mavloom/base/result.hpp"
#include "mavloom/shm/detail/consumer.hpp"
#include "mavloom/shm/record.hpp"
#include "mavloom/shm/trust.hpp"

namespace mavloom::shm {

class Segment;

struct ReaderOptions {
    bool lossless = false;
    // `oldest` starts at the oldest record in the ring. It skips the part (at most 1/32) that the writer is about to
    // overwrite.
    enum class From : std::uint8_t { newest, oldest };
    From from = From::newest;
    // Busy-waits instead of sleeping. Saves the last microsecond of latency, but needs a CPU core of its own.
    bool spin = false;
    // Maps the ring read-only and leaves no trace in it. Such a reader is lossy and unlisted, and waits by polling
    // every millisecond. A lossy reader falls back to this if 64 other readers are registered. It also does so if it
    // may not write to the ring (mode 0640 and another user).
    bool read_only = false;
    Trust trust{};
};

class RingReader {
public:
    // Opens a ring for reading. Errors:
    // - `not_found` if there is no such ring; the text lists the existing rings.
    // - `in_use` for a lossless reader if 64 other readers are registered.
    // - `permission` if access is denied or the ring is not trusted.
    // - `bad_input` if the file is not a ring of this version.
    [[nodiscard]] static SetupResult<RingReader> open(std::string_view name, const ReaderOptions& options = {});
    RingReader(RingReader&& other) noexcept;
    RingReader& operator=(RingReader&& other) noexcept;
    ~RingReader();

    // Returns the next record, or `empty` if there is none. Releases the previous record: its view becomes invalid, and
    // the writer may overwrite it.
    [[nodiscard]] ReadResult<RingRecord> try_read() noexcept {
        using Found = detail::Consumer<SharedWords>::Found;
        if (forked()) return tl::unexpected(ReadError::forked);
        RingRecord record;
        const Found found = consumer_.next(record);
        if (found == Found::record) return record;
        return tl::unexpected(found == Found::empty ? ReadError::empty : ReadError::damaged);
    }
    // For lossless readers; others get `empty`. Calls `visit(const RingRecord&)` for up to `most` records, which span
    // at most about 1/8 of the ring. Returns how many, or `empty` if there are none. The records lie in the ring,
    // contiguous in memory, and all stay in view until the next call. An exception from `visit` terminates the program.
    // Inside `visit`, only `holds` of this reader may be called.
    template <class Visit>
    [[nodiscard]] ReadResult<std::size_t> try_visit(std::size_t most, Visit&& visit) noexcept {
        using Found = detail::Consumer<SharedWords>::Found;
        if (forked()) return tl::unexpected(ReadError::forked);
        if (!consumer_.lossless() || most == 0) return tl::unexpected(ReadError::empty);
        std::size_t count = 0;
        const Found found = consumer_.visit(most, [&](const RingRecord& record) {
            if (count++ == 0) woke();
            visit(record);
        });
        if (found == Found::record) return count;
        return tl::unexpected(found == Found::empty ? ReadError::empty : ReadError::damaged);
    }
    // Same as try_visit, but stores the records in `out`.
    [[nodiscard]] ReadResult<std::size_t> try_read_batch(std::span<RingRecord> out) noexcept {
        return try_visit(out.size(), [at = out.begin()](const RingRecord& record) mutable { *at++ = record; });
    }
    // Returns the next record. Waits until `deadline`. Returns `no_writer` or `retired` early, once everything is read.
    [[nodiscard]] ReadResult<RingRecord> read(MonoTime deadline = MonoTime::max()) noexcept;
    // For a loop that sleeps elsewhere (RingWaiter). `poll` is `read` without waiting: it returns a record, or at once
    // the reason why there is none.
    //
    // `arm` asks the writer to change `wake_word` when it commits a record. It returns how long the loop may sleep
    // before it polls again, or 0 if it should poll at once. The request stays in force until the next record.
    [[nodiscard]] ReadResult<RingRecord> poll() noexcept;
    [[nodiscard]] Nanoseconds arm() noexcept;
    // The word that the writer changes. The pointer keeps the ring mapped.
    [[nodiscard]] std::shared_ptr<const SharedWords::Word32> wake_word() const;
    // Ends the view of the last record now, and reports the position to the writer.
    void release() noexcept;
    // Gives up the slot and all holds, like the destructor, but keeps the ring mapped until destruction. A pointer into
    // an old view then reads old or newer bytes, and does not crash. Do not read from the reader afterwards.
    void detach() noexcept;

    // Returns whether the bytes read from the current view are valid: false once an evicting writer has removed the
    // hold. Copy or use the data first, then call this. The result applies to everything that was read before the call.
    // It costs an atomic read-modify-write of a shared word.
    [[nodiscard]] bool holds() const noexcept { return !consumer_.lossless() || consumer_.holds(); }
    [[nodiscard]] bool is_registered() const noexcept { return slot_.has_value(); }
    [[nodiscard]] bool writer_alive() const noexcept;
    // Number of writers so far. A changed number means a new writer.
    [[nodiscard]] std::uint64_t writers() const noexcept;
    // Returns whether the name still leads to this ring.
    [[nodiscard]] bool is_named() const noexcept;
    [[nodiscard]] bool is_retired() const noexcept { return consumer_.retired(); }

    [[nodiscard]] const std::string& name() const noexcept { return name_; }
    // The position of the record in view, or of the next one.
    [[nodiscard]] std::uint64_t position() const noexcept { return consumer_.position(); }
    // End of the committed records.
    [[nodiscard]] std::uint64_t end_position() const noexcept;
    [[nodiscard]] std::uint64_t missed() const noexcept { return consumer_.missed(); }  // total

private:
    RingReader(std::string name, const ReaderOptions& options, std::shared_ptr<Segment> segment);
    // Ends a wait: the writer no longer needs to wake this reader, and the next wait begins from the start.
    void woke() noexcept {
        consumer_.awake();
        waiting_since_ = {};
    }
    [[nodiscard]] bool forked() const noexcept { return forked_->load(std::memory_order_relaxed); }
    [[nodiscard]] SetupResult<void> begin();
    [[nodiscard]] std::optional<unsigned> take_slot() noexcept;
    [[nodiscard]] ReadResult<RingRecord> wait(MonoTime deadline) noexcept;
    [[nodiscard]] std::optional<ReadError> why_no_record(MonoTime now) noexcept;
    [[nodiscard]] Nanoseconds nap(MonoTime waiting_since, MonoTime now, MonoTime deadline) const noexcept;
    void end() noexcept;

    std::string name_;
    ReaderOptions options_;
    std::shared_ptr<Segment> segment_;           // shared with the holders of a wake word
    const std::atomic<bool>* forked_ = nullptr;  // the segment's flag
    std::optional<unsigned> slot_;
    detail::Consumer<SharedWords> consumer_;
    MonoTime next_writer_check_{}, waiting_since_{}, armed_{};
};

}  // namespace mavloom::shm
