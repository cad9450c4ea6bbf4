// SPDX-License-Identifier: MIT
// Writes records to a shared-memory ring (docs/formats/ring.md). A ring has at most one writer at a time.
//
//     auto writer = shm::RingWriter::open("px4");
//     writer->write(frame, {.time = wall_now(), .link = LinkId{3}});
//
// To write without a copy, fill the memory that `claim` returns, then call `commit`.
//
// Opening creates the ring, or continues a ring whose writer is gone, even if that writer was killed in the middle of a
// record. One owner thread; move-only. After opening, a writer allocates nothing. It makes system calls only while a
// reader sleeps or the ring is full. Closing or destroying the writer leaves the ring for its readers and for the next
// writer.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <string_view>

#include "mavloom/base/result.hpp"
#include "mavloom/shm/detail/producer.hpp"
#include "mavloom/shm/record.hpp"

namespace mavloom::shm {

class Segment;

struct RingOptions {
    std::uint64_t capacity = default_capacity;  // bytes of records and headers: a power of two, 64 KiB to 64 GiB
    WhenFull when_full = WhenFull::wait;
    unsigned mode = 0600;  // of a new ring, regardless of the umask; readers that register need write access
    // If the file under the ring's name is damaged, is not a ring, or belongs to a user other than this one or root,
    // renames it to mavloom.NAME.aside instead of failing.
    bool sets_aside = false;
};

// last_link() ignores link numbers from here up, so that no writer continues its numbering there.
inline constexpr LinkId end_of_link_numbers{0xf000'0000};

class RingWriter {
public:
    // Creates or continues the ring `name`. A ring of another capacity is replaced if its writer is gone; its readers
    // then reopen the name. Errors:
    // - `in_use` if another writer is alive; the text names its process.
    // - `no_space` if a new ring does not fit; nothing is created.
    // - `bad_input` if the file is not a ring of this version; the file stays untouched.
    [[nodiscard]] static SetupResult<RingWriter> open(std::string_view name, const RingOptions& options = {});
    RingWriter(RingWriter&& other) noexcept;
    RingWriter& operator=(RingWriter&& other) noexcept;
    ~RingWriter();

    // Copies `data` (at most longest() bytes) into the ring. With WhenFull::wait, waits for room until `deadline`, then
    // returns `full`. The caller may retry, or drop the record and call `count_dropped`.
    [[nodiscard]] WriteResult<void> write(ByteView data, const RecordInfo& info,
                                          MonoTime deadline = MonoTime::max()) noexcept;

    // Reserves `length` bytes to fill and commit. Valid until the next call. Discards an earlier claim that was not
    // committed.
    [[nodiscard]] WriteResult<ByteSpan> claim(std::size_t length, MonoTime deadline = MonoTime::max()) noexcept;
    // Publishes the first `length` bytes of the claim; without `length`, all of it. Requires an uncommitted claim.
    void commit(const RecordInfo& info, std::size_t length) noexcept { producer_.commit(info, length); }
    void commit(const RecordInfo& info) noexcept { commit(info, producer_.claimed()); }

    // Why the file that had the name before was renamed (RingOptions::sets_aside). Empty if none was.
    [[nodiscard]] const std::string& set_aside() const noexcept { return set_aside_; }

    // Counts a record that the caller dropped, so that ring_status() shows it.
    void count_dropped() noexcept;

    // Wakes sleeping readers now, even if they were last woken less than a millisecond ago.
    void flush() noexcept;

    // Returns whether the ring was removed (even by hand) or replaced, so that new readers cannot find it. Makes two
    // system calls.
    [[nodiscard]] bool is_removed() const noexcept;
    // Creates the ring again under its name, or takes over the one that is there.
    [[nodiscard]] SetupResult<void> reopen();
    // Closes for good. Leave::nothing removes the ring and its counter page; readers then get `retired`.
    enum class Leave : std::uint8_t { ring, nothing };
    [[nodiscard]] SetupResult<void> close(Leave leave = Leave::ring);

    [[nodiscard]] const std::string& name() const noexcept { return name_; }
    // True if open() or reopen() created the ring; false if it continued an existing one.
    [[nodiscard]] bool created() const noexcept { return created_; }
    [[nodiscard]] std::size_t longest() const noexcept { return max_payload(options_.capacity); }
    [[nodiscard]] std::uint64_t records() const noexcept { return producer_.records(); }  // since the ring was created
    // Returns the largest link number below `end_of_link_numbers` in the ring's records, or 0. A writer that continues
    // a ring numbers its own links above it. Scans all records.
    [[nodiscard]] LinkId last_link() const noexcept;
    [[nodiscard]] std::uint64_t dropped() const noexcept;  // since the ring was created

private:
    RingWriter(std::string name, const RingOptions& options, std::unique_ptr<Segment> segment);
    [[nodiscard]] SetupResult<void> begin();
    [[nodiscard]] inline bool has_room(std::size_t length) noexcept;
    [[nodiscard]] WriteResult<void> make_room(std::size_t length, MonoTime deadline) noexcept;
    [[nodiscard]] WriteResult<void> wait_for_room(std::size_t length, MonoTime deadline) noexcept;
    void drop_dead(std::uint64_t slots) noexcept;
    void end() noexcept;

    std::string name_, set_aside_;
    RingOptions options_;
    std::unique_ptr<Segment> segment_;           // empty once closed
    const std::atomic<bool>* forked_ = nullptr;  // the segment's flag
    detail::Producer<SharedWords> producer_;
    MonoTime dead_checked_{};
    bool created_ = false;
};

}  // namespace mavloom::shm
