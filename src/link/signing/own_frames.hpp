// SPDX-License-Identifier: MIT
// Recognises frames that this process signed and that another program sends back to it. Without this check, a sender
// that does not have the key would pass as one that has it.
//
// A frame with one of our link ids counts as ours in two cases: SignatureMarks remembers its signature, or its time is
// not newer than the newest one that SignatureMarks has dropped for it. So frames of another program with the same key
// and link id are accepted, unless its clock is far behind ours.
//
// Private to module link; single owner thread; allocates only in `sign_as`.
#pragma once

#include <algorithm>
#include <bitset>
#include <cstdint>

#include "link/signing/signature_marks.hpp"
#include "mavloom/wire/signing.hpp"

namespace mavloom::link::detail {

class OwnFrames {
public:
    // From now on, frames are signed with this link id.
    void sign_as(std::uint8_t link_id) {
        ids_.set(link_id);
        marks_.start();
    }
    // Earlier runs of the program signed frames up to this time. So all frames up to then with our link ids are ours.
    void treat_as_own_until(wire::SigningTime time) noexcept { earlier_ = std::max(earlier_, time.ticks); }

    // `frame` is signed, with a link id given to `sign_as`.
    void note(const wire::FrameView& frame) noexcept { marks_.note(frame); }
    // True if this process signed the frame. The result has a meaning only if the frame's signature is good.
    [[nodiscard]] bool has(const wire::FrameView& frame) const noexcept {
        if (!ids_.test(frame.signature()[0])) return false;
        const std::uint64_t time = wire::Verifier::stream_of(frame).last.ticks;
        return time <= earlier_ || marks_.may_have_had(frame);
    }

private:
    std::bitset<256> ids_;
    std::uint64_t earlier_ = 0;
    SignatureMarks marks_;
};

}  // namespace mavloom::link::detail
