// SPDX-License-Identifier: MIT
// How many bytes may wait in a serial driver: 50 ms of what the line carries, so that the rest waits where it can age and give way. The line's
// speed is at least the baud rate's; where the driver empties sooner (USB has no baud rate, a pseudo-terminal tells nothing) it is learnt.
// Private to module link; values.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "mavloom/base/clock.hpp"

namespace mavloom::link::detail {

class SerialPacer {
public:
    explicit SerialPacer(std::uint32_t baud) noexcept : slowest_(std::max(baud / bits_per_byte, 1u)) {}

    // How many more bytes the driver may be given while it holds `unsent`.
    [[nodiscard]] std::size_t room(std::size_t unsent) const noexcept {
        return unsent < budget() ? budget() - unsent : 0;
    }
    // When half of what it may hold has left.
    [[nodiscard]] static constexpr Nanoseconds interval() noexcept { return depth / 2; }
    // To be told what the driver still holds an interval after it was filled.
    void learn(std::size_t unsent) noexcept {
        if (unsent == 0) {
            bytes_per_s_ = std::min(std::max(bytes_per_s_, slowest_) * 2, fastest);
        } else if (unsent > budget() / 2) {
            bytes_per_s_ = std::max(bytes_per_s_ / 2, slowest_);
        }
    }

private:
    static constexpr std::uint32_t bits_per_byte = 10;  // start, eight of data, stop
    static constexpr std::chrono::milliseconds depth{50};
    static constexpr std::uint32_t fastest = 8'000'000;  // beyond USB's high speed as serial drivers use it
    static constexpr std::size_t least = 64;             // a driver's own pieces

    [[nodiscard]] std::size_t budget() const noexcept {
        const std::uint64_t speed = std::max(bytes_per_s_, slowest_);
        return std::max<std::size_t>(speed * depth.count() / 1000, least);
    }

    std::uint32_t slowest_;
    std::uint32_t bytes_per_s_ = 0;
};

}  // namespace mavloom::link::detail
