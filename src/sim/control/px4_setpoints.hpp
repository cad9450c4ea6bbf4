// SPDX-License-Identifier: MIT
// What PX4 does with set-points of clients. Private to module sim; single owner. Source: PX4 guide, "Offboard Mode".
//
// A field counts as not given if the message's mask excludes it, or if it is NaN. A message without a given field, or
// with an infinite one, has no effect. The vehicle reports that by a text, at most once a second.
#pragma once

#include <string_view>

#include "flight/flight.hpp"
#include "flight/orders.hpp"
#include "sim/service/service.hpp"
#include "sim/service/text_limit.hpp"

namespace mavloom::sim {

class Px4Setpoints {
public:
    Px4Setpoints(Flight& flight, FlightObserver& observer) noexcept : flight_(flight), observer_(observer) {}

    void on_local_target(ByteView payload, Moment now);
    void on_global_target(ByteView payload, Moment now);
    void on_attitude_target(ByteView payload, Moment now);
    void on_actuator_target(ByteView payload, Moment now);

private:
    void follow(const OffboardSetpoint& setpoint, std::string_view message, Moment now);
    void reject(std::string_view message, Moment now);

    Flight& flight_;
    FlightObserver& observer_;
    TextLimit texts_;  // about rejected messages
};

}  // namespace mavloom::sim
