// SPDX-License-Identifier: MIT
// Writes a tlog file that holds whole records only. Format: docs/formats/tlog.md.
//
// The writer buffers records. It writes them to the file when the buffer is full, on `flush` and on `close`. If the
// disk is full, it truncates the file to the last whole record and returns the error. The rest stays buffered for a
// retry.
// One owner thread. Allocates when it opens the file, and for error texts.
#pragma once

#include <memory>

#include "mavloom/record/file.hpp"
#include "mavloom/record/tlog.hpp"

namespace mavloom::record {

class TlogWriter {
public:
    static constexpr std::size_t default_buffer_bytes = 256 * 1024;

    // Opens `path`. An existing recording, or an empty file, is first renamed to PATH.1, or to the first free one of
    // PATH.2, PATH.3, ... So no file is overwritten, and the highest number is the newest. Any other file stays, and is
    // an error (`in_use`). A character device or FIFO is not renamed; the writer writes to it directly.
    [[nodiscard]] static SetupResult<TlogWriter> create(const std::filesystem::path& path,
                                                        std::size_t buffer_bytes = default_buffer_bytes);
    // The same, but a device or FIFO is an error (`in_use`). It never waits: another user may have put a FIFO there.
    [[nodiscard]] static SetupResult<TlogWriter> create_file(const std::filesystem::path& path,
                                                             std::size_t buffer_bytes = default_buffer_bytes);

    TlogWriter(TlogWriter&&) noexcept = default;
    TlogWriter& operator=(TlogWriter&&) = delete;
    // Tries to write the buffered records, but cannot report an error. Call `close` to learn of one.
    ~TlogWriter();

    // Makes room in the buffer for a record of this frame. An error means that the buffer is full and could not be
    // written; a retry may succeed later.
    [[nodiscard]] SetupResult<void> make_room(const wire::FrameView& frame);
    // Buffers a record. An error means that the record was not taken, because the buffer is full and could not be
    // written. Times before 1970 or after 2255 are clamped to that range.
    [[nodiscard]] SetupResult<void> write(WallTime time, const wire::FrameView& frame);
    // Returns whether the buffer has room for a record of this frame.
    [[nodiscard]] bool has_room(const wire::FrameView& frame) const noexcept;
    // Moves the records that `from` still buffers to this writer, which must be new.
    void take_buffered(TlogWriter& from) noexcept;
    // The time of the first buffered record. Call it only if there is one.
    [[nodiscard]] WallTime first_buffered_time() const noexcept;
    // Writes the buffered records to the file, where other programs can see them.
    [[nodiscard]] SetupResult<void> flush();
    // Flushes, waits for the disk and closes the file. After an error, the records that `buffered_bytes` still counts
    // are not in the file.
    [[nodiscard]] SetupResult<void> close();

    // Closes the file without writing the buffered records to it. Only `take_buffered` and `close` may follow.
    void let_go() noexcept { file_.close(); }

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return file_.path(); }
    // The new name of a file that existed at this path; empty if there was none.
    [[nodiscard]] const std::filesystem::path& renamed_to() const noexcept { return renamed_to_; }
    // Written and buffered records together.
    [[nodiscard]] std::uint64_t records() const noexcept { return records_; }
    [[nodiscard]] std::uint64_t size() const noexcept { return written_ + used_; }
    // Whole records in the file.
    [[nodiscard]] std::uint64_t written_records() const noexcept { return written_records_; }
    [[nodiscard]] std::uint64_t written_bytes() const noexcept { return written_; }
    [[nodiscard]] std::size_t buffered_bytes() const noexcept { return used_; }
    // Returns whether the path still leads to the file that is written to.
    [[nodiscard]] bool is_named() const noexcept { return file_.is_named(); }
    // False if the file was deleted. True if it was renamed.
    [[nodiscard]] bool is_linked() const noexcept { return file_.is_linked(); }
    // False for a device or pipe.
    [[nodiscard]] bool is_file() const noexcept { return file_.is_regular(); }

private:
    TlogWriter(File file, std::filesystem::path renamed_to, std::size_t buffer_bytes);

    [[nodiscard]] SetupResult<void> keep_whole_records(File::Written result);

    File file_;
    std::filesystem::path renamed_to_;
    std::unique_ptr<std::uint8_t[]> buffer_;
    std::size_t capacity_;
    std::size_t used_ = 0;
    // Bytes of the first buffered record that a pipe or device has already taken; they cannot be withdrawn.
    std::size_t half_ = 0;
    std::uint64_t written_ = 0, written_records_ = 0;
    std::uint64_t records_ = 0;
};

}  // namespace mavloom::record
