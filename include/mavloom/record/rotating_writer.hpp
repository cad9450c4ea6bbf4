// SPDX-License-Identifier: MIT
// A recording that may go on in new files: by size, by time, or never. A frame is never split, a file never replaced. Time is the frames' own
// receive time: a new segment begins with the first frame that is `every` or more later than its segment's first one; frames that are earlier
// (another link's, a clock set back) stay in the segment that is open. Nothing is read from a clock here.
// One owner thread; opening a segment allocates, `write` within one does not. Waits for the disk when it closes a segment: not for a loop that
// serves sockets. Follows docs/formats/tlog.md.
#pragma once

#include <chrono>
#include <optional>

#include "mavloom/record/tlog_writer.hpp"

namespace mavloom::record {

struct Rotation {
    std::uint64_t bytes = 0;           // a segment is never larger, unless a single record is; 0: no bound
    std::chrono::nanoseconds every{};  // 0: no bound
    [[nodiscard]] bool rotates() const noexcept { return bytes != 0 || every != std::chrono::nanoseconds{}; }
};

class RotatingWriter {
public:
    // Without rotation writes exactly `path`, as TlogWriter does. With it, each segment is `path`'s stem plus the UTC time of its first frame,
    // flight-20231114T221320.000Z.tlog, the first one opened by the first frame; a name that is taken gets _2, _3, ... A folder that cannot be
    // written, and rotation of a device or FIFO, are errors here.
    [[nodiscard]] static SetupResult<RotatingWriter> create(const std::filesystem::path& path, Rotation rotation = {});

    // TlogWriter::make_room of the segment that is open.
    [[nodiscard]] SetupResult<void> make_room(const wire::FrameView& frame);
    // Whether this error of `make_room` ends when somebody makes room on the disk: not so of devices and pipes.
    [[nodiscard]] bool is_full_disk(const SetupError& error) const noexcept;
    // An error means that records are lost, as `lost_records` counts them: this one (TlogWriter::write; a new segment that cannot be opened), or
    // the last of the segment behind us, which could not be closed.
    [[nodiscard]] SetupResult<void> write(WallTime time, const wire::FrameView& frame);
    // A record that the caller no longer tries to write: one more of `lost_records`.
    void give_up() noexcept { ++refused_; }
    [[nodiscard]] SetupResult<void> flush();
    [[nodiscard]] SetupResult<void> close();

    // As it was given to `create`.
    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
    // The file that is written; empty before the first segment.
    [[nodiscard]] std::filesystem::path segment_path() const;
    // Where an existing file went; empty if there was none.
    [[nodiscard]] std::filesystem::path renamed_to() const;
    [[nodiscard]] std::uint64_t segments() const noexcept { return segments_; }
    // Of all segments. Taken: written, buffered, or lost after all because the disk stayed full.
    [[nodiscard]] std::uint64_t taken_records() const noexcept;
    [[nodiscard]] std::uint64_t written_records() const noexcept;
    [[nodiscard]] std::uint64_t written_bytes() const noexcept;
    // Records that are in no file: refused by `write`, given up, or still buffered when their segment was closed.
    [[nodiscard]] std::uint64_t lost_records() const noexcept;

private:
    RotatingWriter(std::filesystem::path path, Rotation rotation) : path_(std::move(path)), rotation_(rotation) {}

    // Whether what waits for the current file finds no room on the disk.
    [[nodiscard]] bool is_disk_full();
    [[nodiscard]] bool is_due(WallTime time, std::size_t record_bytes) const noexcept;
    [[nodiscard]] SetupResult<void> go_on_in(TlogWriter next);
    [[nodiscard]] std::filesystem::path free_name(WallTime time) const;

    std::filesystem::path path_;
    Rotation rotation_;
    std::optional<TlogWriter> writer_;
    WallTime begin_{};  // of the segment: its first frame's time
    std::uint64_t segments_ = 0;
    struct Sums {
        std::uint64_t taken = 0, written = 0, bytes = 0;
    } before_;  // of the segments before
    std::uint64_t refused_ = 0;
    bool closed_ = false;  // what the last segment still buffers is lost
};

}  // namespace mavloom::record
