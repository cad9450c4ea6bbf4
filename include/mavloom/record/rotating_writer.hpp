// SPDX-License-Identifier: MIT
// Writes a recording to one tlog file, or to a series of files (segments) limited by size or time. It never splits a
// frame and never replaces a file. Format: docs/formats/tlog.md.
//
// Time means the receive time of the frames; the writer reads no clock. A frame that is `every` or more later than the
// first frame of its segment starts a new segment. A frame with an earlier time, from another link or after a clock was
// set back, stays in the open segment.
//
// One owner thread. Opening a segment allocates; `write` within a segment does not. Closing a segment waits for the
// disk, so do not use this class in a loop that serves sockets.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "mavloom/base/clock.hpp"
#include "mavloom/record/tlog_writer.hpp"

namespace mavloom::record {

struct Rotation {
    std::uint64_t bytes = 0;           // largest segment, unless a single record is larger; 0: unlimited
    std::chrono::nanoseconds every{};  // longest time from a segment's first frame; 0: unlimited
    [[nodiscard]] bool rotates() const noexcept { return bytes != 0 || every != std::chrono::nanoseconds{}; }
};

class RotatingWriter {
public:
    // Without rotation, writes to `path`, as TlogWriter does. With rotation, each segment's name is the stem of `path`
    // plus the UTC time of its first frame, for example flight-20231114T221320.000Z.tlog. If that name exists, the
    // writer appends _2, _3, ... to the stem. The first frame opens the first segment. Fails if the folder is not
    // writable, or if rotation is requested for a device or FIFO.
    [[nodiscard]] static SetupResult<RotatingWriter> create(const std::filesystem::path& path, Rotation rotation = {});

    // Makes room for this record: in the buffer, or, if the record begins a segment, by writing the last records of the
    // open one and opening the next. So a retry after an error loses nothing, and no segment grows past its limits on a
    // full disk.
    [[nodiscard]] SetupResult<void> make_room(WallTime time, const wire::FrameView& frame);
    // Whether a retry after this error can succeed: the disk is full, or there is no file yet, because the folder is
    // missing for example. False for devices and pipes.
    [[nodiscard]] bool can_retry(const SetupError& error) const noexcept;
    // An error means that records were lost; `lost_records` counts them. There are two cases:
    // - This record was not taken, because `make_room` failed or the next segment could not be opened.
    // - The last records of the previous segment could not be written when it was closed.
    [[nodiscard]] SetupResult<void> write(WallTime time, const wire::FrameView& frame);
    // Adds one to `lost_records`, for a record that the caller stopped trying to write.
    void give_up() noexcept { ++refused_; }
    // Keeps the records in the buffer if the file was deleted.
    [[nodiscard]] SetupResult<void> flush();
    // Call it for each batch of frames and at least once a second. Twice a second, it writes the buffered records to
    // the file. If another program removed, renamed or replaced that file, it begins a new file for them instead. With
    // rotation and an empty buffer, the next frame begins the new file. Without rotation, the new file has the old
    // name, unless another file has taken it; then _2, _3, ... is appended to the stem. Returns the path of the old
    // file; empty if it is still there. If no new file can be created, a later call tries again. Until then, records
    // go to the old file if it was renamed, and to no file if it was deleted.
    [[nodiscard]] SetupResult<std::filesystem::path> maintain(MonoTime now);
    // Writes the buffered records and closes the file. If the file was removed, writes them to a new one. Returns the
    // path of a removed file that maintain() has not returned; empty if there is none.
    [[nodiscard]] SetupResult<std::filesystem::path> close();
    // The text that reports a path, as maintain() or close() just returned it, to a user.
    [[nodiscard]] std::string removal_notice(const std::filesystem::path& removed) const;

    // The path given to `create`.
    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
    // The file of the open segment; empty before the first segment.
    [[nodiscard]] std::filesystem::path segment_path() const;
    // The new name of a file that existed at this path; empty if there was none.
    [[nodiscard]] std::filesystem::path renamed_to() const;
    [[nodiscard]] std::uint64_t segments() const noexcept { return segments_; }
    // Sums over all segments. Taken records are written, still buffered, or lost because the disk stayed full.
    [[nodiscard]] std::uint64_t taken_records() const noexcept;
    [[nodiscard]] std::uint64_t written_records() const noexcept;
    [[nodiscard]] std::uint64_t written_bytes() const noexcept;
    // Records that are in no file: refused by `write`, given up, or still buffered after their segment was closed.
    [[nodiscard]] std::uint64_t lost_records() const noexcept;

private:
    RotatingWriter(std::filesystem::path path, Rotation rotation) : path_(std::move(path)), rotation_(rotation) {}

    [[nodiscard]] bool begins_segment(WallTime time, const wire::FrameView& frame) const noexcept;
    [[nodiscard]] bool is_removed() const noexcept;
    [[nodiscard]] bool is_deleted() const noexcept;
    // Begins a new file if the open one was deleted.
    [[nodiscard]] SetupResult<void> leave_deleted();
    [[nodiscard]] SetupResult<void> leave_at_the_end();
    [[nodiscard]] SetupResult<void> begin_again();
    [[nodiscard]] SetupResult<void> end_segment();
    [[nodiscard]] SetupResult<void> continue_in(TlogWriter next);
    [[nodiscard]] SetupResult<void> begin_segment(TlogWriter next, WallTime time);
    [[nodiscard]] std::filesystem::path free_name(WallTime time) const;

    std::filesystem::path path_;
    Rotation rotation_;
    std::optional<TlogWriter> writer_;
    std::filesystem::path left_;         // a removed file that was not returned yet
    std::optional<SetupError> no_file_;  // why there is no new file yet in place of the deleted one
    MonoTime check_due_{};
    WallTime begin_{};  // the time of the open segment's first frame
    std::uint64_t segments_ = 0;
    struct Sums {
        std::uint64_t taken = 0, written = 0, bytes = 0;
    } before_;  // of the closed segments
    std::uint64_t refused_ = 0;
    SetupResult<void> closed_segment_;  // how the last segment was closed, until `write` reports it
    bool closed_ = false;               // records that the last segment still buffers are lost
};

}  // namespace mavloom::record
