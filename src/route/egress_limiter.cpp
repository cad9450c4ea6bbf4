// SPDX-License-Identifier: MIT
#include "route/egress_limiter.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>

namespace mavloom::route {

double EgressLimiter::burst_bytes(std::uint64_t bytes_per_s) noexcept {
    return std::max(static_cast<double>(bytes_per_s) / 4, 2.0 * wire::max_frame_length);
}

EgressLimiter::EgressLimiter(const dialect::Rates& rates, std::optional<std::uint64_t> bytes_per_s)
    : rates_(rates), bytes_per_s_(bytes_per_s) {
    if (bytes_per_s_) tokens_ = trusted_tokens_ = burst_bytes(*bytes_per_s_);
}

void EgressLimiter::refill(MonoTime now) noexcept {
    assert(bytes_per_s_ && now >= filled_);
    if (filled_ != MonoTime::min()) {
        const std::chrono::duration<double> since = now - filled_;
        const double added = since.count() * static_cast<double>(*bytes_per_s_), most = burst_bytes(*bytes_per_s_);
        tokens_ = std::min(tokens_ + added, most);
        trusted_tokens_ = std::min(trusted_tokens_ + added, most);
    }
    filled_ = now;
}

// Leaves at most one second's worth of debt.
void EgressLimiter::spend(double& tokens, double bytes) const noexcept {
    tokens = std::max(tokens - bytes, -static_cast<double>(*bytes_per_s_));
}

[[gnu::noinline]] EgressLimiter::Answer EgressLimiter::admit(const wire::FrameView& frame, bool essential,
                                                             bool is_trusted, MonoTime now) noexcept {
    const auto rate = rates_.ask(frame, now, is_trusted ? 1 : 0);
    if (!rate.admitted) return Answer::rate_limited;
    if (bytes_per_s_) {
        refill(now);
        const auto size = static_cast<double>(frame.size());
        if (!essential && (is_trusted ? trusted_tokens_ : tokens_) < size) return Answer::bytes_limited;
        spend(tokens_, size);
        if (is_trusted) spend(trusted_tokens_, size);
        assert(tokens_ <= trusted_tokens_ && "whatever trusted frames take is taken from strangers");
    }
    rates_.count(rate, now);
    return Answer::admitted;
}

}  // namespace mavloom::route
