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
    if (bytes_per_s_) tokens_ = burst_bytes(*bytes_per_s_);
}

void EgressLimiter::refill(MonoTime now) noexcept {
    if (filled_ != MonoTime::min()) {
        const std::chrono::duration<double> since = now - filled_;
        const auto rate = static_cast<double>(*bytes_per_s_);
        tokens_ = std::min(tokens_ + since.count() * rate, burst_bytes(*bytes_per_s_));
    }
    filled_ = now;
}

EgressLimiter::Answer EgressLimiter::admit(const wire::FrameView& frame, bool essential, MonoTime now) noexcept {
    const auto rate = rates_.ask(frame, now);
    if (!rate.admitted) return Answer::rate_limited;
    if (bytes_per_s_) {
        refill(now);
        const auto size = static_cast<double>(frame.size());
        if (!essential && tokens_ < size) return Answer::bytes_limited;
        tokens_ = std::max(tokens_ - size, -static_cast<double>(*bytes_per_s_));  // at most one second's worth of debt
    }
    rates_.count(rate, now);
    return Answer::admitted;
}

}  // namespace mavloom::route
