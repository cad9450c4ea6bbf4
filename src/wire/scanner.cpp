// SPDX-License-Identifier: MIT
#include "mavloom/wire/detail/scanner.hpp"

namespace mavloom::wire::detail {

// Judges a candidate frame whose id has no definition. Once the CRC_EXTRA of the source is confirmed, the checksum
// alone decides. Before that, the surrounding bytes must fit:
// - In a datagram, the frame must end where the datagram ends or where another frame starts.
// - In a stream, the frame must follow a valid frame, and a start byte or silence must follow it.
Scanner::Candidate Scanner::examine_unknown(const FrameView& frame, ByteView behind, End end) noexcept {
    using Kind = Candidate::Kind;
    if ((frame.incompat_flags() & ~incompat_signed) != 0) return {};
    const auto verdict = unknown_.judge(frame);
    if (verdict != UnknownIds::Verdict::confirmed && end == End::open && behind.empty())
        return {Kind::incomplete, 0, nullptr};
    if (verdict == UnknownIds::Verdict::possible) {
        const bool plausible = (behind.empty() || is_start(behind[0])) && (in_sync_ || end == End::closed);
        if (!plausible) {
            counters_.implausible_unknown.add();
            return {};
        }
    }
    // Learn from a mismatching checksum only if the surrounding bytes fit, so that noise cannot replace a confirmed
    // byte.
    if (verdict == UnknownIds::Verdict::impossible && !(behind.empty() || is_start(behind[0])))
        return {Kind::bad_checksum, frame.size(), nullptr};
    if (!unknown_.learn(frame)) return {Kind::bad_checksum, frame.size(), nullptr};
    counters_.unknown_ids.add();
    return {Kind::frame, frame.size(), nullptr};
}

bool Scanner::holds_known_frame(ByteView bytes) const noexcept {
    for (std::size_t at = 0; at + min_frame_length <= bytes.size(); ++at) {
        if (!is_start(bytes[at])) continue;
        const std::size_t length = frame_length(bytes.data() + at, bytes.size() - at);
        if (length > bytes.size() - at) continue;
        const auto frame = FrameView::unchecked(bytes.subspan(at, length));
        const MessageInfo* info = table_->find(frame.id());
        if (info != nullptr && checksum_agrees(frame, bytes.size() - at, *info)) return true;
    }
    return false;
}

}  // namespace mavloom::wire::detail
