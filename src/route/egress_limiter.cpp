// SPDX-License-Identifier: MIT
#include "route/egress_limiter.hpp"

#include <algorithm>
#include <chrono>

namespace mavloom::route {

double EgressLimiter::burst_bytes(std::uint64_t bytes_per_s) noexcept {
    return std::max(static_cast<double>(bytes_per_s) / 4, 2.0 * wire::max_frame_length);
}

EgressLimiter::EgressLimiter(const dialect::Rates& rates, std::optional<std::uint64_t> bytes_per_s)
    : rates_(rates), bytes_per_s_(bytes_per_s) {
    if (bytes_per_s_) tokens_ = verified_tokens_ = burst_bytes(*bytes_per_s_);
}

void EgressLimiter::refill(MonoTime now) noexcept {
    if (filled_ != MonoTime::min()) {
        const std::chrono::duration<double> since = now - filled_;
        const double added = since.count() * static_cast<double>(*bytes_per_s_), most = burst_bytes(*bytes_per_s_);
        tokens_ = std::min(tokens_ + added, most);
        verified_tokens_ = std::min(verified_tokens_ + added, most);
    }
    filled_ = now;
}

// Leaves at most one second's worth of debt.
void EgressLimiter::spend(double& tokens, double bytes) const noexcept {
    tokens = std::max(tokens - bytes, -static_cast<double>(*bytes_per_s_));
}

[[gnu::noinline]] EgressLimiter::Answer EgressLimiter::admit(const wire::FrameView& frame, bool essential,
                                                             bool is_verified, MonoTime now) noexcept {
    const auto rate = rates_.ask(frame, now, is_verified ? 1 : 0);
    if (!rate.admitted) return Answer::rate_limited;
    if (bytes_per_s_) {
        refill(now);
        const auto size = static_cast<double>(frame.size());
        if (!essential && (is_verified ? verified_tokens_ : tokens_) < size) return Answer::bytes_limited;
        spend(tokens_, size);
        if (is_verified) spend(verified_tokens_, size);
    }
    rates_.count(rate, now);
    return Answer::admitted;
}

}  // namespace mavloom::route
