// SPDX-License-Identifier: MIT
// The faults that the operator of a simulator has set. Private to flight, sim and hil; single owner. They stay over a
// reboot, as broken hardware does.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "flight/physics/failures.hpp"
#include "flight/plant/plant.hpp"
#include "mavloom/flight/fault.hpp"

namespace mavloom::flight {

// Why it cannot be a fault of a vehicle with these channels: it has no such motor. Empty if it has.
[[nodiscard]] std::string motor_refusal(const Fault& fault, const Channels& channels);

class Faults {
public:
    // Only for a fault that lasts. A part has one at a time; each motor and each ESC has its own. "ok" ends those of
    // its part, or of its motor: after a fault of all motors, it stays as the exception from it.
    void set(const Fault& fault);

    [[nodiscard]] Failures failures() const noexcept;
    [[nodiscard]] Deceptions deceptions() const noexcept;
    // All of them, in the order in which they were set.
    [[nodiscard]] std::span<const Fault> list() const noexcept { return faults_; }
    // True if the part has a fault that is neither a failure nor a deception: a heartbeat or radio that is off.
    [[nodiscard]] bool has(FaultPart part) const noexcept;

private:
    std::vector<Fault> faults_;
};

}  // namespace mavloom::flight
