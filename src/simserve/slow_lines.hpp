// SPDX-License-Identifier: MIT
// Computes how much of what the vehicles sent still waits on each serial line, by the line's baud rate. Drivers do not
// always report it: a pseudo-terminal holds several kilobytes and reports none. Private to module simserve; single
// owner.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/ids.hpp"

namespace mavloom::simserve {

class SlowLines {
public:
    // Bulk transfers pause while a line needs longer than this for what waits, so that telemetry stays fresh.
    static constexpr std::chrono::milliseconds max_waiting{200};
    // If telemetry alone is more than a line carries, or its baud rate is not the real one, the pause would not end. So
    // after a pause as long as this one, nothing counts as waiting.
    static constexpr std::chrono::milliseconds longest_pause{500};

    void open(LinkId link, std::uint32_t bytes_s) { lines_.push_back({.link = link, .bytes_s = bytes_s}); }
    void close(LinkId link) {
        std::erase_if(lines_, [&](const Line& line) { return line.link == link; });
    }
    void note_sent(LinkId link, std::size_t bytes, MonoTime now) noexcept {
        for (Line& line : lines_)
            if (line.link == link) line.note_sent(bytes, now);
    }
    // True for all links that are not slow lines.
    [[nodiscard]] bool has_room(LinkId link, MonoTime now) const noexcept {
        return std::ranges::none_of(lines_, [&](const Line& line) { return line.link == link && !line.has_room(now); });
    }

private:
    struct Line {
        LinkId link;
        std::uint32_t bytes_s;
        MonoTime free_at{};   // when the line will have carried all that was sent
        MonoTime had_room{};  // when something was last sent while there was room

        [[nodiscard]] bool is_fresh(MonoTime now) const noexcept { return free_at <= now + max_waiting; }
        [[nodiscard]] bool has_room(MonoTime now) const noexcept {
            return is_fresh(now) || now > had_room + longest_pause;
        }
        void note_sent(std::size_t bytes, MonoTime now) noexcept {
            if (has_room(now)) {
                if (!is_fresh(now)) free_at = now;
                had_room = now;
            }
            free_at = std::max(free_at, now) +
                      std::chrono::nanoseconds{std::chrono::seconds{bytes}} / std::max(bytes_s, 1u);
        }
    };

    std::vector<Line> lines_;
};

}  // namespace mavloom::simserve
