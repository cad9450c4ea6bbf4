// SPDX-License-Identifier: MIT
// Servo outputs that clients set themselves: DO_SET_SERVO, DO_SET_ACTUATOR, relays. Private to module sim; a plain
// value.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace mavloom::sim {

class ServoOutputs {
public:
    static constexpr std::size_t count = 16, relays = 6;
    // The first channel of the six actuators of DO_SET_ACTUATOR: the first auxiliary output.
    static constexpr std::size_t first_actuator = 9, actuators = 6;

    // Channels count from 1. Returns false if there is no such channel, or if no servo understands this pulse.
    bool set_pulse(double channel, double microseconds) noexcept {
        const bool is_valid = channel >= 1 && channel <= count && microseconds >= 500 && microseconds <= 2500;
        if (is_valid) pulses_[static_cast<std::size_t>(channel) - 1] = static_cast<std::uint16_t>(microseconds);
        return is_valid;
    }
    // `value` is -1 to 1; any other value is ignored. Actuators count from 0.
    void set_actuator(std::size_t actuator, double value) noexcept {
        if (std::abs(value) <= 1 && actuator < actuators)
            pulses_[first_actuator - 1 + actuator] = static_cast<std::uint16_t>(std::lround(1500 + 500 * value));
    }
    bool set_relay(double relay, double state) noexcept {
        const bool is_valid = relay >= 0 && relay < relays && state >= 0 && state <= 1;
        if (is_valid) relays_[static_cast<std::size_t>(relay)] = state >= 0.5;
        return is_valid;
    }
    // In microseconds, from channel 1; 0: no client has set it.
    [[nodiscard]] const std::array<std::uint16_t, count>& pulses() const noexcept { return pulses_; }
    [[nodiscard]] bool relay(std::size_t relay) const noexcept { return relays_[relay]; }

private:
    std::array<std::uint16_t, count> pulses_{};
    std::array<bool, relays> relays_{};
};

}  // namespace mavloom::sim
