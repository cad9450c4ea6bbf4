// SPDX-License-Identifier: MIT
// Remembers about 65,000 signatures: the newest 64 in each of 1,024 buckets. Private to module link; single owner
// thread; allocates only in `start`.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "mavloom/wire/signing.hpp"

namespace mavloom::link::detail {

// All frames passed to it must be signed. Before `start`, only `is_started` may be called.
class SignatureMarks {
public:
    void start() {
        if (buckets_.empty()) buckets_.resize(bucket_count);
    }
    [[nodiscard]] bool is_started() const noexcept { return !buckets_.empty(); }
    void note(const wire::FrameView& frame) noexcept {
        const Mark mark = mark_of(frame);
        Bucket& bucket = buckets_[mark.bucket];
        std::uint64_t& oldest = bucket.frames[bucket.next++ % bucket.frames.size()];
        bucket.forgotten = std::max(bucket.forgotten, oldest >> 16);
        oldest = mark.value;
    }
    [[nodiscard]] bool has(const wire::FrameView& frame) const noexcept { return has(mark_of(frame)); }
    // Like `has`, but also true if the frame's bucket has dropped a signature that is not older.
    [[nodiscard]] bool may_have_had(const wire::FrameView& frame) const noexcept {
        const Mark mark = mark_of(frame);
        return mark.value >> 16 <= buckets_[mark.bucket].forgotten || has(mark);
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

    [[nodiscard]] bool has(const Mark& mark) const noexcept {
        const auto& frames = buckets_[mark.bucket].frames;
        return std::ranges::find(frames, mark.value) != frames.end();
    }

    std::vector<Bucket> buckets_;  // by further bits of the hash
};

}  // namespace mavloom::link::detail
