// SPDX-License-Identifier: MIT
// Limits the output of one link: max_rate for each source and message, and max_bytes as a token bucket. Frames
// of strangers have rates and a bucket of their own, so they take nothing from the others. Of max_bytes, they get what
// the others leave. Private to module route. One owner thread. Allocates at construction.
#pragma once

#include <cstdint>
#include <optional>

#include "mavloom/base/clock.hpp"
#include "mavloom/dialect/rate_limiter.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::route {

class EgressLimiter {
public:
    enum class Answer : std::uint8_t { admitted, rate_limited, bytes_limited };

    // The burst allowed after a pause: the bytes of a quarter second, but at least two of the longest frames.
    [[nodiscard]] static double burst_bytes(std::uint64_t bytes_per_s) noexcept;

    EgressLimiter(const dialect::Rates& rates, std::optional<std::uint64_t> bytes_per_s);

    [[nodiscard]] bool limits() const noexcept { return rates_.limits() || bytes_per_s_.has_value(); }
    // Counts the frame if the answer is `admitted`. The byte limit never holds back an essential frame.
    [[nodiscard]] Answer admit(const wire::FrameView& frame, bool essential, bool is_trusted, MonoTime now) noexcept;

private:
    void refill(MonoTime now) noexcept;
    void spend(double& tokens, double bytes) const noexcept;

    dialect::RateLimiter<MonoTime> rates_;
    std::optional<std::uint64_t> bytes_per_s_;
    // Bytes; below 0 after essential frames. Frames from own and verified links spend from both buckets.
    double tokens_ = 0, trusted_tokens_ = 0;
    MonoTime filled_ = MonoTime::min();
};

}  // namespace mavloom::route
