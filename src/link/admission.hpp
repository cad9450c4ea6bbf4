// SPDX-License-Identifier: MIT
// Limits how many unknown senders a UDP or TCP endpoint accepts as peers, so that a flood of invented addresses costs
// little. Private to module link; single owner thread.
//
// The first senders enter at once, later ones at a steady rate. A sender that is turned away during a flood enters when
// it sends again 0.5 to 10 s later. Every MAVLink program does that; invented addresses mostly do not. If many
// senders repeat, they enter at a steady rate too. Above 44,000 new addresses a second, the table is full, and a sender
// may need several tries. `ask` allocates once: a table of senders, when the first is turned away. See
// docs/design/security.md.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <tuple>

#include "mavloom/base/clock.hpp"
#include "mavloom/net/address.hpp"

namespace mavloom::link::detail {

class Admission {
public:
    enum class Answer : std::uint8_t {
        admitted,
        refused,  // too many new senders; it may enter when it repeats
        limited,  // it repeated, but so did too many others
    };
    static constexpr double per_second = 50;
    static constexpr double repeaters_per_second = 100, most_repeaters_at_once = 100;
    static constexpr std::chrono::milliseconds repeats_after{500};
    static constexpr std::chrono::seconds remembered_for{10};
    // No newer address replaces an address that was first seen less than this ago. So a flood does not make the
    // endpoint forget a program before its next heartbeat.
    static constexpr std::chrono::milliseconds kept_for{1500};
    static constexpr std::size_t remembered = 1u << 16;

    // How many senders may enter at once: twice max_peers, but at least 64.
    [[nodiscard]] static std::size_t burst_for(std::size_t max_peers) noexcept {
        return std::max<std::size_t>(64, 2 * max_peers);
    }
    // `burst`: how many may enter at once.
    explicit Admission(std::size_t burst) noexcept : burst_(static_cast<double>(burst)), tokens_(burst_) {}

    // Returns whether this sender may become a peer now. After `admitted`, call `note_entry` if its datagram holds a
    // valid frame, even if the endpoint then has no room for the peer.
    [[nodiscard]] Answer ask(const net::Address& sender, MonoTime now) {
        refill(now);
        if (tokens_ >= 1) return Answer::admitted;
        if (!note_and_check_repeat(sender, now)) return Answer::refused;
        return repeater_tokens_ >= 1 ? Answer::admitted : Answer::limited;
    }
    // Returns whether the sender was first seen 0.5 to 10 s ago. If it was not seen in the last 10 s, remembers it.
    [[nodiscard]] bool note_and_check_repeat(const net::Address& sender, MonoTime now) {
        if (seen_ == nullptr) seen_ = std::make_unique<Bucket[]>(bucket_count);
        const std::uint64_t hash = secret_hash(sender.hash());  // twice: spreads successive ports evenly
        Bucket& bucket = seen_[hash % bucket_count];
        const auto tag = static_cast<std::uint32_t>(hash >> 32) | 1u;
        const auto now_ms = static_cast<std::uint32_t>(now.time_since_epoch() / std::chrono::milliseconds{1});
        const auto age_of = [&](const Seen& seen) { return seen.tag == 0 ? longest_age : seen.age(now_ms); };
        const auto found = std::ranges::find(bucket, tag, &Seen::tag);
        if (found != bucket.end() && age_of(*found) <= remembered_for) return age_of(*found) >= repeats_after;
        Seen& oldest = found != bucket.end() ? *found : *std::ranges::max_element(bucket, {}, age_of);
        if (age_of(oldest) >= kept_for) oldest = {tag, now_ms};
        return false;
    }
    void note_entry() noexcept { --(tokens_ >= 1 ? tokens_ : repeater_tokens_); }

private:
    struct Seen {
        std::uint32_t tag = 0;  // 0: free
        std::uint32_t at_ms = 0;

        [[nodiscard]] std::chrono::milliseconds age(std::uint32_t now_ms) const noexcept {
            return std::chrono::milliseconds{now_ms - at_ms};  // modulo 2^32, 50 days
        }
    };
    using Bucket = std::array<Seen, 8>;  // a cache line
    static constexpr std::size_t bucket_count = remembered / std::tuple_size_v<Bucket>;
    static constexpr auto longest_age = std::chrono::milliseconds::max();

    void refill(MonoTime now) noexcept {
        const double passed = std::chrono::duration<double>(now - refilled_).count();
        if (refilled_ != MonoTime{}) {
            tokens_ = std::min(tokens_ + passed * per_second, burst_);
            repeater_tokens_ = std::min(repeater_tokens_ + passed * repeaters_per_second, most_repeaters_at_once);
        }
        refilled_ = now;
    }

    double burst_, tokens_;
    double repeater_tokens_ = most_repeaters_at_once;
    MonoTime refilled_{};
    std::unique_ptr<Bucket[]> seen_;  // by hash of the address
};

}  // namespace mavloom::link::detail
