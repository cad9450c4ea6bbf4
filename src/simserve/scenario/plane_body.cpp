// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "simserve/scenario/body.hpp"
#include "simserve/scenario/named_numbers.hpp"

namespace mavloom::simserve {

namespace {

using sim::PlaneBody;

using PlaneNumber = NamedNumber<PlaneBody>;
constexpr Range turning_inertia{1e-4, 10'000}, any_damping{0, 100}, any_stiffness{0, 10}, any_deflection{0.001, 5};
constexpr std::array plane_numbers{
    PlaneNumber{"mass", {0.05, 500}, [](PlaneBody& b) -> double& { return b.mass_kg; }},
    PlaneNumber{"inertia_x", turning_inertia, [](PlaneBody& b) -> double& { return b.inertia_kg_m2[0]; }},
    PlaneNumber{"inertia_y", turning_inertia, [](PlaneBody& b) -> double& { return b.inertia_kg_m2[1]; }},
    PlaneNumber{"inertia_z", turning_inertia, [](PlaneBody& b) -> double& { return b.inertia_kg_m2[2]; }},
    PlaneNumber{"area", {0.01, 100}, [](PlaneBody& b) -> double& { return b.area_m2; }},
    PlaneNumber{"span", {0.2, 50}, [](PlaneBody& b) -> double& { return b.span_m; }},
    PlaneNumber{"chord", {0.02, 10}, [](PlaneBody& b) -> double& { return b.chord_m; }},
    PlaneNumber{"lift_zero", {-0.5, 1.5}, [](PlaneBody& b) -> double& { return b.lift_zero; }},
    PlaneNumber{"lift_slope", {1, 7}, [](PlaneBody& b) -> double& { return b.lift_slope; }},
    PlaneNumber{"stall", {10, 30}, [](PlaneBody& b) -> double& { return b.stall_deg; }},
    PlaneNumber{"drag", {0.001, 1}, [](PlaneBody& b) -> double& { return b.drag_zero; }},
    PlaneNumber{"induced", {0, 1}, [](PlaneBody& b) -> double& { return b.induced; }},
    PlaneNumber{"side_force", {0, 5}, [](PlaneBody& b) -> double& { return b.side_slope; }},
    PlaneNumber{"thrust", {0.1, 10'000}, [](PlaneBody& b) -> double& { return b.thrust_n; }},
    PlaneNumber{"pitch_speed", {5, 200}, [](PlaneBody& b) -> double& { return b.pitch_speed_m_s; }},
    PlaneNumber{"spin", {0.02, 2}, [](PlaneBody& b) -> double& { return b.spin_s; }},
    PlaneNumber{"roll_damping", any_damping, [](PlaneBody& b) -> double& { return b.roll_damping; }},
    PlaneNumber{"pitch_damping", any_damping, [](PlaneBody& b) -> double& { return b.pitch_damping; }},
    PlaneNumber{"yaw_damping", any_damping, [](PlaneBody& b) -> double& { return b.yaw_damping; }},
    PlaneNumber{"pitch_stiffness", any_stiffness, [](PlaneBody& b) -> double& { return b.pitch_stiffness; }},
    PlaneNumber{"yaw_stiffness", any_stiffness, [](PlaneBody& b) -> double& { return b.yaw_stiffness; }},
    PlaneNumber{"trim", {-5, 10}, [](PlaneBody& b) -> double& { return b.trim_deg; }},
    PlaneNumber{"ailerons", any_deflection, [](PlaneBody& b) -> double& { return b.full_ailerons; }},
    PlaneNumber{"elevator", any_deflection, [](PlaneBody& b) -> double& { return b.full_elevator; }},
    PlaneNumber{"rudder", any_deflection, [](PlaneBody& b) -> double& { return b.full_rudder; }},
    PlaneNumber{"turn_radius", {1, 50}, [](PlaneBody& b) -> double& { return b.turn_radius_m; }},
};

constexpr double earth_gravity = 9.80665;
constexpr double slow_flight = 1.3;  // times the stall speed: the least at which a pilot flies

// Level flight at this speed, at sea level.
struct LevelFlight {
    double speed, pressure, lift, drag, attack_deg;
};
LevelFlight level_at(const PlaneBody& body, double speed) {
    const double pressure = 0.5 * flight::sea_level_density * speed * speed;
    const double lift = body.mass_kg * earth_gravity / (pressure * body.area_m2);
    return {.speed = speed,
            .pressure = pressure,
            .lift = lift,
            .drag = pressure * body.area_m2 * (body.drag_zero + body.induced * lift * lift),
            .attack_deg = (lift - body.lift_zero) / body.lift_slope * (180 / std::numbers::pi)};
}

tl::unexpected<SetupError> plane_error(std::string text) { return setup_error(SetupCode::usage, std::move(text)); }

SetupResult<void> check_speeds(const PlaneBody& body) {
    constexpr double slowest = 3, fastest = 40;
    if (highest_lift(body) < 0.3)
        return plane_error(fmt::format("its greatest lift coefficient is {:.2f}; at least 0.3", highest_lift(body)));
    const double stall = stall_speed(body);
    if (stall >= slowest && stall <= fastest) return {};
    return plane_error(fmt::format("it stalls at {:.1f} m/s, by its mass, area and lift; {} to {} m/s is possible",
                                   stall, slowest, fastest));
}

SetupResult<void> check_climb(const PlaneBody& body) {
    constexpr double steep = 0.05;  // of the weight that must be left for the climb
    const auto level = level_at(body, slow_flight * stall_speed(body));
    const double thrust = body.thrust_n * std::max(1 - level.speed / body.pitch_speed_m_s, 0.0);
    if (thrust > level.drag + steep * body.mass_kg * earth_gravity) return {};
    return plane_error(
        fmt::format("at {:.1f} m/s its motor pulls {:.1f} N, and its drag is {:.1f} N; more thrust or less mass, so "
                    "that it can climb",
                    level.speed, thrust, level.drag));
}

SetupResult<void> check_controls(const PlaneBody& body) {
    constexpr double least_roll = 5, least_share = 0.8;  // rad/s^2
    const auto level = level_at(body, slow_flight * stall_speed(body));
    const double off_trim = std::abs(level.attack_deg - body.trim_deg) * (std::numbers::pi / 180);
    if (body.pitch_stiffness * off_trim > least_share * body.full_elevator)
        return plane_error("its elevator cannot hold it in slow flight; more elevator or less pitch_stiffness");
    const double roll = level.pressure * body.area_m2 * body.span_m * body.full_ailerons / body.inertia_kg_m2[0];
    if (roll >= least_roll) return {};
    return plane_error(
        fmt::format("its ailerons roll it by at most {:.2f} rad/s^2 in slow flight, too little to fly; less inertia or "
                    "more ailerons",
                    roll));
}

// Steps of up to 10 ms are short against every motion of the body in fast flight.
SetupResult<void> check_steadiness(const PlaneBody& body) {
    constexpr double fast = 4, max_rate = 100, max_stiff = 2500;  // stall speeds, 1/s, 1/s^2
    const double speed = fast * stall_speed(body),
                 force = 0.5 * flight::sea_level_density * speed * speed * body.area_m2;
    const auto rate_of = [&](double damping_of, double length, double inertia) {
        return force * length * length * damping_of / (2 * speed * inertia);
    };
    const double rate = std::max({rate_of(body.roll_damping, body.span_m, body.inertia_kg_m2[0]),
                                  rate_of(body.pitch_damping, body.chord_m, body.inertia_kg_m2[1]),
                                  rate_of(body.yaw_damping, body.span_m, body.inertia_kg_m2[2])});
    const double stiff = std::max(force * body.chord_m * body.pitch_stiffness / body.inertia_kg_m2[1],
                                  force * body.span_m * body.yaw_stiffness / body.inertia_kg_m2[2]);
    if (rate <= max_rate && stiff <= max_stiff) return {};
    return plane_error("its damping or its stiffness is too large for its inertia");
}

}  // namespace

SetupResult<PlaneBody> parse_plane(std::string_view text) {
    const auto parts = named_parts_of(text);
    if (!parts) return tl::unexpected(parts.error());
    const auto preset = preset_index(*parts, sim::plane_names);
    if (!preset) return tl::unexpected(preset.error());
    PlaneBody body = body_of(static_cast<sim::PlanePreset>(*preset));
    if (auto done = set_named_numbers<PlaneBody>(body, *parts, plane_numbers, {preset_name}); !done)
        return tl::unexpected(std::move(done.error()));
    for (auto* const check : {&check_speeds, &check_climb, &check_controls, &check_steadiness})
        if (auto done = check(body); !done) return tl::unexpected(std::move(done.error()));
    return body;
}

}  // namespace mavloom::simserve
