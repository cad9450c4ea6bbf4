// SPDX-License-Identifier: MIT
// Writes a tlog: whole records only. Records gather in a buffer and go to the system when it is full, at `flush` and at `close`. When the disk
// is full the file is cut back to its last whole record, the error is returned, and what is still in the buffer can be tried again.
// One owner thread. Allocates at opening only. Follows docs/formats/tlog.md.
#pragma once

#include <memory>

#include "mavloom/record/file.hpp"
#include "mavloom/record/tlog.hpp"

namespace mavloom::record {

class TlogWriter {
public:
    static constexpr std::size_t default_buffer_bytes = 256 * 1024;

    // Writes exactly `path`. A file of that name is first renamed to PATH.1, or to PATH.2, PATH.3, ... where those exist: nothing is ever
    // overwritten, and the highest number is the newest. A device or FIFO of that name is written to as it is.
    [[nodiscard]] static SetupResult<TlogWriter> create(const std::filesystem::path& path,
                                                        std::size_t buffer_bytes = default_buffer_bytes);

    TlogWriter(TlogWriter&&) noexcept = default;
    TlogWriter& operator=(TlogWriter&&) = delete;
    // Tries to write what is buffered; only `close` says whether that worked.
    ~TlogWriter();

    // Whether `write` would take a record of this frame. An error means that the buffer is full and could not be written: the disk may have room later.
    [[nodiscard]] SetupResult<void> make_room(const wire::FrameView& frame);
    // An error means that this record was not taken, and that the buffer could not be written. Times outside 1970 to 2255 are moved to those.
    [[nodiscard]] SetupResult<void> write(WallTime time, const wire::FrameView& frame);
    // Hands the buffered records to the system: other programs see them then.
    [[nodiscard]] SetupResult<void> flush();
    // Flushes, waits for the disk, closes. An error means that the records still counted by `buffered_bytes` are not in the file.
    [[nodiscard]] SetupResult<void> close();

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return file_.path(); }
    // Where an existing file went; empty if there was none.
    [[nodiscard]] const std::filesystem::path& renamed_to() const noexcept { return renamed_to_; }
    // Written and buffered together: what the file will hold.
    [[nodiscard]] std::uint64_t records() const noexcept { return records_; }
    [[nodiscard]] std::uint64_t size() const noexcept { return written_ + used_; }
    // What the system has taken, whole records only.
    [[nodiscard]] std::uint64_t written_records() const noexcept { return written_records_; }
    [[nodiscard]] std::uint64_t written_bytes() const noexcept { return written_; }
    [[nodiscard]] std::size_t buffered_bytes() const noexcept { return used_; }
    // Not a device or pipe.
    [[nodiscard]] bool is_file() const noexcept { return file_.is_regular(); }

private:
    TlogWriter(File file, std::filesystem::path renamed_to, std::size_t buffer_bytes);

    [[nodiscard]] SetupResult<void> keep_whole_records(File::Written result);

    File file_;
    std::filesystem::path renamed_to_;
    std::unique_ptr<std::uint8_t[]> buffer_;
    std::size_t capacity_;
    std::size_t used_ = 0;
    // Bytes of the first buffered record that a pipe or device has taken already: they cannot be taken back.
    std::size_t half_ = 0;
    std::uint64_t written_ = 0, written_records_ = 0;
    std::uint64_t records_ = 0;
};

}  // namespace mavloom::record
