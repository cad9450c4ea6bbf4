// SPDX-License-Identifier: MIT
// A scenario: which vehicles a simulator has, where they are, and where they send. Its values come from defaults, a
// TOML file, the environment and options; each of these overrides those before it.
//
// The keys are in docs/guide/sim.md. An unknown section, key or value is an error that states its place and the nearest
// known spelling. Plain values; reading allocates.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mavloom/config/config.hpp"
#include "mavloom/config/document.hpp"
#include "mavloom/hil/sensor_rates.hpp"
#include "mavloom/hil/timed_fault.hpp"
#include "mavloom/sim/vehicle.hpp"
#include "mavloom/simserve/simulator.hpp"

namespace mavloom::simserve {

struct ScenarioVehicle {
    sim::VehicleOptions options;  // of the first vehicle
    std::size_t count = 1;        // the vehicles have consecutive system ids and stand on a grid
    std::vector<std::pair<std::string, double>> parameters{};
    bool has_own_place = false;  // false: it shares the grid around the default home with others
};

struct Scenario {
    std::string name;  // empty: the ring's name, or "sim" without a ring
    std::uint64_t seed = 1;
    double speed = 1;
    std::optional<sim::Profile> profile{};
    std::vector<sim::MessageRate> rates{};
    std::optional<Nanoseconds> duration{};  // empty: until a signal
    WallTime start_time{};                  // UTC at flight time 0; the epoch: when the simulator starts
    std::string recording;                  // path of the tlog file that the vehicles send to; empty: none
    std::string input_recording, input;     // paths of tlog files: what they receive is written; is read
    std::vector<TimedOrder> orders{};
    bool has_report = false;
    config::RingConfig ring{};  // without a name: no ring
    std::optional<endpoint::HostPort> metrics{};
    config::WebConfig web{};
    std::vector<ScenarioVehicle> vehicles{};
    std::vector<SimEndpoint> endpoints{};
    std::optional<endpoint::Endpoint> hil{};  // where the first vehicle's autopilot connects; empty: vehicles fly alone
    hil::SensorRates hil_rates{};

    std::vector<config::Section> sections{};  // all of the above as text, for `mavloom check`
    std::vector<std::string> notes{};         // anything unusual that is not an error

    // The options of every vehicle, with its place and seed.
    [[nodiscard]] std::vector<ScenarioVehicle> each_vehicle() const;
    [[nodiscard]] std::string control_name() const;
    // The endpoint of each vehicle's autopilot, in the order of `each_vehicle`: the ports follow each other.
    [[nodiscard]] std::vector<endpoint::Endpoint> hil_endpoints() const;
    // The faults that a vehicle with `hil` gets, in the order of their times.
    [[nodiscard]] std::vector<hil::TimedFault> hil_faults(SystemId system) const;
    // Its vehicles send to a recording only.
    [[nodiscard]] bool only_records() const noexcept {
        return !recording.empty() && endpoints.empty() && ring.name.empty();
    }
    // See SimulatorOptions.
    [[nodiscard]] bool is_repeatable() const noexcept {
        return !input_recording.empty() || !input.empty() || only_records();
    }
    // Whether `duration` is a time of the flight.
    [[nodiscard]] bool ends_by_flight() const noexcept { return speed == max_speed || is_repeatable(); }
};

using config::Override;

// True if the file is a scenario and not a router's configuration: it has [sim], [streams], [[vehicle]] or [[event]].
[[nodiscard]] bool is_scenario(const config::Document& document) noexcept;

// Without [[vehicle]] there is one vehicle of the default kind. An override of a key of [[vehicle]] applies to all of
// them. Errors are `bad_input` for a file or variable, `usage` for an override.
[[nodiscard]] SetupResult<Scenario> read_scenario(const config::Document& document,
                                                  const config::Environment& environment,
                                                  std::span<const Override> overrides);

// Runs every check of a scenario that needs no socket: endpoints, ports, key files, parameters. Errors are as above.
[[nodiscard]] SetupResult<void> check_scenario(const Scenario& scenario, const config::Document& document);

// Completes a scenario with `hil` by PX4's own variables: PX4_HOME_LAT, PX4_HOME_LON, PX4_HOME_ALT and
// PX4_SIM_SPEED_FACTOR, which count if the scenario does not set `home` and `speed`. Refuses what a scenario with `hil`
// cannot have, and without `hil` what is for it only. Errors are as those of read_scenario.
[[nodiscard]] SetupResult<void> complete_hil(Scenario& scenario, const config::Document& document,
                                             const config::Environment& px4);
inline constexpr std::string_view px4_prefix = "PX4_";  // of these variables

}  // namespace mavloom::simserve
