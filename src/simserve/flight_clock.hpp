// SPDX-License-Identifier: MIT
// Converts between the machine's clock and the flight clock of a simulation. That may run faster or slower, stand
// still, or be free: then it shows the time that it is set to, and so runs as fast as the vehicles can fly. It may also
// be exact: then it runs by the machine's clock, but shows each time only when it is set to it, so that no time is
// skipped. Private to module simserve; a plain value.
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

    // Call it before the flight.
    void make_exact() noexcept { is_exact_ = true; }
    [[nodiscard]] bool is_exact() const noexcept { return is_exact_; }

    // A free or exact clock is alone in its world: its real time is its own, too, whenever the machine was started.
    [[nodiscard]] sim::Moment at(MonoTime now) const noexcept {
        if (is_free() || is_exact_) return {.flight = shown_, .real = MonoTime{} + shown_};
        return {.flight = running(now), .real = now};
    }
    // The time up to which an exact clock may be set, in whole microseconds, as recordings have them.
    [[nodiscard]] sim::FlightTime target(MonoTime now) const noexcept {
        return std::chrono::floor<std::chrono::microseconds>(running(now));
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
        flight_ = shown_ = is_free() || is_exact_ ? shown_ : running(now);
        is_paused_ = true;
    }
    void resume(MonoTime now) noexcept {
        if (!is_paused_) return;
        since_ = now;
        is_paused_ = false;
    }
    // Only if the clock is free, exact or paused; never back.
    void set(sim::FlightTime flight) noexcept {
        assert((is_free() || is_exact_ || is_paused_) && flight >= shown_);
        shown_ = flight;
        if (is_free() || is_paused_) flight_ = flight;
    }

private:
    // Later flight times count as never. This is small enough that no conversion overflows.
    static constexpr sim::FlightTime furthest = std::chrono::hours{24 * 365 * 20};

    [[nodiscard]] sim::FlightTime running(MonoTime now) const noexcept {
        if (!has_started() || is_paused_ || is_free()) return flight_;
        const Nanoseconds real = now - since_;
        return flight_ + (speed_ == 1 ? real : scaled(real, speed_, 0));
    }
    [[nodiscard]] static Nanoseconds scaled(Nanoseconds time, double factor, std::int64_t more) noexcept {
        return Nanoseconds{static_cast<std::int64_t>(std::floor(static_cast<double>(time.count()) * factor)) + more};
    }

    double speed_;
    bool is_paused_ = false, is_exact_ = false;
    MonoTime start_{}, since_{};
    sim::FlightTime flight_{};  // at `since_`, or now if the clock is free or paused
    sim::FlightTime shown_{};   // by a free, exact or paused clock
};

}  // namespace mavloom::simserve
