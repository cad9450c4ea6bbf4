// SPDX-License-Identifier: MIT
// The parts of an Inspector that read single messages, and which message goes to which part. Private to module observe.
#pragma once

#include <cstdint>

#include "mavloom/observe/alarm.hpp"
#include "mavloom/observe/latest_table.hpp"
#include "mavloom/observe/round_trips.hpp"
#include "mavloom/observe/vehicle_table.hpp"
#include "observe/clock_rules.hpp"
#include "observe/loss_rules.hpp"
#include "observe/vehicle_rules.hpp"

namespace mavloom::observe {

struct Parts {
    const dialect::Dialect& dialect;
    VehicleTable vehicles{};
    RoundTrips round_trips{};
    Alarms alarms{};
    ClockRules clocks{};
    LossRules losses{};
    HealthRule health{};
    TextRule texts{};
};

// Which function takes the message, as a number for LatestRow::tag. 0: none.
[[nodiscard]] std::uint8_t handler_of(const LatestRow& row) noexcept;
// The row has a new latest message. `sender` is null if it has not sent HEARTBEATs.
void handle(Parts& parts, const LatestRow& row, Vehicle* sender, const Moment& at);

}  // namespace mavloom::observe
