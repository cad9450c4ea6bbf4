// SPDX-License-Identifier: MIT
// The state that the parts of Flight share: the craft, the firmware's numbers and texts, the plans and the observer.
// Private to flight; single owner.
#pragma once

#include <optional>
#include <string_view>

#include "flight/craft.hpp"
#include "flight/firmware/firmware.hpp"
#include "flight/orders.hpp"
#include "flight/state.hpp"

namespace mavloom::flight {

struct FlightContext {
    const VehicleOptions& options;
    const Firmware& firmware;
    FlightObserver& observer;
    Craft craft;
    Tuning tuning;
    Plans plans;
    // Written by Commander and LandedDetector; all others read them.
    bool armed = false;
    FlightTime armed_at{};
    LandedState landed = LandedState::on_ground;
    // The real time, if the owner passes it.
    std::optional<Nanoseconds> real{};

    [[nodiscard]] Kind kind() const noexcept { return options.kind; }
    [[nodiscard]] FlightTime now() const noexcept { return craft.since_boot(); }
    // The clock for inputs that clients must repeat. Clients repeat them in real time, however fast the flight clock
    // runs.
    [[nodiscard]] Nanoseconds input_time() const noexcept { return real.value_or(now()); }
    [[nodiscard]] double seconds_since(FlightTime time) const noexcept {
        return std::chrono::duration<double>(now() - time).count();
    }
    [[nodiscard]] const Texts& texts() const noexcept { return firmware.texts(); }
    [[nodiscard]] bool is_on_ground() const noexcept { return landed == LandedState::on_ground; }

    // Announces a text of the firmware. Does nothing for an empty text.
    void say(Severity severity, std::string_view text) const;
    // Announces the text, if there is one, and returns the refusal.
    [[nodiscard]] Outcome refuse(Result result, std::string_view text, std::string_view value = {},
                                 Severity severity = Severity::critical) const;
};

// Returns the text with its first `{}` replaced by `value`.
[[nodiscard]] std::string filled(std::string_view text, std::string_view value);

}  // namespace mavloom::flight
