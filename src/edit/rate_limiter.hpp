// SPDX-License-Identifier: MIT
// At most so many frames a second of each (source, message), by deadlines: 12 Hz limited to 10 comes out at 10, not at 6. Private to module
// edit; one owner thread; allocates at construction only.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::edit {

class RateLimiter {
public:
    struct Rate {
        std::uint32_t id = 0;
        Nanoseconds interval{};
    };

    RateLimiter() = default;
    // `rates` by message; `others`, if there, for all messages not among them.
    RateLimiter(std::vector<Rate> rates, std::optional<Nanoseconds> others);

    // Whether the frame is within its rate; if so it is counted.
    [[nodiscard]] bool admit(const wire::FrameView& frame, WallTime received) noexcept;

private:
    // Streams are remembered in sets of eight; in a full set the one that has been silent longest is forgotten, which lets one frame through early.
    static constexpr std::size_t ways = 8;
    static constexpr std::size_t sets = 1024;
    static constexpr std::uint64_t no_stream = ~std::uint64_t{0};

    struct Stream {
        std::uint64_t key = no_stream;
        WallTime due = WallTime::min();
    };

    [[nodiscard]] const Nanoseconds* interval_of(std::uint32_t id) const noexcept;
    [[nodiscard]] Stream& stream_of(std::uint64_t key) noexcept;

    std::vector<Rate> rates_;  // by rising id
    std::optional<Nanoseconds> others_;
    std::vector<Stream> streams_;
};

}  // namespace mavloom::edit
