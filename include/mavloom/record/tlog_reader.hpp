// SPDX-License-Identifier: MIT
// Reads a tlog file record by record, through one fixed buffer. Format: docs/formats/tlog.md.
//
// After damage, the reader resumes at the next position with a plausible time and an intact frame. It reports how many
// bytes it skipped. It accepts a frame of unknown id only if another record or the end of the file follows.
//
// The reader uses read() and does not map the file. If another program shortens the file meanwhile, the reader returns
// an error; with a mapping it would get SIGBUS. One owner thread; any thread may read the counters. Allocates when it
// opens the file, and for error texts.
#pragma once

#include <memory>
#include <optional>

#include "mavloom/base/counter.hpp"
#include "mavloom/record/file.hpp"
#include "mavloom/record/tlog.hpp"

namespace mavloom::record {

// Counts every byte once: at the end of the file, record_bytes + flagged_bytes + lost_bytes is the file size.
struct ReadCounters {
    Counter records, record_bytes;
    Counter unknown_ids;  // those of `records` whose message id has no definition
    // Records skipped because their frame has an undefined incompatibility flag.
    Counter unknown_flags, flagged_bytes;
    Counter lost_bytes;      // damaged bytes, and those of a record cut off at the end
    Counter damaged_places;  // runs of lost bytes
};

class TlogReader {
public:
    // `table` must outlive the reader. `empty` selects what `next` does while a pipe or device is empty. A file of
    // another format, recognised by its first bytes (DataFlash, ULog, gzip, pcap, ...), is the error `bad_input`.
    [[nodiscard]] static SetupResult<TlogReader> open(const std::filesystem::path& path, const wire::MessageTable& table,
                                                      File::Empty empty = File::Empty::wait);

    enum class Stop : std::uint8_t {
        end,          // the end of the file was reached
        failed,       // reading failed; `error` has the reason
        nothing_yet,  // a pipe is empty (`File::Empty::report`), or a signal ended the wait; call again
        damage,       // the byte limit was reached without a wanted record; call again
    };
    // Returns the next record; its views are valid until the next call. For a pipe or device, it waits only for the
    // bytes that it needs to judge the record. After `max_damage` bytes without a record it returns Stop::damage, so
    // that a badly damaged file does not block its caller.
    [[nodiscard]] Result<Record, Stop> next(std::uint64_t max_damage = ~std::uint64_t{0});
    // Returns the next record of one message. It is faster than `next`: while records follow each other without a gap,
    // it skips other known messages without checking their checksums; where the sequence breaks, it examines them.
    // It counts no damage within skipped records, and misses a record to whose end the damaged length of the one before
    // reaches. After `max_bytes` without a record of the message it returns Stop::damage.
    [[nodiscard]] Result<Record, Stop> next_of(MessageId id, std::uint64_t max_bytes = ~std::uint64_t{0});
    [[nodiscard]] const SetupError& error() const noexcept { return *error_; }
    // Waits for data after Stop::nothing_yet; see File::wait.
    [[nodiscard]] bool wait(std::chrono::milliseconds limit) const noexcept { return file_.wait(limit); }

    // Continues at `offset`, which should be the offset of a record. Fails for pipes. Bytes that are read again are
    // counted again.
    [[nodiscard]] SetupResult<void> seek(std::uint64_t offset);

    // The offset of the first byte not yet returned or skipped.
    [[nodiscard]] std::uint64_t position() const noexcept { return base_ + begin_; }
    // False for pipes and devices, which cannot seek.
    [[nodiscard]] bool is_file() const noexcept { return file_.is_regular(); }
    // The file's size when it was opened; 0 for a pipe.
    [[nodiscard]] std::uint64_t size() const noexcept { return size_; }
    [[nodiscard]] const ReadCounters& counters() const noexcept { return counters_; }
    // Call it at the end of the file. Returns true if no record was found and the file is too long to be one cut-off
    // record. Such a file is not a recording.
    [[nodiscard]] bool found_no_record() const noexcept {
        return counters_.records.value() == 0 && counters_.unknown_flags.value() == 0 &&
               counters_.lost_bytes.value() > max_record_length;
    }
    // The error to report if `found_no_record()`.
    [[nodiscard]] SetupError no_record_error() const;

private:
    static constexpr std::size_t buffer_length = 256 * 1024;
    // Enough to judge a record of unknown id: the record and the one after it.
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
    std::uint64_t examine_until_ = 0;  // file offset up to which `next_of` checks every record
    bool at_end_ = false;
    std::optional<SetupError> error_;
    ReadCounters counters_;
};

}  // namespace mavloom::record
