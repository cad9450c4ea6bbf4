// SPDX-License-Identifier: MIT
// Recognises frames that this process signed and that somebody sends back to it. Without this check, a sender that does
// not have the key would pass as one that has it.
//
// The class remembers about 65,000 signatures of a key: the newest 64 in each of 1,024 buckets. A frame with one of our
// link ids counts as ours in two cases: its bucket holds its signature, or its time is not newer than the newest
// signature that the bucket has dropped. So frames of another program with the same key and link id are accepted,
// unless its clock is far behind ours.
//
// Private to module link; single owner thread; allocates only in `sign_as`.
#pragma once

#include <algorithm>
#include <array>
#include <bitset>
#include <cstdint>
#include <vector>

#include "mavloom/wire/signing.hpp"

namespace mavloom::link::detail {

class OwnFrames {
public:
    // From now on, frames are signed with this link id.
    void sign_as(std::uint8_t link_id) {
        ids_.set(link_id);
        if (buckets_.empty()) buckets_.resize(bucket_count);
    }
    // Earlier runs of the program signed frames up to this time. So all frames up to then with our link ids are ours.
    void treat_as_own_until(wire::SigningTime time) noexcept { earlier_ = std::max(earlier_, time.ticks); }

    // `frame` is signed, with a link id given to `sign_as`.
    void note(const wire::FrameView& frame) noexcept {
        const Mark mark = mark_of(frame);
        Bucket& bucket = buckets_[mark.bucket];
        std::uint64_t& oldest = bucket.frames[bucket.next++ % bucket.frames.size()];
        bucket.forgotten = std::max(bucket.forgotten, oldest >> 16);
        oldest = mark.value;
    }
    // True if this process signed the frame. The result has a meaning only if the frame's signature is good.
    [[nodiscard]] bool has(const wire::FrameView& frame) const noexcept {
        if (!ids_.test(frame.signature()[0])) return false;
        const Mark mark = mark_of(frame);
        const Bucket& bucket = buckets_[mark.bucket];
        if (mark.value >> 16 <= std::max(earlier_, bucket.forgotten)) return true;
        return std::ranges::find(bucket.frames, mark.value) != bucket.frames.end();
    }

private:
    static constexpr std::size_t bucket_count = 1024;
    struct Bucket {
        std::array<std::uint64_t, 64> frames{};  // a ring of marks: time in the upper bits, 16 bits of hash below
        std::uint64_t forgotten = 0;             // the newest time that left the ring
        std::uint32_t next = 0;
    };
    struct Mark {
        std::uint64_t value;
        std::size_t bucket;
    };
    [[nodiscard]] static Mark mark_of(const wire::FrameView& frame) noexcept {
        const auto* const hash = frame.signature().data() + 7;
        const std::uint64_t time = wire::Verifier::stream_of(frame).last.ticks;
        return {time << 16 | load_le<std::uint16_t>(hash), load_le<std::uint16_t>(hash + 2) % bucket_count};
    }

    std::bitset<256> ids_;
    std::uint64_t earlier_ = 0;
    std::vector<Bucket> buckets_;  // by further bits of the hash
};

}  // namespace mavloom::link::detail
