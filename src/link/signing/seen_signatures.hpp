// SPDX-License-Identifier: MIT
// The signatures of one key that this process saw lately: those that it made, and those of the frames that it heard on
// any endpoint. Everybody who received such a frame can send it again, without the key.
//
// The set holds about 65,000 signatures: the newest 64 in each of 1,024 buckets. It accepts no frame that it has
// forgotten:
// - A heard frame is too late if its time is not newer than the newest time that its sender had reached at a moment 0.6
//   to 1.8 s ago. Late frames are not remembered, so replays of old frames evict no new signature. Frames of a sender
//   may arrive late over a second link. Only arrival times count, because signers' clocks need not match ours.
// - A frame with one of our link ids counts as ours if it is not newer than the newest of ours that its bucket forgot.
//   So frames of another program with the same key and link id are accepted, unless its clock is far behind ours.
//
// All frames must be signed, and their signatures good. Private to module link; single owner thread; allocates its
// buckets at construction, and for a new sender.
#pragma once

#include <algorithm>
#include <array>
#include <bitset>
#include <cassert>
#include <chrono>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/wire/signing.hpp"

namespace mavloom::link::detail {

class SeenSignatures {
public:
    // From now on, frames are signed with this link id.
    void sign_as(std::uint8_t link_id) { own_ids_.set(link_id); }
    // Earlier runs of the program signed frames up to this time. So all frames up to then with our link ids are ours.
    void treat_as_own_until(wire::SigningTime time) noexcept {
        for (Bucket& bucket : buckets_) bucket.forgotten_own = std::max(bucket.forgotten_own, time.ticks);
    }
    // Remembers a frame that this process signed.
    void note_signed(const wire::FrameView& frame) noexcept {
        assert(own_ids_.test(frame.signature()[0]));
        insert(mark_of(frame, true));
    }
    // True if this process signed the frame.
    [[nodiscard]] bool is_own(const wire::FrameView& frame) const noexcept {
        if (!own_ids_.test(frame.signature()[0])) return false;
        const Mark mark = mark_of(frame, true);
        return mark.value >> 16 <= buckets_[mark.bucket].forgotten_own || has(mark);
    }

    // How much later than a newer frame of its sender a frame is too late: between `step` and `max_late`.
    static constexpr Nanoseconds step = std::chrono::milliseconds{600}, max_late = 3 * step;
    static_assert(max_late <= link::Links::max_late);

    // Decides which frames of a sender are too late, by its newest timestamps: now, at the time `since`, and `step` to
    // 2 * `step` before that.
    struct Sender {
        Sender(wire::SigningTime time, MonoTime now) : newest(time), recent(time), old(time), since(now) {}
        [[nodiscard]] bool accepts(wire::SigningTime time, MonoTime now) noexcept {
            if (now - since >= step) {
                old = now - since >= 2 * step ? newest : recent;
                recent = newest;
                since = now;
            }
            newest = std::max(newest, time);
            return time > old;
        }
        wire::SigningTime newest, recent, old;
        MonoTime since;
    };

    enum class Verdict : std::uint8_t { is_new, repeated, too_late };
    // Remembers a frame that another program signed. `refused_until`: if the sender was not heard yet, frames with this
    // timestamp or an older one are too late.
    [[nodiscard]] Verdict hear(const wire::FrameView& frame, MonoTime now, wire::SigningTime refused_until = {}) {
        const auto [key, time] = wire::Verifier::stream_of(frame);
        // Only a holder of the key can sign for so many senders.
        if (senders_.size() == max_senders && !senders_.contains(key)) senders_.clear();
        Sender& sender = senders_.try_emplace(key, refused_until, now).first->second;
        if (!sender.accepts(time, now)) return Verdict::too_late;
        const Mark mark = mark_of(frame, false);
        if (has(mark)) return Verdict::repeated;
        insert(mark);
        return Verdict::is_new;
    }

private:
    static constexpr std::size_t bucket_count = 1024, max_senders = 4 * wire::Verifier::max_streams;

    struct Bucket {
        std::array<std::uint64_t, 64> marks{};  // a ring
        std::uint64_t forgotten_own = 0;        // the newest time of our own frames that left the ring
        std::uint32_t next = 0;
    };
    struct Mark {
        std::uint64_t value;  // 48 bits of time, 15 bits of the hash, and whether the frame is ours
        std::size_t bucket;   // further bits of the hash
    };
    [[nodiscard]] static Mark mark_of(const wire::FrameView& frame, bool is_own) noexcept {
        assert(frame.is_signed());
        const auto* const hash = frame.signature().data() + 7;
        const std::uint64_t time = wire::Verifier::stream_of(frame).last.ticks;
        const unsigned low = (load_le<std::uint16_t>(hash) & ~1u) | (is_own ? 1u : 0u);
        return {time << 16 | low, load_le<std::uint16_t>(hash + 2) % bucket_count};
    }
    [[nodiscard]] bool has(const Mark& mark) const noexcept {
        const auto& marks = buckets_[mark.bucket].marks;
        return std::ranges::find(marks, mark.value) != marks.end();
    }
    void insert(const Mark& mark) noexcept {
        Bucket& bucket = buckets_[mark.bucket];
        std::uint64_t& oldest = bucket.marks[bucket.next++ % bucket.marks.size()];
        if ((oldest & 1) != 0) bucket.forgotten_own = std::max(bucket.forgotten_own, oldest >> 16);
        oldest = mark.value;
    }

    std::bitset<256> own_ids_;
    std::vector<Bucket> buckets_ = std::vector<Bucket>(bucket_count);
    std::unordered_map<std::uint32_t, Sender> senders_;  // by Verifier::Stream::key
};

}  // namespace mavloom::link::detail
