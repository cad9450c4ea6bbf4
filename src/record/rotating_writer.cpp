// SPDX-License-Identifier: MIT
#include "mavloom/record/rotating_writer.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <ctime>

namespace mavloom::record {

namespace {

namespace fs = std::filesystem;

// Checks the folder at once, because the first frame may arrive hours later.
SetupResult<void> check_place(const fs::path& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode))
        return setup_error(SetupCode::usage,
                           fmt::format("{} is not a regular file, so it cannot be rotated", path.string()));
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (::stat(folder.c_str(), &status) != 0 || ::access(folder.c_str(), W_OK | X_OK) != 0)
        return system_error(fmt::format("cannot create files in {}", folder.string()), errno);
    if (!S_ISDIR(status.st_mode))
        return system_error(fmt::format("cannot create files in {}", folder.string()), ENOTDIR);
    return {};
}

// For example 20231114T221320.000Z. The names sort in the order of the times.
std::string name_of(WallTime time) {
    constexpr std::int64_t latest_ms = static_cast<std::int64_t>(time_limit_us / 1000) - 1;
    const auto ms = std::clamp<std::int64_t>(unix_us(time) / 1000, 0, latest_ms);
    const std::time_t seconds = ms / 1000;
    std::tm utc{};
    ::gmtime_r(&seconds, &utc);
    return fmt::format("{:04}{:02}{:02}T{:02}{:02}{:02}.{:03}Z", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday,
                       utc.tm_hour, utc.tm_min, utc.tm_sec, ms % 1000);
}

bool is_taken(const fs::path& path) {
    struct stat status {};
    return ::lstat(path.c_str(), &status) == 0;
}

}  // namespace

SetupResult<RotatingWriter> RotatingWriter::create(const fs::path& path, Rotation rotation) {
    RotatingWriter all(path, rotation);
    if (rotation.rotates()) {
        if (auto checked = check_place(path); !checked) return tl::unexpected(std::move(checked.error()));
        return all;
    }
    auto writer = TlogWriter::create(path);
    if (!writer) return tl::unexpected(std::move(writer.error()));
    all.writer_.emplace(std::move(*writer));
    all.segments_ = 1;
    return all;
}

bool RotatingWriter::begins_segment(WallTime time, const wire::FrameView& frame) const noexcept {
    if (!rotation_.rotates()) return false;
    if (!writer_) return true;
    const std::uint64_t size = writer_->size() + time_length + frame.size();
    if (rotation_.bytes != 0 && writer_->records() != 0 && size > rotation_.bytes) return true;
    return rotation_.every != Nanoseconds{} && time > begin_ && time - begin_ >= rotation_.every;
}

// Without rotation, a file may have taken the path itself; the recording then continues beside it.
fs::path RotatingWriter::free_name(WallTime time) const {
    auto stem = path_.stem().string();
    if (rotation_.rotates()) stem.append("-").append(name_of(time));
    const auto extension = path_.extension().string();
    auto name = path_;
    name.replace_filename(stem + extension);
    for (int n = 2; is_taken(name); ++n) name.replace_filename(fmt::format("{}_{}{}", stem, n, extension));
    return name;
}

SetupResult<void> RotatingWriter::end_segment() {
    if (!writer_) return {};
    auto closed = writer_->close();
    before_.taken += writer_->records();
    before_.written += writer_->written_records();
    before_.bytes += writer_->written_bytes();
    writer_.reset();
    return closed;
}

SetupResult<void> RotatingWriter::continue_in(TlogWriter next) {
    auto closed = end_segment();
    writer_.emplace(std::move(next));
    ++segments_;
    return closed;
}

SetupResult<fs::path> RotatingWriter::maintain(MonoTime now) {
    if (!left_.empty()) return std::exchange(left_, {});
    constexpr std::chrono::milliseconds check_interval{500};
    if (now < check_due_) return {};
    check_due_ = now + check_interval;
    auto removed = is_removed() ? segment_path() : fs::path{};
    if (removed.empty()) no_file_.reset();
    auto done = removed.empty() ? flush() : begin_again();
    if (!done) return tl::unexpected(std::move(done.error()));
    return removed;
}

bool RotatingWriter::is_removed() const noexcept { return writer_ && writer_->is_file() && !writer_->is_named(); }
bool RotatingWriter::is_deleted() const noexcept { return is_removed() && !writer_->is_linked(); }

SetupResult<void> RotatingWriter::leave_deleted() {
    if (!is_deleted()) return {};
    auto deleted = segment_path();
    auto begun = begin_again();
    if (begun) left_ = std::move(deleted);
    return begun;
}

SetupResult<void> RotatingWriter::begin_again() {
    const bool is_empty = writer_->buffered_bytes() == 0, was_deleted = is_deleted();
    if (was_deleted) writer_->let_go();  // the new file may need its space
    if (rotation_.rotates() && is_empty) return end_segment();
    const auto begin = is_empty ? begin_ : writer_->first_buffered_time();
    auto next = TlogWriter::create_file(free_name(begin));
    if (!next) {
        if (was_deleted) no_file_ = next.error();
        return tl::unexpected(std::move(next.error()));
    }
    no_file_.reset();
    next->take_buffered(*writer_);
    return begin_segment(std::move(*next), begin);
}

SetupResult<void> RotatingWriter::write(WallTime time, const wire::FrameView& frame) {
    auto taken = make_room(time, frame);
    if (taken) taken = writer_->write(time, frame);
    if (taken) return std::exchange(closed_segment_, {});
    ++refused_;
    return taken;
}

SetupResult<void> RotatingWriter::begin_segment(TlogWriter next, WallTime time) {
    begin_ = time;
    return continue_in(std::move(next));
}

// The new segment is opened before the old one is closed, so if it cannot be opened, nothing has changed.
SetupResult<void> RotatingWriter::make_room(WallTime time, const wire::FrameView& frame) {
    if (no_file_) return writer_->has_room(frame) ? SetupResult<void>{} : tl::unexpected(*no_file_);
    if (begins_segment(time, frame) || !writer_->has_room(frame))
        if (auto left = leave_deleted(); !left) return left;
    if (!begins_segment(time, frame)) return writer_->make_room(frame);
    auto flushed = flush();
    if (!flushed && can_retry(flushed.error())) return flushed;  // after any other error, a new segment may help
    auto next = TlogWriter::create_file(free_name(time));
    if (!next) return tl::unexpected(std::move(next.error()));
    closed_segment_ = begin_segment(std::move(*next), time);
    return {};
}

bool RotatingWriter::can_retry(const SetupError& error) const noexcept {
    if (closed_) return false;
    if (!writer_) return rotation_.rotates();
    const bool is_full_disk = error.sys_errno == ENOSPC || error.sys_errno == EDQUOT;
    return no_file_ || (is_full_disk && writer_->is_file());
}

SetupResult<void> RotatingWriter::flush() {
    if (no_file_) return tl::unexpected(*no_file_);
    if (!writer_ || is_deleted()) return {};  // maintain() begins a new file for what is buffered
    return writer_->flush();
}

SetupResult<fs::path> RotatingWriter::close() {
    auto done = std::exchange(closed_, true) ? SetupResult<void>{} : leave_at_the_end();
    if (done && writer_) done = writer_->close();
    if (!done) return tl::unexpected(std::move(done.error()));
    return std::exchange(left_, {});
}

// If there is no place for a new file, a file that was only renamed takes the last records.
SetupResult<void> RotatingWriter::leave_at_the_end() {
    if (!is_removed()) return {};
    auto removed = segment_path();
    auto left = writer_->buffered_bytes() == 0 ? end_segment() : begin_again();
    if (left) left_ = std::move(removed);
    return no_file_ || !writer_ ? left : SetupResult<void>{};
}

fs::path RotatingWriter::segment_path() const { return writer_ ? writer_->path() : fs::path{}; }
fs::path RotatingWriter::renamed_to() const { return writer_ ? writer_->renamed_to() : fs::path{}; }

std::uint64_t RotatingWriter::taken_records() const noexcept {
    return before_.taken + (writer_ ? writer_->records() : 0);
}

std::uint64_t RotatingWriter::written_records() const noexcept {
    return before_.written + (writer_ ? writer_->written_records() : 0);
}

std::uint64_t RotatingWriter::lost_records() const noexcept {
    const std::uint64_t buffered = closed_ || !writer_ ? 0 : writer_->records() - writer_->written_records();
    return refused_ + taken_records() - written_records() - buffered;
}

std::uint64_t RotatingWriter::written_bytes() const noexcept {
    return before_.bytes + (writer_ ? writer_->written_bytes() : 0);
}

std::string RotatingWriter::removal_notice(const fs::path& removed) const {
    const auto next = segment_path();
    if (closed_ && next.empty()) return removed.string() + " was removed or replaced before it was complete";
    const bool has_another_name = !next.empty() && next != removed;
    return fmt::format("{} was removed or replaced; a new file begins{}", removed.string(),
                       has_another_name ? ": " + next.string() : "");
}

}  // namespace mavloom::record
