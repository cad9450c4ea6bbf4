// SPDX-License-Identifier: MIT
#include "record/tlog_format.hpp"

#include <algorithm>

#include "mavloom/wire/frame_checksum.hpp"

namespace mavloom::record {

namespace {

bool has_plausible_time(ByteView bytes) noexcept {
    return bytes.size() >= time_length && load_be64(bytes.data()) < time_limit_us;
}

// Whether the checksum is good. For an id without definition, whether some CRC_EXTRA would make it good, which 1 in 256
// random checksums passes. `readable` is the number of readable bytes from the start of the frame.
bool is_possible(const wire::FrameView& frame, std::size_t readable, const wire::MessageInfo* info) noexcept {
    if (info == nullptr) return wire::crc_extra_of(frame) >= 0;
    const auto covered = frame.bytes().subspan(1, frame.header_length() - 1 + frame.payload_length());
    return wire::crc_agrees(covered, readable - 1, info->crc_extra, frame.checksum());
}

// Whether `rest`, the bytes after a frame of unknown id, is empty or looks like another record. The end of the file may
// cut that record off.
bool continues(ByteView rest, const wire::MessageTable& table) noexcept {
    if (rest.empty()) return true;
    if (rest.size() <= time_length) return rest.front() == 0;  // the highest byte of any plausible time
    if (!has_plausible_time(rest) || !wire::is_start(rest[time_length])) return false;
    const auto length = wire::frame_length(rest.subspan(time_length));
    if (length == 0 || time_length + length > rest.size()) return true;
    const auto frame = wire::FrameView::unchecked(rest.subspan(time_length, length));
    return is_possible(frame, rest.size() - time_length, table.find(frame.id()));
}

}  // namespace

std::size_t record_length(ByteView bytes) noexcept {
    if (bytes.size() < min_record_length) return 0;
    const auto length = wire::frame_length(bytes.subspan(time_length));
    return length == 0 || time_length + length > bytes.size() ? 0 : time_length + length;
}

namespace {

// Whether a record may begin here. A file may end inside it.
bool looks_like_record(ByteView rest) noexcept {
    if (rest.size() <= time_length) return rest.empty() || rest.front() == 0;
    return has_plausible_time(rest) && wire::is_start(rest[time_length]);
}

// The length that the record here claims, which may go beyond `rest`; 0 if none begins here.
std::size_t claimed_length(ByteView rest) noexcept {
    if (!looks_like_record(rest)) return 0;
    if (rest.size() < time_length + 3) return max_record_length;  // the length is cut off
    return time_length + wire::frame_length(rest.subspan(time_length));
}

}  // namespace

bool begins_recording(ByteView first_bytes) noexcept {
    if (first_bytes.empty() || claimed_length(first_bytes) >= first_bytes.size()) return true;
    for (auto rest = first_bytes; rest.size() >= min_record_length; rest = rest.subspan(1)) {
        const auto length = claimed_length(rest);
        if (length != 0 && length < rest.size() && looks_like_record(rest.subspan(length))) return true;
    }
    return std::ranges::all_of(first_bytes, [](auto byte) { return byte == 0; });
}

Found examine_record(ByteView bytes, const wire::MessageTable& table) noexcept {
    if (!has_plausible_time(bytes)) return {};
    const auto size = record_length(bytes);
    if (size == 0) return {};
    const auto frame = wire::FrameView::unchecked(bytes.subspan(time_length, size - time_length));
    const auto* info = table.find(frame.id());
    if (!is_possible(frame, bytes.size() - time_length, info)) return {};
    if (info == nullptr && !continues(bytes.subspan(size), table)) return {};
    const bool flagged = (frame.incompat_flags() & ~wire::incompat_signed) != 0;
    return {flagged ? Found::Kind::unknown_flags : Found::Kind::record, size, info};
}

std::size_t skip_startless(ByteView bytes) noexcept {
    if (bytes.size() <= time_length) return 0;
    const auto starts = bytes.subspan(time_length);
    // The highest byte of any plausible time is 0.
    const auto may_begin = [&](std::size_t i) {
        const bool zero = bytes[i] == 0, start = wire::is_start(starts[i]);
        return zero && start;
    };
    constexpr std::size_t block = 64;  // tested without branches, so that compilers can vectorize the loop
    std::size_t at = 0;
    for (; at + block <= starts.size(); at += block) {
        bool any = false;
        for (std::size_t i = 0; i < block; ++i) any |= may_begin(at + i);
        if (any) break;
    }
    while (at < starts.size() && !may_begin(at)) ++at;
    return at;
}

}  // namespace mavloom::record
