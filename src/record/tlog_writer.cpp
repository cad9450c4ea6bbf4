// SPDX-License-Identifier: MIT
#include "mavloom/record/tlog_writer.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>
#include <vector>

#include "record/tlog_format.hpp"

namespace mavloom::record {

namespace {

namespace fs = std::filesystem;

// Renames without replacing an existing file. Returns 0 or an errno value. If the file system has no RENAME_NOREPLACE,
// it checks first and then renames.
int rename_to_free_name(const fs::path& from, const fs::path& to) {
    if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return 0;
    if (errno != EINVAL && errno != ENOSYS) return errno;
    struct stat status {};
    if (::lstat(to.c_str(), &status) == 0) return EEXIST;
    return ::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

SetupResult<fs::path> move_away(const fs::path& path) {
    constexpr int max_old_files = 9999;
    for (int n = 1; n <= max_old_files; ++n) {
        const fs::path old = fmt::format("{}.{}", path.string(), n);
        const int error = rename_to_free_name(path, old);
        if (error == 0) return old;
        if (error != EEXIST)
            return system_error(fmt::format("cannot rename the existing {} to {}", path.string(), old.string()), error);
    }
    return setup_error(SetupCode::in_use,
                       fmt::format("{} exists, and so do {}.1 to {}.{}: move some of them to another folder",
                                   path.string(), path.string(), path.string(), max_old_files));
}

// A name that was mistyped must not move away a file that something else needs.
SetupResult<void> check_is_recording(const fs::path& path) {
    auto file = File::open_to_read(path);
    if (!file) return tl::unexpected(std::move(file.error()));
    if (!file->is_regular())
        return setup_error(SetupCode::in_use,
                           fmt::format("{} is a device or FIFO, not a recording: remove it", path.string()));
    std::vector<std::uint8_t> first(recording_bytes);
    const auto count = file->read(first);
    if (!count) return tl::unexpected(count.error());
    if (begins_recording(ByteView(first).first(*count))) return {};
    return setup_error(SetupCode::in_use,
                       fmt::format("{} exists and is not a tlog recording, so it is left alone: choose "
                                   "another name, or move the file away",
                                   path.string()));
}

std::uint64_t time_on_file(WallTime time) noexcept {
    return static_cast<std::uint64_t>(
        std::clamp<std::int64_t>(unix_us(time), 0, static_cast<std::int64_t>(time_limit_us) - 1));
}

}  // namespace

TlogWriter::TlogWriter(File file, fs::path renamed_to, std::size_t buffer_bytes)
    : file_(std::move(file)),
      renamed_to_(std::move(renamed_to)),
      buffer_(std::make_unique<std::uint8_t[]>(buffer_bytes)),
      capacity_(buffer_bytes) {}

SetupResult<TlogWriter> TlogWriter::create(const fs::path& path, std::size_t buffer_bytes) {
    buffer_bytes = std::max(buffer_bytes, max_record_length);
    struct stat status {};
    const bool leads_somewhere = ::stat(path.c_str(), &status) == 0;
    if (leads_somewhere && !S_ISREG(status.st_mode)) {
        if (S_ISBLK(status.st_mode))
            return setup_error(SetupCode::usage, fmt::format("{} is a disk: give the name of a file", path.string()));
        auto device = File::open_to_write(path);
        if (!device) return tl::unexpected(std::move(device.error()));
        return TlogWriter(std::move(*device), {}, buffer_bytes);
    }
    return create_file(path, buffer_bytes);
}

SetupResult<TlogWriter> TlogWriter::create_file(const fs::path& path, std::size_t buffer_bytes) {
    buffer_bytes = std::max(buffer_bytes, max_record_length);
    struct stat status {};
    fs::path old;
    if (::lstat(path.c_str(), &status) == 0) {
        if (auto checked = check_is_recording(path); !checked) return tl::unexpected(std::move(checked.error()));
        auto moved = move_away(path);
        if (!moved) return tl::unexpected(std::move(moved.error()));
        old = std::move(*moved);
    }
    auto file = File::create(path);
    if (!file) return tl::unexpected(std::move(file.error()));
    return TlogWriter(std::move(*file), std::move(old), buffer_bytes);
}

TlogWriter::~TlogWriter() {
    if (file_.is_open() && used_ != 0) (void)flush();
}

SetupResult<void> TlogWriter::make_room(const wire::FrameView& frame) {
    return has_room(frame) ? SetupResult<void>{} : flush();
}

bool TlogWriter::has_room(const wire::FrameView& frame) const noexcept {
    assert(used_ <= capacity_);
    return time_length + frame.size() <= capacity_ - used_;
}

// A record of which `from` has written only a part moves too, as a whole.
void TlogWriter::take_buffered(TlogWriter& from) noexcept {
    std::swap(buffer_, from.buffer_);
    std::swap(capacity_, from.capacity_);
    used_ = std::exchange(from.used_, 0);
    from.half_ = 0;
    records_ = from.records_ - from.written_records_;
    from.records_ = from.written_records_;
}

WallTime TlogWriter::first_buffered_time() const noexcept {
    assert(used_ >= time_length);
    return wall_from_us(load_be64(buffer_.get()));
}

SetupResult<void> TlogWriter::write(WallTime time, const wire::FrameView& frame) {
    const std::size_t length = time_length + frame.size();
    if (auto done = make_room(frame); !done) return done;
    assert(length <= capacity_ - used_);
    std::uint8_t* record = buffer_.get() + used_;
    store_be64(record, time_on_file(time));
    std::memcpy(record + time_length, frame.bytes().data(), frame.size());
    used_ += length;
    ++records_;
    return {};
}

SetupResult<void> TlogWriter::flush() {
    if (used_ == half_) return {};
    return keep_whole_records(file_.write({buffer_.get() + half_, used_ - half_}));
}

// After a write, drops the records that are in the file from the buffer. After an error, truncates a regular file to
// the last whole record.
SetupResult<void> TlogWriter::keep_whole_records(File::Written result) {
    const std::size_t taken = half_ + result.bytes;
    assert(taken <= used_);
    std::size_t whole = 0;
    while (whole < taken) {
        const std::size_t next = record_length({buffer_.get() + whole, used_ - whole});
        if (next == 0 || whole + next > taken) break;
        whole += next;
        ++written_records_;
    }
    written_ += whole;
    used_ -= whole;
    std::memmove(buffer_.get(), buffer_.get() + whole, used_);
    half_ = taken - whole;
    assert(half_ < max_record_length && written_records_ <= records_);
    if (result.error == 0) return {};
    if (half_ != 0 && file_.is_regular()) {
        if (auto cut = file_.truncate(written_); !cut) return cut;
        half_ = 0;
    }
    return file_.failed("write", result.error);
}

SetupResult<void> TlogWriter::close() {
    auto flushed = flush();
    if (!file_.is_open()) return flushed;
    auto closed = file_.sync_and_close();
    return flushed ? closed : flushed;
}

}  // namespace mavloom::record
