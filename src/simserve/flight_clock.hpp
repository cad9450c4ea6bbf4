// SPDX-License-Identifier: MIT
// Converts between the machine's clock and the flight clock of a simulation. That may run faster or slower, stand
// still, or be free: then it shows the time that it is set to, and so runs as fast as the vehicles can fly. Private to
// module simserve; a plain value.
#pragma once

#include <cassert>
#include <cmath>
#include <limits>

#include "mavloom/sim/flight.hpp"
#include "mavloom/simserve/simulator.hpp"

namespace mavloom::simserve {

class FlightClock {
public:
    // `max_speed`: the clock is free.
    explicit FlightClock(double speed) noexcept : speed_(speed) {}

    // Flight time 0 is `now`.
    void start(MonoTime now) noexcept { start_ = since_ = now; }
    [[nodiscard]] bool has_started() const noexcept { return start_ != MonoTime{}; }
    [[nodiscard]] double speed() const noexcept { return speed_; }
    [[nodiscard]] bool is_free() const noexcept { return speed_ == max_speed; }
    [[nodiscard]] bool is_paused() const noexcept { return is_paused_; }

    // A free clock is alone in its world: its real time is its own, too, whenever the machine was started.
    [[nodiscard]] sim::Moment at(MonoTime now) const noexcept {
        if (is_free()) return {.flight = flight_, .real = MonoTime{} + flight_};
        if (!has_started() || is_paused_) return {.flight = flight_, .real = now};
        const Nanoseconds real = now - since_;
        return {.flight = flight_ + (speed_ == 1 ? real : scaled(real, speed_, 0)), .real = now};
    }

    // The earliest time at which the flight clock shows `flight` or more. A free clock shows it at once.
    [[nodiscard]] MonoTime when(sim::FlightTime flight) const noexcept {
        if (flight > furthest || is_paused_) return MonoTime::max();
        if (is_free()) return MonoTime{};
        const Nanoseconds ahead = flight - flight_;
        return since_ + (speed_ == 1 ? ahead : scaled(ahead, 1 / speed_, 1));
    }

    // Neither does anything twice.
    void pause(MonoTime now) noexcept {
        flight_ = at(now).flight;
        is_paused_ = true;
    }
    void resume(MonoTime now) noexcept {
        if (!is_paused_) return;
        since_ = now;
        is_paused_ = false;
    }
    // Only if the clock is free or paused; never back.
    void set(sim::FlightTime flight) noexcept {
        assert((is_free() || is_paused_) && flight >= flight_);
        flight_ = flight;
    }

private:
    // Later flight times count as never. This is small enough that no conversion overflows.
    static constexpr sim::FlightTime furthest = std::chrono::hours{24 * 365 * 20};

    [[nodiscard]] static Nanoseconds scaled(Nanoseconds time, double factor, std::int64_t more) noexcept {
        return Nanoseconds{static_cast<std::int64_t>(std::floor(static_cast<double>(time.count()) * factor)) + more};
    }

    double speed_;
    bool is_paused_ = false;
    MonoTime start_{}, since_{};
    sim::FlightTime flight_{};  // at `since_`, or now if the clock is free or paused
};

}  // namespace mavloom::simserve
