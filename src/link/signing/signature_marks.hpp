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

// All frames that it gets are signed.
class SignatureMarks {
public:
    // Before this call it remembers nothing.
    void start() {
        if (buckets_.empty()) buckets_.resize(bucket_count);
    }
    [[nodiscard]] bool is_started() const noexcept { return !buckets_.empty(); }
    void note(const wire::FrameView& frame) noexcept {
        if (buckets_.empty()) return;
        const Mark mark = mark_of(frame);
        Bucket& bucket = buckets_[mark.bucket];
        std::uint64_t& oldest = bucket.frames[bucket.next++ % bucket.frames.size()];
        bucket.forgotten = std::max(bucket.forgotten, oldest >> 16);
        oldest = mark.value;
    }
    [[nodiscard]] bool has(const wire::FrameView& frame) const noexcept {
        if (buckets_.empty()) return false;
        const Mark mark = mark_of(frame);
        return std::ranges::find(buckets_[mark.bucket].frames, mark.value) != buckets_[mark.bucket].frames.end();
    }
    // The newest time of the signatures that the frame's bucket has dropped.
    [[nodiscard]] std::uint64_t forgotten(const wire::FrameView& frame) const noexcept {
        return buckets_.empty() ? 0 : buckets_[mark_of(frame).bucket].forgotten;
    }

private:
    static constexpr std::size_t bucket_count = 1024;
    struct Bucket {
        std::array<std::uint64_t, 64> frames{};  // a ring of marks: time in the upper bits, 16 bits of hash below
        std::uint64_t forgotten = 0;
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

    std::vector<Bucket> buckets_;  // by further bits of the hash
};

}  // namespace mavloom::link::detail
