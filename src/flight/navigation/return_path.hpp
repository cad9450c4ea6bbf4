// SPDX-License-Identifier: MIT
// The way home: climb, fly, descend, wait, land. Private to flight; single owner; only texts allocate.
// Source: PX4 user guide, "Return Mode".
#pragma once

#include "flight/navigation/guidance.hpp"

namespace mavloom::flight {

class ReturnPath {
public:
    ReturnPath(FlightContext& context, Guidance& guidance) noexcept : context_(context), guidance_(guidance) {}

    void begin();
    void update();
    // True once the vehicle is home: it has landed there, or stays there.
    [[nodiscard]] bool is_done() const noexcept;

private:
    enum class Phase : std::uint8_t { climb, fly, descend, wait, land };

    [[nodiscard]] const Vector3& home() const noexcept { return context_.craft.home_place(); }
    [[nodiscard]] double return_z() const;
    void enter(Phase phase);

    FlightContext& context_;
    Guidance& guidance_;
    Phase phase_ = Phase::climb;
    FlightTime since_{};
};

}  // namespace mavloom::flight
