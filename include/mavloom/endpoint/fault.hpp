// SPDX-License-Identifier: MIT
// Parses what a link shall do wrong on purpose: "loss:0.05/8,delay:80ms~20ms" (docs/guide/faults.md). The results are
// plain values; module `fault` obeys them. Pure functions, safe from any thread. Errors are `usage`.
#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "mavloom/base/result.hpp"

namespace mavloom::endpoint {

struct EndpointOptions;
struct SchemeRow;

// The last `length` of each `every`, counted from the first piece of the link's direction. Zero: never.
struct Episodes {
    std::chrono::nanoseconds length{}, every{};
    friend bool operator==(const Episodes&, const Episodes&) = default;
};

// The faults of one direction of a link, in the order in which they happen. A piece is what the link moves at once:
// docs/guide/faults.md. Shares are from 0 to 1; 0 switches a fault off.
struct Faults {
    std::string text{};  // as it was typed; empty: none
    Episodes blackout{};
    double loss = 0;   // share of pieces
    double burst = 0;  // mean number of pieces lost in a row, at least 1. 0: each is lost or not on its own.
    double duplicate = 0, corrupt = 0, cut = 0;
    std::chrono::nanoseconds delay{}, jitter{};  // from delay - jitter to delay + jitter
    Episodes stall{};
    double reorder = 0;
    std::chrono::nanoseconds reorder_by{};
    std::uint64_t rate_bytes_s = 0, rate_queue_bytes = 0;

    [[nodiscard]] bool any() const noexcept;
    friend bool operator==(const Faults&, const Faults&) = default;
};

struct FaultPreset {
    std::string_view name, faults;
};
[[nodiscard]] std::span<const FaultPreset> fault_presets() noexcept;

// Parses [PRESET,]FAULT:VALUE,... or "off". The error quotes the wrong term, and suggests the nearest name.
[[nodiscard]] SetupResult<Faults> parse_faults(std::string_view text);
[[nodiscard]] SetupResult<std::uint64_t> parse_fault_seed(std::string_view text);
// Refuses faults that need a byte stream, for a scheme that has none.
[[nodiscard]] SetupResult<void> check_faults(const Faults& faults, const SchemeRow& scheme);

// The faults that the options ask for: `in_fault`, or else `fault`.
[[nodiscard]] const Faults& inward_faults(const EndpointOptions& options) noexcept;
[[nodiscard]] const Faults& outward_faults(const EndpointOptions& options) noexcept;

}  // namespace mavloom::endpoint
