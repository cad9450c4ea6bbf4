// SPDX-License-Identifier: MIT
// The one writer of a ring (docs/formats/ring.md): makes the ring, or carries on in one whose writer is gone, wherever that one was killed.
//
//     auto writer = shm::RingWriter::open("px4");
//     writer->write(frame, {.time = wall_now(), .link = LinkId{3}});
//
// or without a copy: fill what `claim` gives, then `commit`. One owner thread; move-only. After opening nothing is allocated, and no system call is
// made unless somebody sleeps or the ring is full. Closing (the destructor too) leaves the ring for its readers and for the next writer.
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
    std::uint64_t capacity = default_capacity;  // bytes of records and their headers: a power of two, 64 KiB to 64 GiB
    WhenFull when_full = WhenFull::wait;
    unsigned mode = 0600;  // of a new ring, whatever the umask; readers that register need to write
};

// Link numbers from here up are no count of links, and leave no room behind them.
inline constexpr LinkId end_of_link_numbers{0xf000'0000};

class RingWriter {
public:
    // `in_use` while another writer is alive (the text names its process), `no_space` before a ring is made that does not fit, `bad_input` for a file
    // that is no ring of this version, which is left untouched. A ring of another capacity whose writer is gone is replaced; its readers reopen.
    [[nodiscard]] static SetupResult<RingWriter> open(std::string_view name, const RingOptions& options = {});
    RingWriter(RingWriter&& other) noexcept;
    RingWriter& operator=(RingWriter&& other) noexcept;
    ~RingWriter();

    // Copies `data` (at most longest() bytes) into the ring. With WhenFull::wait it waits for room until `deadline`: then it is `full`, and may be tried
    // again or given up (`count_dropped`).
    [[nodiscard]] WriteResult<void> write(ByteView data, const RecordInfo& info,
                                          MonoTime deadline = MonoTime::max()) noexcept;

    // Room for `length` bytes, to be filled and committed; valid until the next call. What was claimed before and not committed is given up.
    [[nodiscard]] WriteResult<ByteSpan> claim(std::size_t length, MonoTime deadline = MonoTime::max()) noexcept;
    // Publishes the first `length` bytes of the claim; all of them unless told otherwise. Requires a claim that has not been committed.
    void commit(const RecordInfo& info, std::size_t length) noexcept { producer_.commit(info, length); }
    void commit(const RecordInfo& info) noexcept { commit(info, producer_.claimed()); }

    // A record that the caller gave up, for who looks at the ring.
    void count_dropped() noexcept;

    // Wakes readers at once that sleep, whatever was woken within the last millisecond.
    void flush() noexcept;

    // Whether somebody removed or replaced the ring (by hand too): readers that come now do not find it. Costs two system calls.
    [[nodiscard]] bool is_removed() const noexcept;
    // Makes the ring anew under its name, or takes over the one that is there.
    [[nodiscard]] SetupResult<void> reopen();
    // Closes for good; with Leave::nothing the ring and its counter page are removed, and readers are told.
    enum class Leave : std::uint8_t { ring, nothing };
    [[nodiscard]] SetupResult<void> close(Leave leave = Leave::ring);

    [[nodiscard]] const std::string& name() const noexcept { return name_; }
    // Whether open() or reopen() made the ring; false: it carried on in one that was there.
    [[nodiscard]] bool created() const noexcept { return created_; }
    [[nodiscard]] std::size_t longest() const noexcept { return max_payload(options_.capacity); }
    [[nodiscard]] std::uint64_t records() const noexcept { return producer_.records(); }  // since the ring was made
    // The largest link number below `end_of_link_numbers` of the records that the ring holds, 0 without: who counts links in a ring that others wrote goes
    // on behind it. Looks at all of them.
    [[nodiscard]] LinkId last_link() const noexcept;
    [[nodiscard]] std::uint64_t dropped() const noexcept;  // likewise

private:
    RingWriter(std::string name, const RingOptions& options, std::unique_ptr<Segment> segment);
    [[nodiscard]] SetupResult<void> begin();
    [[nodiscard]] inline bool has_room(std::size_t length) noexcept;
    [[nodiscard]] WriteResult<void> make_room(std::size_t length, MonoTime deadline) noexcept;
    [[nodiscard]] WriteResult<void> wait_for_room(std::size_t length, MonoTime deadline) noexcept;
    void drop_dead(std::uint64_t slots) noexcept;
    void end() noexcept;

    std::string name_;
    RingOptions options_;
    std::unique_ptr<Segment> segment_;           // empty once closed
    const std::atomic<bool>* forked_ = nullptr;  // of the segment
    detail::Producer<SharedWords> producer_;
    MonoTime looked_for_dead_{};
    bool created_ = false;
};

}  // namespace mavloom::shm
