// SPDX-License-Identifier: MIT
// Inputs that clients must repeat, each with the time of its last arrival (FlightContext::input_time()). Private to
// flight; single owner; plain values.
#pragma once

#include <optional>

#include "flight/orders.hpp"
#include "mavloom/flight/moment.hpp"

namespace mavloom::flight {

// The newest value of an input, with its time.
template <class Value>
class Repeated {
public:
    void put(const Value& value, Nanoseconds now) noexcept {
        value_ = value;
        at_ = now;
    }
    void forget() noexcept { value_.reset(); }
    [[nodiscard]] bool was_heard() const noexcept { return value_.has_value(); }
    [[nodiscard]] bool is_fresh(Nanoseconds now, double seconds) const noexcept {
        return value_ && std::chrono::duration<double>(now - at_).count() <= seconds;
    }
    [[nodiscard]] const std::optional<Value>& value() const noexcept { return value_; }

private:
    std::optional<Value> value_;
    Nanoseconds at_{};
};

struct GroundStationSign {};

struct Inputs {
    Repeated<Sticks> sticks;
    Repeated<OffboardSetpoint> offboard;
    Repeated<GroundStationSign> ground_station;
};

// Limits `value` to -`most` to `most`; NaN and infinities become NaN.
[[nodiscard]] double bounded(double value, double most) noexcept;
// An input of a client with every number bounded: NaN and infinities mean "not given".
[[nodiscard]] Sticks bounded(const Sticks& sticks) noexcept;
// Returns nothing if the set-point has no effect.
[[nodiscard]] std::optional<OffboardSetpoint> bounded(const OffboardSetpoint& setpoint) noexcept;

}  // namespace mavloom::flight
