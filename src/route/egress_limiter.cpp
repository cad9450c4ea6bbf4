// SPDX-License-Identifier: MIT
#include "route/egress_limiter.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace mavloom::route {

double EgressLimiter::burst_bytes(std::uint64_t bytes_per_s) noexcept {
    return std::max(static_cast<double>(bytes_per_s) / 4, 2.0 * wire::max_frame_length);
}

EgressLimiter::EgressLimiter(Rates rates, std::optional<std::uint64_t> bytes_per_s)
    : rates_(std::move(rates)), streams_(rates_.empty() ? 0 : sets * ways), bytes_per_s_(bytes_per_s) {
    if (bytes_per_s_) tokens_ = burst_bytes(*bytes_per_s_);
}

// A rate that names the message holds for it whatever it is; the rate for all others spares what somebody waits for.
const Nanoseconds* EgressLimiter::interval_of(std::uint32_t id, bool essential) const noexcept {
    const auto at = std::lower_bound(rates_.named.begin(), rates_.named.end(), id,
                                     [](const Rates::Named& n, std::uint32_t v) { return n.id < v; });
    if (at != rates_.named.end() && at->id == id) return &at->interval;
    return rates_.others && !essential ? &*rates_.others : nullptr;
}

EgressLimiter::Stream& EgressLimiter::stream_of(std::uint64_t key) noexcept {
    Stream* const first = &streams_[((key * 0x9e3779b97f4a7c15u) >> 54) * ways];
    static_assert(sets == 1u << 10, "the ten bits that are left");
    Stream* oldest = first;
    for (Stream* stream = first; stream != first + ways; ++stream) {
        if (stream->key == key) return *stream;
        if (stream->due < oldest->due) oldest = stream;
    }
    *oldest = {key, MonoTime::min()};
    return *oldest;
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
    Stream* stream = nullptr;
    const Nanoseconds* const interval = rates_.empty() ? nullptr : interval_of(frame.id().value, essential);
    if (interval != nullptr) {
        const auto source = std::uint64_t{frame.system().value} << 8 | frame.component().value;
        stream = &stream_of(source << 24 | frame.id().value);
        if (now < stream->due) return Answer::rate_limited;
    }
    if (bytes_per_s_) {
        refill(now);
        const auto size = static_cast<double>(frame.size());
        if (!essential && tokens_ < size) return Answer::bytes_limited;
        tokens_ = std::max(tokens_ - size, -static_cast<double>(*bytes_per_s_));  // a second's debt at most
    }
    if (stream != nullptr) {
        const bool in_step = stream->due != MonoTime::min() && now - stream->due < *interval;
        stream->due = (in_step ? stream->due : now) + *interval;
    }
    return Answer::admitted;
}

}  // namespace mavloom::route
