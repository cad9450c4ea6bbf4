// SPDX-License-Identifier: MIT
// The failures that MAV_CMD_INJECT_FAILURE has injected, by the rules of PX4's failure_injection_manager: pairs of a
// unit and a failure type, each with a set of instances, four pairs at most. Private to module sim; single owner;
// nothing allocates but the texts.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "flight/orders.hpp"
#include "flight/physics/failures.hpp"

namespace mavloom::sim {

class FailureTable {
public:
    // Bits of instances: the first is bit 0.
    static constexpr std::uint16_t all_instances = 0xffff;
    // 0 is all. Beyond 16 there is none.
    [[nodiscard]] static constexpr std::uint16_t instance(std::uint32_t number) noexcept {
        if (number == 0) return all_instances;
        return number > 16 ? std::uint16_t{0} : static_cast<std::uint16_t>(1u << (number - 1));
    }

    // `type` FAILURE_TYPE_OK ends all failures of these instances. An instance has one failure of its unit at a time.
    // Returns accepted, unsupported, or temporarily_rejected: a fifth pair.
    [[nodiscard]] flight::Result inject(std::uint32_t unit, std::uint32_t type, std::uint16_t instances) noexcept;
    void clear() noexcept { count_ = 0; }

    // The text that PX4 sends: "Injected: motor off, instances 1,3".
    [[nodiscard]] static std::string text(std::uint32_t unit, std::uint32_t type, std::uint16_t instances);
    // Each pair: "motor off, instances 1,3".
    [[nodiscard]] std::vector<std::string> texts() const;
    // Of sensors and batteries, a vehicle has the first instance only.
    [[nodiscard]] flight::Failures failures() const noexcept;

private:
    struct Entry {
        std::uint32_t unit = 0, type = 0;
        std::uint16_t instances = 0;
    };
    void remove(std::uint32_t unit, std::uint16_t instances) noexcept;
    [[nodiscard]] flight::Failure first_of(std::uint32_t unit) const noexcept;
    [[nodiscard]] std::uint16_t instances_of(std::uint32_t unit, std::uint32_t type) const noexcept;

    static constexpr std::size_t most = 4;
    std::array<Entry, most> entries_{};
    std::size_t count_ = 0;
};

}  // namespace mavloom::sim
