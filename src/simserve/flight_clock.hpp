// SPDX-License-Identifier: MIT
// Converts between the machine's clock and the flight clock of a simulation, which may run faster or slower. Private to
// module simserve; a plain value.
#pragma once

#include <cmath>

#include "mavloom/sim/flight.hpp"

namespace mavloom::simserve {

class FlightClock {
public:
    explicit FlightClock(double speed) noexcept : speed_(speed) {}

    // Flight time 0 is `now`.
    void start(MonoTime now) noexcept { start_ = now; }
    [[nodiscard]] bool has_started() const noexcept { return start_ != MonoTime{}; }
    [[nodiscard]] double speed() const noexcept { return speed_; }

    [[nodiscard]] sim::Moment at(MonoTime now) const noexcept {
        if (!has_started()) return {.flight = {}, .real = now};
        const Nanoseconds real = now - start_;
        return {.flight = speed_ == 1 ? real : scaled(real, speed_, 0), .real = now};
    }

    // The earliest time at which the flight clock shows `flight` or more.
    [[nodiscard]] MonoTime when(sim::FlightTime flight) const noexcept {
        if (flight > furthest) return MonoTime::max();
        return start_ + (speed_ == 1 ? flight : scaled(flight, 1 / speed_, 1));
    }

private:
    // Later flight times count as never. This is small enough that no conversion overflows.
    static constexpr sim::FlightTime furthest = std::chrono::hours{24 * 365 * 20};

    [[nodiscard]] static Nanoseconds scaled(Nanoseconds time, double factor, std::int64_t more) noexcept {
        return Nanoseconds{static_cast<std::int64_t>(std::floor(static_cast<double>(time.count()) * factor)) + more};
    }

    double speed_;
    MonoTime start_{};
};

}  // namespace mavloom::simserve
