// SPDX-License-Identifier: MIT
// How much may leave on one link: max_rate by source and message, max_bytes as a token bucket. Private to module route; one owner thread;
// allocates when it is made.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/route/filter.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::route {

class EgressLimiter {
public:
    enum class Answer : std::uint8_t { admitted, rate_limited, bytes_limited };

    // Bytes that may leave at once after a silence: a quarter of a second's, and room for two frames at least.
    [[nodiscard]] static double burst_bytes(std::uint64_t bytes_per_s) noexcept;

    EgressLimiter(Rates rates, std::optional<std::uint64_t> bytes_per_s);

    [[nodiscard]] bool limits() const noexcept { return !rates_.empty() || bytes_per_s_.has_value(); }
    // Counts the frame if the answer is `admitted`.
    [[nodiscard]] Answer admit(const wire::FrameView& frame, bool essential, MonoTime now) noexcept;

private:
    // Streams are remembered in sets of four; in a full set the one that has been silent longest is forgotten, which lets one frame through
    // early.
    static constexpr std::size_t ways = 4;
    static constexpr std::size_t sets = 1024;
    static constexpr std::uint64_t no_stream = ~std::uint64_t{0};

    struct Stream {
        std::uint64_t key = no_stream;
        MonoTime due = MonoTime::min();
    };

    [[nodiscard]] const Nanoseconds* interval_of(std::uint32_t id, bool essential) const noexcept;
    [[nodiscard]] Stream& stream_of(std::uint64_t key) noexcept;
    void refill(MonoTime now) noexcept;

    Rates rates_;
    std::vector<Stream> streams_;
    std::optional<std::uint64_t> bytes_per_s_;
    double tokens_ = 0;  // bytes; below 0 after essential frames
    MonoTime filled_ = MonoTime::min();
};

}  // namespace mavloom::route
