// SPDX-License-Identifier: MIT
// Faults of a vehicle on purpose, by name: "gps off", "motor off 1". docs/guide/sim.md lists them. Plain values.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace mavloom::flight {

enum class FaultPart : std::uint8_t {
    gyroscope,
    accelerometer,
    compass,
    barometer,
    gps,
    rangefinder,
    airspeed,
    battery,
    motor,
    esc,
    heartbeat,
    radio,
    sequence,
    autopilot,
    all,
};
enum class FaultKind : std::uint8_t { ok, off, stuck, wrong, jump, drift, turn, charge, restart };

inline constexpr std::string_view fault_part_names[] = {"gyroscope",   "accelerometer", "compass",  "barometer", "gps",
                                                        "rangefinder", "airspeed",      "battery",  "motor",     "esc",
                                                        "heartbeat",   "radio",         "sequence", "autopilot", "all"};
inline constexpr std::string_view fault_kind_names[] = {"ok",    "off",  "stuck",  "wrong",  "jump",
                                                        "drift", "turn", "charge", "restart"};

// A fault that a part can have, and how many numbers it takes.
struct FaultForm {
    FaultPart part{};
    FaultKind kind{};
    std::size_t fewest = 0, most = 0;
    double lowest = 0, highest = 0;  // of the numbers
    std::string_view usage{};        // of the numbers
};
[[nodiscard]] std::span<const FaultForm> fault_forms() noexcept;

struct Fault {
    FaultPart part{};
    FaultKind kind{};
    std::array<double, 2> numbers{};
    std::size_t count = 0;  // of numbers
};
// As users write it: "gps off", "motor off 1".
[[nodiscard]] std::string text_of(const Fault& fault);

}  // namespace mavloom::flight
