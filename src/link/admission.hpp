// SPDX-License-Identifier: MIT
// Limits how many unknown senders a UDP endpoint accepts as peers, so that a flood of invented addresses costs little.
// Private to module link; single owner thread.
//
// The first senders enter at once, later ones at a steady rate. A sender that is turned away during a flood enters when
// it sends again 0.5 to 10 s later. Every MAVLink program does that; invented addresses mostly do not. If many addresses
// repeat, they enter at a steady rate too. `ask` allocates once: a table of senders, when the first one is turned away.
// docs/design/security.md
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>

#include "mavloom/base/clock.hpp"
#include "mavloom/net/address.hpp"

namespace mavloom::link::detail {

class Admission {
public:
    enum class Answer : std::uint8_t {
        admitted,
        refused,  // too many new senders; it may enter when it repeats
        limited,  // it repeated, as too many others did
    };
    static constexpr double per_second = 50;
    static constexpr double repeaters_per_second = 100, most_repeaters_at_once = 100;
    static constexpr std::chrono::milliseconds repeats_after{500};
    static constexpr std::chrono::seconds remembered_for{10};
    static constexpr std::size_t remembered = 1u << 16;

    // Twice as many as may stay enter at once, but at least 64.
    [[nodiscard]] static std::size_t burst_for(std::size_t max_peers) noexcept {
        return std::max<std::size_t>(64, 2 * max_peers);
    }
    // `burst`: how many may enter at once.
    explicit Admission(std::size_t burst) noexcept : burst_(static_cast<double>(burst)), tokens_(burst_) {}

    // Returns whether this sender may become a peer now. If the answer is `admitted`, call `note_entry` once the sender
    // has cost more work, even if it is turned away after all.
    [[nodiscard]] Answer ask(const net::Address& sender, MonoTime now) {
        refill(now);
        if (tokens_ >= 1) return Answer::admitted;
        if (!has_repeated(sender, now)) return Answer::refused;
        return repeater_tokens_ >= 1 ? Answer::admitted : Answer::limited;
    }
    // Returns whether the sender also sent 0.5 to 10 s ago.
    [[nodiscard]] bool has_repeated(const net::Address& sender, MonoTime now) {
        if (seen_ == nullptr) seen_ = std::make_unique<Seen[]>(remembered);
        const std::uint64_t hash = sender.hash();
        Seen& seen = seen_[hash % remembered];
        const auto tag = static_cast<std::uint32_t>(hash >> 32) | 1u;
        const auto now_ms = static_cast<std::uint32_t>(now.time_since_epoch() / std::chrono::milliseconds{1});
        const std::chrono::milliseconds age{now_ms - seen.at_ms};  // modulo 2^32, 50 days
        if (seen.tag == tag && age <= remembered_for) return age >= repeats_after;
        seen = {tag, now_ms};
        return false;
    }
    void note_entry() noexcept { --(tokens_ >= 1 ? tokens_ : repeater_tokens_); }

private:
    struct Seen {
        std::uint32_t tag = 0;
        std::uint32_t at_ms = 0;
    };

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
    std::unique_ptr<Seen[]> seen_;
};

}  // namespace mavloom::link::detail
