// SPDX-License-Identifier: MIT
#include "mavloom/record/tlog_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "record/tlog_format.hpp"

namespace mavloom::record {

TlogReader::TlogReader(File file, std::uint64_t size, const wire::MessageTable& table)
    : file_(std::move(file)), table_(&table), buffer_(std::make_unique<std::uint8_t[]>(buffer_length)), size_(size) {}

SetupResult<TlogReader> TlogReader::open(const std::filesystem::path& path, const wire::MessageTable& table,
                                         File::Empty empty) {
    auto file = File::open_to_read(path, empty);
    if (!file) return tl::unexpected(std::move(file.error()));
    const auto size = file->is_regular() ? file->size() : std::uint64_t{0};
    if (!size) return tl::unexpected(size.error());
    return TlogReader(std::move(*file), *size, table);
}

TlogReader::Stop TlogReader::read_failed(SetupError error) {
    error_ = std::move(error);
    at_end_ = true;
    begin_ = end_;
    return Stop::failed;
}

// Whether the record at the front cannot be judged yet. A writer at the other end of a pipe may be slow: a frame of known id needs nothing behind it.
bool TlogReader::needs_more() const noexcept {
    if (at_end_ || end_ - begin_ >= look_ahead) return false;
    return file_.is_regular() || examine_record(unread(), *table_).info == nullptr;
}

// Moves what is unread to the front and reads on. Empty when that went well.
std::optional<TlogReader::Stop> TlogReader::fill() {
    std::memmove(buffer_.get(), buffer_.get() + begin_, end_ - begin_);
    base_ += begin_;
    end_ -= begin_;
    begin_ = 0;
    const auto got = file_.read({buffer_.get() + end_, buffer_length - end_});
    if (!got && (got.error().sys_errno == EINTR || got.error().sys_errno == EAGAIN)) return Stop::nothing_yet;
    if (!got) return read_failed(got.error());
    at_end_ = file_.is_regular() ? *got < buffer_length - end_ : *got == 0;
    end_ += *got;
    if (at_end_ && base_ + end_ < size_)
        return read_failed(SetupError{SetupCode::bad_input, 0,
                                      fmt::format("{} was shortened while it was read: {} of {} bytes are left",
                                                  file_.path().string(), base_ + end_, size_)});
    return std::nullopt;
}

void TlogReader::lose(std::size_t bytes) noexcept {
    if (bytes == 0) return;
    if (lost_run_ == 0) counters_.damaged_places.add();
    lost_run_ += bytes;
    counters_.lost_bytes.add(bytes);
    begin_ += bytes;
}

Result<Record, TlogReader::Stop> TlogReader::next(std::uint64_t most_damage) {
    if (error_) return tl::unexpected(Stop::failed);
    for (const std::uint64_t begin = position(); position() - begin < most_damage;) {
        if (needs_more()) [[unlikely]] {
            if (const auto stop = fill()) return tl::unexpected(*stop);
            continue;
        }
        if (begin_ == end_) return tl::unexpected(Stop::end);
        const auto found = examine_record(unread(), *table_);
        if (found.kind == Found::Kind::nothing) [[unlikely]] {
            lose(1);
            lose(skip_startless(unread()));
            if (at_end_ && end_ - begin_ < min_record_length) lose(end_ - begin_);
            continue;
        }
        const ByteView bytes = unread().first(found.size);
        const std::uint64_t offset = position();
        begin_ += found.size;
        const std::uint64_t lost = std::exchange(lost_run_, 0);
        if (found.kind == Found::Kind::unknown_flags) [[unlikely]] {
            counters_.unknown_flags.add();
            counters_.flagged_bytes.add(found.size);
            continue;
        }
        counters_.records.add();
        counters_.record_bytes.add(found.size);
        if (found.info == nullptr) counters_.unknown_ids.add();
        return Record{wall_from_us(load_be64(bytes.data())), wire::FrameView::unchecked(bytes.subspan(time_length)),
                      found.info, offset, lost};
    }
    return tl::unexpected(Stop::damage);
}

SetupResult<void> TlogReader::seek(std::uint64_t offset) {
    if (auto done = file_.seek(offset); !done) return done;
    base_ = offset;
    begin_ = end_ = 0;
    lost_run_ = 0;
    at_end_ = false;
    error_.reset();
    return {};
}

}  // namespace mavloom::record
