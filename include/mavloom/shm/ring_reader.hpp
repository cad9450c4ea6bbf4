// SPDX-License-Identifier: MIT
// A reader of a ring (docs/formats/ring.md); up to 64 register, in any processes.
//
//     auto reader = shm::RingReader::open("px4");
//     while (const auto record = reader->read()) use(record->data);
//
// A *lossy* reader never holds the writer; it gets copies, and a record's `missed` says by exactly how many records it was lapped before it. A
// *lossless* one gets views into the ring, and the writer may not pass the record in view (unless it evicts: then `missed` counts too). One owner
// thread; move-only. After opening nothing is allocated, and nothing but waiting makes a system call.
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

namespace mavloom::shm {

class Segment;

struct ReaderOptions {
    bool lossless = false;
    // `oldest`: all that the ring holds, but for the part (at most a thirty-second) that the writer is about to overwrite.
    enum class From : std::uint8_t { newest, oldest };
    From from = From::newest;
    // Waits by looking again and again: the last microsecond, for a core of its own.
    bool spin = false;
    // Maps the ring read-only and leaves no trace in it: lossy, not listed, and waiting looks every millisecond. So is every lossy reader who may not
    // write to the ring (mode 0640 and another user) or finds 64 others.
    bool read_only = false;
};

class RingReader {
public:
    // `not_found` with the rings that there are; `in_use` for a 65th lossless reader; `permission`; `bad_input` for what is no ring of this version.
    [[nodiscard]] static SetupResult<RingReader> open(std::string_view name, const ReaderOptions& options = {});
    RingReader(RingReader&& other) noexcept;
    RingReader& operator=(RingReader&& other) noexcept;
    ~RingReader();

    // The next record if there is one (else `empty`). Releases the one before: its view ends, and the writer may pass it.
    [[nodiscard]] ReadResult<RingRecord> try_read() noexcept {
        using Found = detail::Consumer<SharedWords>::Found;
        if (forked()) return tl::unexpected(ReadError::forked);
        RingRecord record;
        const Found found = consumer_.next(record);
        if (found == Found::record) return record;
        return tl::unexpected(found == Found::empty ? ReadError::empty : ReadError::damaged);
    }
    // Of a lossless reader (else `empty`): as many records as there are, up to `most` and about an eighth of the ring, in place, in one piece of
    // memory, and all in view until the next call. How many; `empty` when there are none. `visit(const RingRecord&)` gets each; what it throws ends
    // the program, and of this reader it may ask `holds` alone.
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
    // The same into `out`.
    [[nodiscard]] ReadResult<std::size_t> try_read_batch(std::span<RingRecord> out) noexcept {
        return try_visit(out.size(), [at = out.begin()](const RingRecord& record) mutable { *at++ = record; });
    }
    // The next record, waiting until `deadline`; ends before with `no_writer` or `retired` once all is read.
    [[nodiscard]] ReadResult<RingRecord> read(MonoTime deadline = MonoTime::max()) noexcept;
    // For a loop that sleeps elsewhere (RingWaiter). `poll` is `read` without waiting: a record, or at once why there is none. `arm` asks the writer to
    // change `wake_word` when there is one, until the next record: how long the loop may sleep before it polls again, 0 when something waits already.
    [[nodiscard]] ReadResult<RingRecord> poll() noexcept;
    [[nodiscard]] Nanoseconds arm() noexcept;
    // Keeps the mapping for as long as it is held.
    [[nodiscard]] std::shared_ptr<const SharedWords::Word32> wake_word() const;
    // Ends the view of the last record now, and tells the writer.
    void release() noexcept;
    // Gives the slot and every hold back, as the destructor does, but leaves the ring mapped until then: what still points to a view reads old or newer
    // bytes, and does not crash. Nothing may be read after it.
    void detach() noexcept;

    // Whether what was read of the view is what was written: false once a writer that evicts took the hold away. Copy (or use), then ask: the answer is
    // about what was read before the call, and a read-modify-write of a shared word.
    [[nodiscard]] bool holds() const noexcept { return !consumer_.lossless() || consumer_.holds(); }
    [[nodiscard]] bool is_registered() const noexcept { return slot_.has_value(); }
    [[nodiscard]] bool writer_alive() const noexcept;
    // How many there have been: another number, another writer.
    [[nodiscard]] std::uint64_t writers() const noexcept;
    // Whether the name still leads to this ring.
    [[nodiscard]] bool is_named() const noexcept;
    [[nodiscard]] bool is_retired() const noexcept { return consumer_.retired(); }

    [[nodiscard]] const std::string& name() const noexcept { return name_; }
    [[nodiscard]] std::uint64_t position() const noexcept {
        return consumer_.position();
    }  // of the record in view, or the next
    // Where what is committed now ends.
    [[nodiscard]] std::uint64_t end_position() const noexcept;
    [[nodiscard]] std::uint64_t missed() const noexcept { return consumer_.missed(); }  // in all

private:
    RingReader(std::string name, const ReaderOptions& options, std::shared_ptr<Segment> segment);
    // A wait is over: the writer need not wake this reader, and the next wait begins anew.
    void woke() noexcept {
        consumer_.awake();
        waiting_since_ = {};
    }
    [[nodiscard]] bool forked() const noexcept { return forked_->load(std::memory_order_relaxed); }
    [[nodiscard]] SetupResult<void> begin();
    [[nodiscard]] std::optional<unsigned> take_slot() noexcept;
    [[nodiscard]] ReadResult<RingRecord> wait(MonoTime deadline) noexcept;
    [[nodiscard]] std::optional<ReadError> why_nothing_comes(MonoTime now) noexcept;
    [[nodiscard]] Nanoseconds nap(MonoTime waiting_since, MonoTime now, MonoTime deadline) const noexcept;
    void end() noexcept;

    std::string name_;
    ReaderOptions options_;
    std::shared_ptr<Segment> segment_;           // with those who hold a wake word
    const std::atomic<bool>* forked_ = nullptr;  // of the segment
    std::optional<unsigned> slot_;
    detail::Consumer<SharedWords> consumer_;
    MonoTime next_look_at_writer_{}, waiting_since_{}, armed_{};
};

}  // namespace mavloom::shm
