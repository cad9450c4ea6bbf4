// SPDX-License-Identifier: MIT
// The battery. Its charge falls by the integral of the current; its voltage depends on charge and current. Private to
// flight and sim; single owner; nothing allocates.
#pragma once

#include "mavloom/flight/options.hpp"

namespace mavloom::flight {

class Battery {
public:
    // `charges_at_rest`: PX4's simulated battery is soon full again, and draws a little current all the time.
    // ArduPilot's keeps its charge, and draws no current while the motors stand still.
    Battery(const BatteryOptions& options, bool charges_at_rest) noexcept;

    // `load` as in Plant::load.
    void step(double load, double dt) noexcept;
    // Sets the charge to `share` (0 to 1). Until `restore`, `rest` stops at that level. For tests of fail-safes.
    void set_remaining(double share) noexcept;
    // It reports that it is empty, and carries the vehicle all the same.
    void report_empty(bool is_empty) noexcept { reports_empty_ = is_empty; }
    // After `set_remaining`, the charge is that at the start. Otherwise nothing changes.
    void restore() noexcept;
    // Call it while the vehicle is disarmed: charges for `dt` seconds, up to the charge at the start.
    void rest(double dt) noexcept;
    // After a boot: all is as at the start.
    void replace() noexcept;

    [[nodiscard]] std::uint8_t cells() const noexcept { return cells_; }
    [[nodiscard]] double remaining() const noexcept { return reports_empty_ ? 0 : charge(); }  // 0 to 1, as reported
    [[nodiscard]] double current() const noexcept { return current_; }                         // A
    [[nodiscard]] double voltage() const noexcept;  // V, of all cells, under the current load
    [[nodiscard]] double used_mah() const noexcept { return used_mah_; }
    [[nodiscard]] double used_joule() const noexcept { return used_joule_; }
    [[nodiscard]] double capacity_mah() const noexcept { return capacity_mah_; }
    // Seconds until empty at the average current; 0 if unknown.
    [[nodiscard]] double seconds_left() const noexcept;
    // Voltage relative to a full battery at rest; 0 if empty.
    [[nodiscard]] double supply() const noexcept;

private:
    [[nodiscard]] double charge() const noexcept;  // 0 to 1

    double capacity_mah_, hover_current_, idle_current_;  // A
    bool charges_at_rest_;
    double used_at_start_;  // never changes
    double used_mah_, used_after_rest_, used_joule_ = 0, current_ = 0, average_current_ = 0;
    std::uint8_t cells_;
    bool reports_empty_ = false;
};

}  // namespace mavloom::flight
