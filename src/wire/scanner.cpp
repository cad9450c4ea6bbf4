// SPDX-License-Identifier: MIT
#include "mavloom/wire/detail/scanner.hpp"

namespace mavloom::wire::detail {

// routing.md 5.4: a datagram's frame must end where the datagram or another frame does; a stream's must follow a good frame and be followed
// by a start byte or by silence. Once the source's CRC_EXTRA is learned the checksum alone decides.
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
    // A disagreeing checksum is shown to the memory only where the surroundings are right, so that noise cannot unlearn a byte.
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
