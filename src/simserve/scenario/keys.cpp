// SPDX-License-Identifier: MIT
#include "simserve/scenario/keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "mavloom/base/name.hpp"
#include "mavloom/base/shown.hpp"
#include "mavloom/base/suggest.hpp"
#include "mavloom/config/keys.hpp"
#include "mavloom/endpoint/grammar.hpp"
#include "simserve/scenario/body.hpp"
#include "simserve/scenario/hil.hpp"
#include "simserve/scenario/noise.hpp"
#include "simserve/scenario/time_line.hpp"
#include "simserve/scenario/values.hpp"

namespace mavloom::simserve {

namespace {

using endpoint::parse_bool;
using endpoint::parse_integer;
using endpoint::put;
using Text = std::string_view;

template <class E, std::size_t n>
SetupResult<void> put_choice(Text text, const std::string_view (&choices)[n], E& target) {
    return put(parse_choice(text, choices), target);
}

SetupResult<void> set_name(Text text, std::string_view what, std::string& target) {
    if (!is_name(text))
        return endpoint::usage(
            fmt::format("{} is not a {} name (letters, digits, '_' and '-', at most 64)", in_quotes(text), what));
    target = std::string(text);
    return {};
}

// Kinds of vehicles as other programs and people call them.
struct OtherName {
    Text name, kind;
};
constexpr std::array other_names{
    OtherName{"copter", "quad"},      OtherName{"multicopter", "quad"}, OtherName{"quadcopter", "quad"},
    OtherName{"quadrotor", "quad"},   OtherName{"arducopter", "quad"},  OtherName{"iris", "quad"},
    OtherName{"x500", "quad"},        OtherName{"drone", "quad"},       OtherName{"fixedwing", "plane"},
    OtherName{"fixed_wing", "plane"}, OtherName{"arduplane", "plane"},  OtherName{"car", "rover"},
    OtherName{"ugv", "rover"},        OtherName{"ardurover", "rover"},
};

SetupResult<void> set_kind(ScenarioVehicle& vehicle, Text text) {
    const auto other = std::ranges::find(other_names, text, &OtherName::name);
    if (other == other_names.end()) return put_choice(text, sim::kind_names, vehicle.options.kind);
    return endpoint::usage(fmt::format("{} is none of {}, did you mean '{}'?", in_quotes(text),
                                       fmt::join(sim::kind_names, ", "), other->kind));
}

SetupResult<void> set_duration(Scenario& scenario, Text text) {
    const auto time = endpoint::parse_duration(text);
    if (!time) return tl::unexpected(time.error());
    scenario.duration = *time;
    return {};
}

SetupResult<void> set_speed(Scenario& scenario, Text text) {
    constexpr Range speeds{0.1, 100};
    if (text == "max") scenario.speed = max_speed;
    else if (!put(parse_number(text, speeds), scenario.speed))
        return endpoint::usage(
            fmt::format("{} is neither a number from {} to {} nor max", in_quotes(text), speeds.least, speeds.most));
    return {};
}

SetupResult<void> set_recording(Text text, std::string& target) {
    if (!text.ends_with(".tlog"))
        return endpoint::usage(fmt::format("{}: the name of a recording ends in .tlog", in_quotes(text)));
    target = text;
    return {};
}

SetupResult<void> set_profile(Scenario& scenario, Text text) {
    sim::Profile profile{};
    if (auto done = put_choice(text, sim::profile_names, profile); !done) return done;
    scenario.profile = profile;
    return {};
}

SetupResult<void> set_metrics(Scenario& scenario, Text text) {
    return put(endpoint::parse_server_address(text), scenario.metrics);
}

SetupResult<void> set_capacity(Scenario& scenario, Text text) {
    return put(endpoint::parse_ring_capacity(text), scenario.ring.capacity_bytes);
}

constexpr std::array<Key<Scenario>, 15> all_sim_keys{{
    {"name", "", [](Scenario& s, Text t) { return set_name(t, "simulator", s.name); }},
    {"seed", "1", [](Scenario& s, Text t) { return put(parse_integer(t, 0, UINT64_MAX), s.seed); }},
    {"speed", "1", set_speed},
    {"profile", "", set_profile},
    {"for", "", set_duration},
    {"start_time", "", [](Scenario& s, Text t) { return put(parse_utc(t), s.start_time); }},
    {"record", "", [](Scenario& s, Text t) { return set_recording(t, s.recording); }},
    {"record_input", "", [](Scenario& s, Text t) { return set_recording(t, s.input_recording); }},
    {"replay_input", "", [](Scenario& s, Text t) { return set_recording(t, s.input); }},
    {"report", "false", [](Scenario& s, Text t) { return put(parse_bool(t), s.has_report); }},
    {"ring", "", [](Scenario& s, Text t) { return set_name(t, "ring", s.ring.name); }},
    {"ring_capacity", "8MiB", set_capacity},
    {"metrics", "", set_metrics},
    {"hil", "", [](Scenario& s, Text t) { return put(parse_hil(t), s.hil); }},
    {"hil_sensors", "imu:250,mag:50,baro:50,gps:10,gps_delay:0,distance:0,imus:1",
     [](Scenario& s, Text t) { return put(parse_hil_sensors(t), s.hil_rates); }},
}};

constexpr std::array<Key<Scenario>, 4> all_web_keys{{
    {"listen", "", [](Scenario& s, Text t) { return config::set_web_listen(s.web, t); }},
    {"origin", "", [](Scenario& s, Text t) { return config::set_web_origins(s.web, t); }},
    {"host", "", [](Scenario& s, Text t) { return config::set_web_hosts(s.web, t); }},
    {"token_file", "", [](Scenario& s, Text t) { return config::set_web_token_file(s.web, t); }},
}};

SetupResult<SystemId> parse_system(Text text) {
    const auto system = parse_integer(text, 1, 254);
    if (system) return SystemId{static_cast<std::uint8_t>(*system)};
    return endpoint::usage(fmt::format("{} is not a system id of a vehicle, which is from 1 to 254", in_quotes(text)));
}

SetupResult<void> set_system(ScenarioVehicle& vehicle, Text text) {
    return put(parse_system(text), vehicle.options.system);
}

SetupResult<void> set_ready_after(ScenarioVehicle& vehicle, Text text) {
    return put(endpoint::parse_duration(text), vehicle.options.ready_after);
}

constexpr std::size_t max_traffic = 64, max_logs = 32;

SetupResult<void> set_words(ScenarioEvent& event, Text text) {
    if (const auto good = request_of_order(text, {}); !good) return tl::unexpected(good.error());
    event.words = text;
    return {};
}

constexpr std::array<Key<ScenarioEvent>, 3> all_event_keys{{
    {"at", "", [](ScenarioEvent& e, Text t) { return put(endpoint::parse_duration(t), e.at); }},
    {"do", "", set_words},
    {"system", "", [](ScenarioEvent& e, Text t) { return put(parse_system(t), e.system); }},
}};

constexpr std::array<Key<ScenarioVehicle>, 15> all_vehicle_keys{{
    {"kind", "quad", set_kind},
    {"autopilot", "px4",
     [](ScenarioVehicle& v, Text t) { return put_choice(t, sim::autopilot_names, v.options.autopilot); }},
    {"motion", "flight", [](ScenarioVehicle& v, Text t) { return put_choice(t, sim::motion_names, v.options.motion); }},
    {"system", "", set_system},
    {"count", "1", [](ScenarioVehicle& v, Text t) { return put(parse_integer(t, 1, 254), v.count); }},
    {"home", "", [](ScenarioVehicle& v, Text t) { return put(parse_home(t), v.options.home); }},
    {"wind", "0,0", [](ScenarioVehicle& v, Text t) { return put(parse_wind(t), v.options.wind); }},
    {"battery", "capacity:5000,cells:4,minutes:20,start:100",
     [](ScenarioVehicle& v, Text t) { return put(parse_battery(t), v.options.battery); }},
    {"body", "standard", [](ScenarioVehicle& v, Text t) { return set_body(t, v.options); }},
    {"gimbal", "false", [](ScenarioVehicle& v, Text t) { return put(parse_bool(t), v.options.has_gimbal); }},
    {"traffic", "0", [](ScenarioVehicle& v, Text t) { return put(parse_integer(t, 0, max_traffic), v.options.traffic); }},
    {"logs", "2", [](ScenarioVehicle& v, Text t) { return put(parse_integer(t, 0, max_logs), v.options.logs); }},
    {"noise", "true", [](ScenarioVehicle& v, Text t) { return set_noise(t, v.options); }},
    {"ready_after", "2.5s", set_ready_after},
    {"parameters", "", [](ScenarioVehicle& v, Text t) { return put(parse_pairs(t), v.parameters); }},
}};

}  // namespace

std::span<const Key<Scenario>> sim_keys() noexcept { return all_sim_keys; }
std::span<const Key<Scenario>> web_keys() noexcept { return all_web_keys; }
std::span<const Key<ScenarioEvent>> event_keys() noexcept { return all_event_keys; }
std::span<const Key<ScenarioVehicle>> vehicle_keys() noexcept { return all_vehicle_keys; }

SetupResult<void> add_rate(std::vector<sim::MessageRate>& rates, std::string_view message, std::string_view hz) {
    const auto infos = sim::stream_infos();
    std::vector<std::string_view> names;
    names.reserve(infos.size());
    for (const sim::StreamInfo& info : infos) names.push_back(info.name);
    const auto info = std::ranges::find(infos, message, &sim::StreamInfo::name);
    if (info == infos.end())
        return endpoint::usage(
            fmt::format("vehicles stream no message {}{}", in_quotes(message), did_you_mean(message, names)));
    if (message == "HEARTBEAT") return endpoint::usage("HEARTBEAT always comes once a second");
    const auto rate = parse_number(hz, {0, sim::fastest_stream_hz});
    if (!rate) return tl::unexpected(SetupError(rate.error()).within(message));
    rates.push_back({info->message, *rate});
    return {};
}

}  // namespace mavloom::simserve
