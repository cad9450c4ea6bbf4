// SPDX-License-Identifier: MIT
// Recognises signed frames that the process has heard before, on any of its endpoints. An attacker without the key can
// read such a frame and replay it.
//
// The class remembers the signatures of the frames of the last 0.6 to 1.8 s (LateFrames), up to about 65,000. It
// refuses older frames of the same sender as too late, without remembering them. Replays of old frames therefore cannot
// evict new ones.
//
// Private to module link; single owner thread; allocates only for a new sender.
#pragma once

#include <algorithm>
#include <unordered_map>

#include "link/signing/late_frames.hpp"
#include "link/signing/signature_marks.hpp"
#include "mavloom/base/clock.hpp"
#include "mavloom/wire/signing.hpp"

namespace mavloom::link::detail {

class HeardFrames {
public:
    // Before this call, no frame counts as repeated.
    void start() { marks_.start(); }
    [[nodiscard]] bool is_started() const noexcept { return marks_.is_started(); }

    enum class Verdict : std::uint8_t { is_new, repeated, too_late };

    // Remembers the frame, whose signature is good. `refused_until`: if the sender was not heard yet, frames with this
    // timestamp or an older one are too late.
    [[nodiscard]] Verdict hear(const wire::FrameView& frame, MonoTime now, wire::SigningTime refused_until = {}) {
        const auto [sender, time] = wire::Verifier::stream_of(frame);
        // Only a holder of the key can sign for so many senders.
        if (newest_.size() == most_senders && !newest_.contains(sender)) forget_senders();
        wire::SigningTime& newest = newest_.try_emplace(sender, refused_until).first->second;
        const bool is_late = late_.is_too_late(sender, time, newest, now);
        newest = std::max(newest, time);
        if (is_late) return Verdict::too_late;
        if (!is_started()) return Verdict::is_new;
        if (marks_.has(frame)) return Verdict::repeated;
        marks_.note(frame);
        return Verdict::is_new;
    }

private:
    static constexpr std::size_t most_senders = 4 * wire::Verifier::max_streams;

    void forget_senders() noexcept {
        newest_.clear();
        late_ = {};
    }

    SignatureMarks marks_;
    LateFrames late_;
    std::unordered_map<std::uint32_t, wire::SigningTime> newest_;  // the newest time of each sender
};

}  // namespace mavloom::link::detail
