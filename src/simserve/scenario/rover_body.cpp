// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>
#include <utility>

#include "mavloom/flight/body.hpp"
#include "simserve/scenario/body.hpp"
#include "simserve/scenario/named_numbers.hpp"

namespace mavloom::simserve {

namespace {

using sim::RoverBody;

using RoverNumber = NamedNumber<RoverBody>;
constexpr Range radius_range{0.1, 50}, wheel_base_range{0.02, 20}, steering_range{2, 70};
constexpr std::array rover_numbers{
    RoverNumber{"mass", {0.05, 5000}, [](RoverBody& b) -> double& { return b.mass_kg; }},
    RoverNumber{"thrust", {0.05, 100'000}, [](RoverBody& b) -> double& { return b.thrust_n; }},
    RoverNumber{"top_speed", {0.3, 60}, [](RoverBody& b) -> double& { return b.top_speed_m_s; }},
    RoverNumber{"turn_radius", radius_range, [](RoverBody& b) -> double& { return b.turn_radius_m; }},
    RoverNumber{"grip", {0.5, 20}, [](RoverBody& b) -> double& { return b.grip_m_s2; }},
    RoverNumber{"steering_lag", {0.02, 2}, [](RoverBody& b) -> double& { return b.steering_lag_s; }},
};

tl::unexpected<SetupError> rover_error(std::string text) { return setup_error(SetupCode::usage, std::move(text)); }

// The wheel base and the greatest angle of the front wheels set the turn radius.
SetupResult<void> set_wheels(RoverBody& body, const std::vector<NamedPart>& parts) {
    const auto wheel_base = find_part(parts, "wheel_base"), steering = find_part(parts, "steering");
    if (!wheel_base && !steering) return {};
    if (!wheel_base || !steering || find_part(parts, "turn_radius"))
        return rover_error("wheel_base and steering come together, in the place of turn_radius");
    const auto length = parse_number(*wheel_base, wheel_base_range);
    if (!length) return tl::unexpected(SetupError(length.error()).within("wheel_base"));
    const auto angle = parse_number(*steering, steering_range);
    if (!angle) return tl::unexpected(SetupError(angle.error()).within("steering"));
    body.turn_radius_m = flight::turn_radius(*length, *angle);
    if (body.turn_radius_m >= radius_range.least && body.turn_radius_m <= radius_range.most) return {};
    return rover_error(fmt::format("its turn radius is {:.2f} m by wheel_base and steering; {} to {} m is possible",
                                   body.turn_radius_m, radius_range.least, radius_range.most));
}

// The steps are short against the lag of its speed, and it moves at all.
SetupResult<void> check_rover(const RoverBody& body) {
    constexpr double weakest = 0.3, quickest = 50;  // m/s^2, 1/s
    const double pull = body.thrust_n / body.mass_kg;
    if (pull < weakest)
        return rover_error(fmt::format("its thrust accelerates it by {:.2f} m/s^2; at least {}", pull, weakest));
    if (pull > quickest * body.top_speed_m_s)
        return rover_error(fmt::format(
            "its thrust accelerates it by {:.0f} m/s^2, too much for its top speed of {} m/s", pull, body.top_speed_m_s));
    return {};
}

}  // namespace

SetupResult<RoverBody> parse_rover(std::string_view text) {
    const auto parts = named_parts_of(text);
    if (!parts) return tl::unexpected(parts.error());
    const auto preset = preset_index(*parts, sim::rover_names);
    if (!preset) return tl::unexpected(preset.error());
    RoverBody body = body_of(static_cast<sim::RoverPreset>(*preset));
    if (auto done = set_named_numbers<RoverBody>(body, *parts, rover_numbers, {preset_name, "wheel_base", "steering"});
        !done)
        return tl::unexpected(std::move(done.error()));
    if (auto done = set_wheels(body, *parts); !done) return tl::unexpected(std::move(done.error()));
    if (auto done = check_rover(body); !done) return tl::unexpected(std::move(done.error()));
    return body;
}

}  // namespace mavloom::simserve
