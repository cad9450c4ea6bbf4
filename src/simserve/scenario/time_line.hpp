// SPDX-License-Identifier: MIT
// The orders of a scenario's time line: requests of `mavloom ctl` at times of the flight. Private to module simserve.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mavloom/simserve/simulator.hpp"

namespace mavloom::simserve {

// The request of "takeoff 20" is {"cmd":"takeoff","altitude":20}. `system`: only for this vehicle. An unknown order or
// a wrong argument is an error (`usage`).
[[nodiscard]] SetupResult<std::string> request_of_order(std::string_view words, std::optional<SystemId> system);

// PART FAULT of the order "fail PART FAULT"; empty for other orders.
[[nodiscard]] std::optional<std::string> fault_of_order(std::string_view words);

// Why a request was refused; empty if it was executed. Formats the report.
[[nodiscard]] std::string error_of(const control::Report& report);

class TimeLine {
public:
    explicit TimeLine(std::vector<TimedOrder> orders) : orders_(std::move(orders)) {
        std::ranges::stable_sort(orders_, {}, &TimedOrder::at);
    }
    // FlightTime::max() if nothing follows.
    [[nodiscard]] sim::FlightTime next_due() const noexcept {
        return next_ == orders_.size() ? sim::FlightTime::max() : orders_[next_].at;
    }
    // Call it only if something is due.
    [[nodiscard]] const TimedOrder& take() noexcept { return orders_[next_++]; }

private:
    std::vector<TimedOrder> orders_;
    std::size_t next_ = 0;
};

}  // namespace mavloom::simserve
