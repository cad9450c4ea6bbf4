// SPDX-License-Identifier: MIT
#include "simserve/scenario/body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mavloom/endpoint/grammar.hpp"
#include "simserve/scenario/named_numbers.hpp"

namespace mavloom::simserve {

namespace {

using sim::CopterBody;

tl::unexpected<SetupError> body_error(std::string text) { return setup_error(SetupCode::usage, std::move(text)); }

using Number = NamedNumber<CopterBody>;
constexpr Range share{0, 1}, lag{0, 0.06}, any_drag{0, 100}, any_inertia{1e-5, 100};
constexpr std::array numbers{
    Number{"mass", {0.05, 500}, [](CopterBody& b) -> double& { return b.mass_kg; }},
    Number{"inertia_x", any_inertia, [](CopterBody& b) -> double& { return b.inertia_kg_m2[0]; }},
    Number{"inertia_y", any_inertia, [](CopterBody& b) -> double& { return b.inertia_kg_m2[1]; }},
    Number{"inertia_z", any_inertia, [](CopterBody& b) -> double& { return b.inertia_kg_m2[2]; }},
    Number{"thrust", {0.01, 10'000}, [](CopterBody& b) -> double& { return b.thrust_n; }},
    Number{"moment_ratio", {0.001, 1}, [](CopterBody& b) -> double& { return b.moment_ratio_m; }},
    Number{"spin_up", lag, [](CopterBody& b) -> double& { return b.spin_up_s; }},
    Number{"spin_down", lag, [](CopterBody& b) -> double& { return b.spin_down_s; }},
    Number{"curve", share, [](CopterBody& b) -> double& { return b.curve; }},
    Number{"idle", {0, 0.3}, [](CopterBody& b) -> double& { return b.idle; }},
    Number{"drag", any_drag, [](CopterBody& b) -> double& { return b.drag; }},
    Number{"square_drag", any_drag, [](CopterBody& b) -> double& { return b.square_drag; }},
    Number{"rotor_drag", any_drag, [](CopterBody& b) -> double& { return b.rotor_drag; }},
    Number{"turn_drag", any_drag, [](CopterBody& b) -> double& { return b.turn_drag; }},
};
constexpr Range arm_range{0.02, 10};  // m

SetupResult<void> place_rotors(CopterBody& body, const std::vector<NamedPart>& parts) {
    const auto frame = find_part(parts, "frame"), arm = find_part(parts, "arm");
    if (!frame && !arm) return {};
    const auto index = parse_choice(frame.value_or(sim::frame_names[0]), sim::frame_names);
    if (!index) return tl::unexpected(SetupError(index.error()).within("frame"));
    double length = arm_of(body);
    if (arm) {
        const auto value = parse_number(*arm, arm_range);
        if (!value) return tl::unexpected(SetupError(value.error()).within("arm"));
        length = *value;
    }
    set_frame(body, static_cast<sim::Frame>(*index), length);
    return {};
}

// The steps of 4 ms are short against every motion of the body, and its motors can carry and turn it.
SetupResult<void> check_body(const CopterBody& body) {
    constexpr double gravity = 9.80665, fastest = 100, slowest_turn = 5;  // m/s^2, 1/s, rad/s^2
    const auto rotors = static_cast<double>(body.rotor_count);
    const double lift = rotors * body.thrust_n, weight = body.mass_kg * gravity;
    if (lift < 1.2 * weight)
        return body_error(fmt::format(
            "its {} motors lift {:.1f} N, and it weighs {:.1f} N; more thrust or less mass, so that it can climb",
            body.rotor_count, lift, weight));
    if (lift > 20 * weight)
        return body_error(fmt::format("its motors lift {:.1f} times its weight; 20 times is the most", lift / weight));
    const double drag = body.drag + body.rotor_drag * rotors + body.square_drag * fastest;
    const double lightest = *std::ranges::min_element(body.inertia_kg_m2);
    if (drag > fastest * body.mass_kg || body.turn_drag > fastest * lightest)
        return body_error("its drag is too large for its mass and inertia");
    const double tilting = lift * arm_of(body) / (2 * std::max(body.inertia_kg_m2[0], body.inertia_kg_m2[1]));
    if (tilting < slowest_turn)
        return body_error(fmt::format(
            "its motors tilt it by at most {:.2f} rad/s^2, too little to fly; less inertia or longer arms", tilting));
    return {};
}

}  // namespace

SetupResult<sim::CopterBody> parse_copter(std::string_view text) {
    const auto parts = named_parts_of(text);
    if (!parts) return tl::unexpected(parts.error());
    const auto preset = preset_index(*parts, sim::body_names);
    if (!preset) return tl::unexpected(preset.error());
    CopterBody body = body_of(static_cast<sim::BodyPreset>(*preset));
    if (auto done = place_rotors(body, *parts); !done) return tl::unexpected(std::move(done.error()));
    if (auto done = set_named_numbers<CopterBody>(body, *parts, numbers, {preset_name, "frame", "arm"}); !done)
        return tl::unexpected(std::move(done.error()));
    if (auto done = check_body(body); !done) return tl::unexpected(std::move(done.error()));
    return body;
}

SetupResult<void> set_body(std::string_view text, sim::VehicleOptions& options) {
    switch (options.kind) {
        case sim::Kind::plane: return endpoint::put(parse_plane(text), options.body.plane);
        case sim::Kind::rover: return endpoint::put(parse_rover(text), options.body.rover);
        case sim::Kind::quad: break;
    }
    return endpoint::put(parse_copter(text), options.body.copter);
}

}  // namespace mavloom::simserve
