// SPDX-License-Identifier: MIT
// The tables of scenario keys: name, default, and how to parse the text. Private to module simserve.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "mavloom/simserve/scenario.hpp"

namespace mavloom::simserve {

template <class Target>
struct Key {
    std::string_view name;
    std::string_view default_text;  // empty: not set
    SetupResult<void> (*set)(Target&, std::string_view);
};

inline constexpr std::string_view sim_section = "sim", web_section = "web", vehicle_section = "vehicle",
                                  streams_section = "streams", endpoint_section = "endpoint", event_section = "event";

// An event of the time line, as the file states it.
struct ScenarioEvent {
    Nanoseconds at{};
    std::string words{};
    std::optional<SystemId> system{};
};

[[nodiscard]] std::span<const Key<Scenario>> sim_keys() noexcept;
[[nodiscard]] std::span<const Key<Scenario>> web_keys() noexcept;
[[nodiscard]] std::span<const Key<ScenarioVehicle>> vehicle_keys() noexcept;
[[nodiscard]] std::span<const Key<ScenarioEvent>> event_keys() noexcept;

// Adds a rate of [streams] or of an endpoint's `streams`. A message that vehicles do not stream is an error.
[[nodiscard]] SetupResult<void> add_rate(std::vector<sim::MessageRate>& rates, std::string_view message,
                                         std::string_view hz);

}  // namespace mavloom::simserve
