// SPDX-License-Identifier: MIT
// Limits the bytes that wait in a serial driver to those that the line carries in 50 ms. All other bytes wait in the
// queue, where frames can expire and be dropped. The assumed speed is at least the baud rate. USB ignores the baud rate
// and pseudo-terminals do not report one, so a driver may drain faster. The pacer then learns that speed. Private to
// module link; plain values.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "mavloom/base/clock.hpp"

namespace mavloom::link::detail {

class SerialPacer {
public:
    explicit SerialPacer(std::uint32_t baud) noexcept : slowest_(std::max(baud / bits_per_byte, 1u)) {}

    // Returns how many more bytes the driver may get while it holds `unsent` bytes.
    [[nodiscard]] std::size_t room(std::size_t unsent) const noexcept {
        return unsent < budget() ? budget() - unsent : 0;
    }
    // The time in which the line carries half of the allowed bytes.
    [[nodiscard]] static constexpr Nanoseconds interval() noexcept { return depth / 2; }
    // Call it one interval after filling the driver, with the bytes that it still holds.
    void learn(std::size_t unsent) noexcept {
        if (unsent == 0) {
            bytes_per_s_ = std::min(std::max(bytes_per_s_, slowest_) * 2, fastest);
        } else if (unsent > budget() / 2) {
            bytes_per_s_ = std::max(bytes_per_s_ / 2, slowest_);
        }
    }

private:
    static constexpr std::uint32_t bits_per_byte = 10;  // start bit, eight data bits, stop bit
    static constexpr std::chrono::milliseconds depth{50};
    static constexpr std::uint32_t fastest = 8'000'000;  // more than serial drivers reach over high-speed USB
    static constexpr std::size_t min_budget = 64;        // a typical driver's block size

    [[nodiscard]] std::size_t budget() const noexcept {
        const std::uint64_t speed = std::max(bytes_per_s_, slowest_);
        return std::max<std::size_t>(speed * depth.count() / 1000, min_budget);
    }

    std::uint32_t slowest_;
    std::uint32_t bytes_per_s_ = 0;
};

}  // namespace mavloom::link::detail
