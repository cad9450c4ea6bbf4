// SPDX-License-Identifier: MIT
// A PX4's report of its readiness: in which modes it can arm and fly, what prevents the others, and the state of its
// components. Private to module sim; a pure function of the vehicle's state.
//
// Bits, ids and the order of problems are those of a recorded PX4 1.17.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "flight/flight.hpp"

namespace mavloom::sim {

struct HealthProblem {
    std::uint32_t event = 0;
    std::uint32_t modes = 0;     // bits of navigation_mode_group_t
    std::uint8_t component = 0;  // number of a bit of health_component_t
    bool has_instance = false;   // the event has the number of a sensor as third argument

    friend constexpr bool operator==(const HealthProblem&, const HealthProblem&) = default;
};

struct HealthReport {
    // Bits of health_component_t.
    std::uint32_t present = 0, health_errors = 0, arming_errors = 0, arming_warnings = 0;
    std::uint32_t can_arm = 0, can_run = 0;  // bits of navigation_mode_group_t
    std::array<HealthProblem, 20> problems{};
    std::size_t count = 0;  // of problems

    [[nodiscard]] std::span<const HealthProblem> all() const noexcept { return {problems.data(), count}; }
    friend constexpr bool operator==(const HealthReport&, const HealthReport&) = default;
};

// `has_audience`: a ground station was heard on an open link.
[[nodiscard]] HealthReport health_report(const flight::Flight& flight, bool has_audience);

}  // namespace mavloom::sim
