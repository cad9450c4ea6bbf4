// SPDX-License-Identifier: MIT
#include "simserve/scenario/noise.hpp"

#include <array>

#include "simserve/scenario/named_numbers.hpp"

namespace mavloom::simserve {

namespace {

using sim::NoiseOptions;

using NoiseNumber = NamedNumber<NoiseOptions>;
constexpr Range correlation{0, 100};  // s
constexpr std::array noise_numbers{
    NoiseNumber{"accelerometer", {0, 10}, [](NoiseOptions& n) -> double& { return n.accelerometer; }},
    NoiseNumber{"gyroscope", {0, 5}, [](NoiseOptions& n) -> double& { return n.gyroscope; }},
    NoiseNumber{"magnetometer", {0, 1}, [](NoiseOptions& n) -> double& { return n.magnetometer; }},
    NoiseNumber{"magnetometer_z", {0, 1}, [](NoiseOptions& n) -> double& { return n.magnetometer_z; }},
    NoiseNumber{"pressure", {0, 1000}, [](NoiseOptions& n) -> double& { return n.pressure; }},
    NoiseNumber{"airspeed", {0, 20}, [](NoiseOptions& n) -> double& { return n.airspeed; }},
    NoiseNumber{"gps", {0, 1000}, [](NoiseOptions& n) -> double& { return n.gps; }},
    NoiseNumber{"gps_down", {0, 1000}, [](NoiseOptions& n) -> double& { return n.gps_down; }},
    NoiseNumber{"gps_time", correlation, [](NoiseOptions& n) -> double& { return n.gps_time; }},
    NoiseNumber{"gps_velocity", {0, 100}, [](NoiseOptions& n) -> double& { return n.gps_velocity; }},
    NoiseNumber{"gps_climb", {0, 100}, [](NoiseOptions& n) -> double& { return n.gps_climb; }},
    NoiseNumber{"gps_velocity_time", correlation, [](NoiseOptions& n) -> double& { return n.gps_velocity_time; }},
};

SetupResult<NoiseOptions> parse_noise(std::string_view text) {
    const auto parts = named_parts_of(text);
    if (!parts) return tl::unexpected(parts.error());
    const auto preset = preset_index(*parts, sim::noise_names);
    if (!preset) return tl::unexpected(preset.error());
    NoiseOptions noise = noise_of(static_cast<sim::NoisePreset>(*preset));
    if (auto done = set_named_numbers<NoiseOptions>(noise, *parts, noise_numbers, {preset_name}); !done)
        return tl::unexpected(std::move(done.error()));
    return noise;
}

}  // namespace

SetupResult<void> set_noise(std::string_view text, sim::VehicleOptions& options) {
    options.has_noise = text != "false";
    options.noise = {};
    if (text == "false" || text == "true") return {};
    return parse_noise(text).map([&](const NoiseOptions& noise) { options.noise = noise; });
}

}  // namespace mavloom::simserve
