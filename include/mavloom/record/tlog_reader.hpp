// SPDX-License-Identifier: MIT
// Reads a tlog record by record through one fixed buffer, whatever the size of the file. Behind damage it goes on at the next position where a
// plausible time and an intact frame stand, and says how many bytes it skipped. A frame of unknown id is taken where its end is the end of
// the file or the beginning of another record.
// Reads with read(), not by mapping: a file that somebody shortens meanwhile is an error here and would be a SIGBUS there.
// One owner thread (counters may be read from any). Allocates at opening only. Follows docs/formats/tlog.md.
#pragma once

#include <memory>
#include <optional>

#include "mavloom/base/counter.hpp"
#include "mavloom/record/file.hpp"
#include "mavloom/record/tlog.hpp"

namespace mavloom::record {

// Every byte read is counted once: file size = record_bytes + flagged_bytes + lost_bytes at the end of the file.
struct ReadCounters {
    Counter records, record_bytes;
    Counter unknown_ids;  // of `records`: without definition
    // Records whose frame has an incompatibility flag that is not defined: skipped.
    Counter unknown_flags, flagged_bytes;
    Counter lost_bytes;      // damaged, or cut at the end
    Counter damaged_places;  // runs of lost bytes
};

class TlogReader {
public:
    // `table` must outlive the reader.
    // `empty` is for pipes and devices: what `next` does while there is nothing.
    [[nodiscard]] static SetupResult<TlogReader> open(const std::filesystem::path& path, const wire::MessageTable& table,
                                                      File::Empty empty = File::Empty::wait);

    enum class Stop : std::uint8_t {
        end,          // the file is read to its end
        failed,       // `error` says why; nothing more can be read
        nothing_yet,  // a pipe is empty (`File::Empty::tell`), or a signal ended the wait; may be called again
        damage,  // nothing but damage in `most_damage` bytes, of `next_of` nothing of that message; may be called again
    };
    // The next record; its views live until the next call. Waits for a pipe or device, but for no more than it takes to judge the record. Gives
    // way after `most_damage` bytes without one: who has other work gets to it although a file is nothing but damage.
    [[nodiscard]] Result<Record, Stop> next(std::uint64_t most_damage = ~std::uint64_t{0});
    // The next record of one message. Faster than `next`, for it passes over records of other known ids without looking at their checksums as long
    // as record joins record; where they do not, it examines what it had passed over. Damage within what is passed over is not counted. Gives way
    // after `most_bytes` without one, whatever they held.
    [[nodiscard]] Result<Record, Stop> next_of(MessageId id, std::uint64_t most_bytes = ~std::uint64_t{0});
    [[nodiscard]] const SetupError& error() const noexcept { return *error_; }
    // For who was told `nothing_yet`: File::wait.
    [[nodiscard]] bool wait(std::chrono::milliseconds limit) const noexcept { return file_.wait(limit); }

    // Goes on at `offset`, which should be that of a record. Not for pipes. Bytes read again are counted again.
    [[nodiscard]] SetupResult<void> seek(std::uint64_t offset);

    // The offset of the first byte not yet handed out or skipped.
    [[nodiscard]] std::uint64_t position() const noexcept { return base_ + begin_; }
    // False for pipes and devices: they cannot be sought in.
    [[nodiscard]] bool is_file() const noexcept { return file_.is_regular(); }
    // The file's size when it was opened; 0 for a pipe.
    [[nodiscard]] std::uint64_t size() const noexcept { return size_; }
    [[nodiscard]] const ReadCounters& counters() const noexcept { return counters_; }

private:
    static constexpr std::size_t buffer_length = 256 * 1024;
    // Enough to judge a record of unknown id: itself and the one behind it.
    static constexpr std::size_t look_ahead = 2 * max_record_length;

    TlogReader(File file, std::uint64_t size, const wire::MessageTable& table);

    [[nodiscard]] ByteView unread() const noexcept { return {buffer_.get() + begin_, end_ - begin_}; }
    [[nodiscard]] bool needs_more() const noexcept;
    [[nodiscard]] Result<Record, Stop> take(std::size_t size, const wire::MessageInfo* info) noexcept;
    [[nodiscard]] std::size_t pass_over_to(MessageId id) noexcept;
    [[nodiscard]] std::optional<Stop> fill();
    [[nodiscard]] Stop read_failed(SetupError error);
    void lose(std::size_t bytes) noexcept;

    File file_;
    const wire::MessageTable* table_;
    std::unique_ptr<std::uint8_t[]> buffer_;
    std::size_t begin_ = 0, end_ = 0;  // the unread part of the buffer
    std::uint64_t base_ = 0;           // the file offset of the buffer's first byte
    std::uint64_t size_ = 0;
    std::uint64_t lost_run_ = 0;       // bytes skipped since the last record
    std::uint64_t examine_until_ = 0;  // file offset: before it nothing is passed over
    bool at_end_ = false;
    std::optional<SetupError> error_;
    ReadCounters counters_;
};

}  // namespace mavloom::record
