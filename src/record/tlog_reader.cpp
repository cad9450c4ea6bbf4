// SPDX-License-Identifier: MIT
#include "mavloom/record/tlog_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <cstring>

#include "record/foreign_file.hpp"
#include "record/tlog_format.hpp"

namespace mavloom::record {

namespace {

// Pipes and devices are not checked: their bytes cannot be read twice.
SetupResult<void> refuse_foreign(File& file, const wire::MessageTable& table) {
    if (!file.is_regular()) return {};
    std::array<std::uint8_t, foreign_format_bytes> first{};
    const auto got = file.read(first);
    if (!got) return tl::unexpected(got.error());
    if (const auto format = foreign_format(ByteView(first).first(*got), table))
        return setup_error(SetupCode::bad_input,
                           fmt::format("{} is {}, not a tlog: {}", file.path().string(), format->name, format->advice));
    return file.seek(0);
}

}  // namespace

TlogReader::TlogReader(File file, std::uint64_t size, const wire::MessageTable& table)
    : file_(std::move(file)),
      table_(&table),
      buffer_(std::make_unique_for_overwrite<std::uint8_t[]>(buffer_length)),
      size_(size) {}

SetupResult<TlogReader> TlogReader::open(const std::filesystem::path& path, const wire::MessageTable& table,
                                         File::Empty empty) {
    auto file = File::open_to_read(path, empty);
    if (!file) return tl::unexpected(std::move(file.error()));
    const auto size = file->is_regular() ? file->size() : std::uint64_t{0};
    if (!size) return tl::unexpected(size.error());
    if (const auto foreign = refuse_foreign(*file, table); !foreign) return tl::unexpected(foreign.error());
    return TlogReader(std::move(*file), *size, table);
}

TlogReader::Stop TlogReader::read_failed(SetupError error) {
    error_ = std::move(error);
    at_end_ = true;
    begin_ = end_;
    return Stop::failed;
}

SetupError TlogReader::no_record_error() const {
    return {SetupCode::bad_input, 0,
            fmt::format("{} is not a tlog: none of its {}{} bytes begins a MAVLink record", file_.path().string(),
                        position() < size_ ? "first " : "", position())};
}

// Whether more bytes are needed to judge the record at the front. The writer of a pipe may be slow, so there a whole
// frame of known id is enough.
bool TlogReader::needs_more() const noexcept {
    if (at_end_ || end_ - begin_ >= look_ahead) return false;
    return file_.is_regular() || examine_record(unread(), *table_).info == nullptr;
}

// Moves the unread bytes to the front of the buffer and reads more. Returns nothing on success.
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
    assert(begin_ <= end_ && end_ <= buffer_length);
    if (at_end_ && base_ + end_ < size_)
        return read_failed(SetupError{SetupCode::bad_input, 0,
                                      fmt::format("{} was shortened while it was read: {} of {} bytes are left",
                                                  file_.path().string(), base_ + end_, size_)});
    return std::nullopt;
}

void TlogReader::lose(std::size_t bytes) noexcept {
    if (bytes == 0) return;
    if (lost_run_ == 0) counters_.damaged_places.add();
    assert(bytes <= end_ - begin_);
    lost_run_ += bytes;
    counters_.lost_bytes.add(bytes);
    begin_ += bytes;
}

// Returns the record at the front. It is constructed in place, because copying what was just written stalls the
// processor.
Result<Record, TlogReader::Stop> TlogReader::take(std::size_t size, const wire::MessageInfo* info) noexcept {
    assert(size >= min_record_length && size <= unread().size());
    const ByteView bytes = unread().first(size);
    const std::uint64_t offset = position();
    begin_ += size;
    counters_.records.add();
    counters_.record_bytes.add(size);
    if (info == nullptr) counters_.unknown_ids.add();
    return Result<Record, Stop>(tl::in_place, wall_from_us(load_be64(bytes.data())),
                                wire::FrameView::unchecked(bytes.subspan(time_length)), info, offset,
                                std::exchange(lost_run_, 0));
}

Result<Record, TlogReader::Stop> TlogReader::next(std::uint64_t max_damage) {
    if (error_) return tl::unexpected(Stop::failed);
    for (const std::uint64_t begin = position(); position() - begin < max_damage;) {
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
        if (found.kind == Found::Kind::unknown_flags) [[unlikely]] {
            begin_ += found.size;
            lost_run_ = 0;
            counters_.unknown_flags.add();
            counters_.flagged_bytes.add(found.size);
            continue;
        }
        return take(found.size, found.info);
    }
    return tl::unexpected(Stop::damage);
}

// Skips records while each one joins the next and lies within the buffer. Returns the size of the record that is then
// at the front if it is an intact record of this id, else 0.
std::size_t TlogReader::pass_over_to(MessageId id) noexcept {
    std::uint64_t records = 0;
    std::size_t at = begin_, found = 0;
    std::uint64_t time_us = end_ - at < look_ahead ? 0 : load_be64(buffer_.get() + at);
    while (end_ - at >= look_ahead) {
        const auto* const record = buffer_.get() + at;
        const auto joined = joined_record(record, time_us, *table_);
        const bool wanted = joined.id == id && joined.length != 0;
        if (joined.length == 0 || (wanted && examine_record({record, end_ - at}, *table_).kind != Found::Kind::record)) {
            examine_until_ = base_ + at + 1;
            return 0;
        }
        if (wanted) {
            found = joined.length;
            break;
        }
        time_us = joined.time_us;
        at += joined.length;
        ++records;
    }
    counters_.records.add(records);
    counters_.record_bytes.add(at - begin_);
    begin_ = at;
    return found;
}

Result<Record, TlogReader::Stop> TlogReader::next_of(MessageId id, std::uint64_t max_bytes) {
    for (const std::uint64_t begin = position(); position() - begin < max_bytes;) {
        if (lost_run_ == 0 && position() >= examine_until_)
            if (const auto size = pass_over_to(id)) return take(size, table_->find(id));
        auto record = next(max_bytes);
        if (!record || record->frame.id() == id) return record;
    }
    return tl::unexpected(Stop::damage);
}

SetupResult<void> TlogReader::seek(std::uint64_t offset) {
    if (auto done = file_.seek(offset); !done) return done;
    base_ = offset;
    begin_ = end_ = 0;
    lost_run_ = 0;
    at_end_ = false;
    examine_until_ = 0;
    error_.reset();
    return {};
}

}  // namespace mavloom::record
