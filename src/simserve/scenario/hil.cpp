// SPDX-License-Identifier: MIT
#include "simserve/scenario/hil.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "mavloom/base/shown.hpp"
#include "mavloom/base/suggest.hpp"
#include "mavloom/endpoint/checks.hpp"
#include "mavloom/hil/pair.hpp"
#include "mavloom/simserve/scenario.hpp"
#include "simserve/scenario/keys.hpp"
#include "simserve/scenario/time_line.hpp"
#include "simserve/scenario/values.hpp"
#include "simserve/scenario/vehicle_fault.hpp"

namespace mavloom::simserve {

using endpoint::Endpoint;
using endpoint::Scheme;

namespace {

constexpr std::string_view usual_px4_port = "tcpin://127.0.0.1:4560";

tl::unexpected<SetupError> hil_error(std::string text) { return setup_error(SetupCode::usage, std::move(text)); }

SetupResult<Endpoint> checked(Endpoint endpoint) {
    constexpr std::array schemes{Scheme::tcpin, Scheme::serial};
    if (std::ranges::find(schemes, endpoint.scheme) == schemes.end())
        return hil_error(fmt::format(
            "{}: PX4 connects to a tcpin:// address; flight controllers are at a serial:// device", endpoint.label()));
    if (auto good = endpoint::check_link(endpoint, endpoint::RoutingOptions::refused); !good)
        return tl::unexpected(std::move(good.error()));
    return endpoint;
}

}  // namespace

SetupResult<Endpoint> parse_hil(std::string_view text) {
    static constexpr std::array<std::string_view, 1> autopilots{"px4"};
    const auto equals = text.find('=');
    const auto name = text.substr(0, equals);
    if (name != autopilots[0])
        return hil_error(fmt::format("{} is not px4 or px4=ENDPOINT, as in px4={}{}", in_quotes(text), usual_px4_port,
                                     did_you_mean(name, autopilots)));
    const auto url = equals == std::string_view::npos ? usual_px4_port : text.substr(equals + 1);
    return endpoint::parse_endpoint(url).and_then(checked);
}

// ---- sensors --------------------------------------------------------------------------------------------------------

namespace {

struct RateKey {
    std::string_view name;
    Range range;
    void (*set)(hil::SensorRates&, double);
};
constexpr std::array rate_keys{
    RateKey{"imu", {100, 1000}, [](hil::SensorRates& r, double v) { r.imu_hz = v; }},
    RateKey{"mag", {10, 1000}, [](hil::SensorRates& r, double v) { r.magnetometer_hz = v; }},
    RateKey{"baro", {10, 1000}, [](hil::SensorRates& r, double v) { r.barometer_hz = v; }},
    RateKey{"gps", {1, 50}, [](hil::SensorRates& r, double v) { r.gps_hz = v; }},
    RateKey{"gps_delay",
            {0, 0.5},
            [](hil::SensorRates& r, double v) {
                r.gps_delay = std::chrono::duration_cast<Nanoseconds>(std::chrono::duration<double>(v));
            }},
    RateKey{"distance", {0, 250}, [](hil::SensorRates& r, double v) { r.distance_hz = v; }},
    RateKey{"imus", {1, 3}, [](hil::SensorRates& r, double v) { r.imus = static_cast<unsigned>(v); }},
};

SetupResult<void> check_rates(const hil::SensorRates& rates) {
    const double period_us = 1e6 / rates.imu_hz;
    if (period_us != std::floor(period_us))
        return hil_error(
            fmt::format("imu: {} samples a second are not whole microseconds apart; 100, 125, 200, 250, "
                        "400, 500 and 1000 are",
                        rates.imu_hz));
    for (const double hz : {rates.magnetometer_hz, rates.barometer_hz, rates.gps_hz, rates.distance_hz})
        if (hz > rates.imu_hz)
            return hil_error(fmt::format("no sensor has more samples than imu:{}, which are the steps", rates.imu_hz));
    return {};
}

}  // namespace

SetupResult<hil::SensorRates> parse_hil_sensors(std::string_view text) {
    const auto pairs = parse_pairs(text);
    if (!pairs) return tl::unexpected(pairs.error());
    std::array<std::string_view, rate_keys.size()> names{};
    std::ranges::transform(rate_keys, names.begin(), &RateKey::name);
    hil::SensorRates rates;
    for (const auto& [name, value] : *pairs) {
        const auto index = parse_choice(name, names);
        if (!index) return tl::unexpected(index.error());
        const RateKey& key = rate_keys[*index];
        if (!(value >= key.range.least && value <= key.range.most))
            return hil_error(fmt::format("{}: {} is not from {} to {}", name, value, key.range.least, key.range.most));
        if (key.name == "imus" && value != std::floor(value))
            return hil_error(fmt::format("imus: {} is not a whole number", value));
        key.set(rates, value);
    }
    if (auto good = check_rates(rates); !good) return tl::unexpected(std::move(good.error()));
    return rates;
}

// ---- the scenario ---------------------------------------------------------------------------------------------------

namespace {

const config::Setting* setting_of(const Scenario& scenario, std::string_view section, std::string_view key) {
    const auto found = std::ranges::find(scenario.sections, section, &config::Section::name);
    if (found == scenario.sections.end()) return nullptr;
    const auto setting = std::ranges::find(found->settings, key, &config::Setting::key);
    return setting == found->settings.end() ? nullptr : &*setting;
}

class Px4Variables {
public:
    explicit Px4Variables(const config::Environment& variables) : variables_(variables) {}

    // Sets `target` if the variable exists. One that is no number of the range is an error.
    SetupResult<bool> read(std::string_view name, Range range, double& target) const {
        const auto found = std::ranges::find(variables_, name, &config::Environment::value_type::first);
        if (found == variables_.end() || found->second.empty()) return false;
        const auto value = parse_number(found->second, range);
        if (!value)
            return setup_error(SetupCode::bad_input, fmt::format("environment: {}: {}", name, value.error().text));
        target = *value;
        return true;
    }

private:
    const config::Environment& variables_;
};

SetupResult<void> read_home(const Px4Variables& variables, ScenarioVehicle& vehicle) {
    sim::Home home = vehicle.options.home;
    const auto latitude = variables.read("PX4_HOME_LAT", latitude_range, home.latitude_deg);
    if (!latitude) return tl::unexpected(latitude.error());
    const auto longitude = variables.read("PX4_HOME_LON", longitude_range, home.longitude_deg);
    if (!longitude) return tl::unexpected(longitude.error());
    const auto altitude = variables.read("PX4_HOME_ALT", {-500, 20'000}, home.altitude_m);
    if (!altitude) return tl::unexpected(altitude.error());
    if (!vehicle.has_own_place) vehicle.options.home = home;
    return {};
}

SetupResult<void> read_px4_variables(const Px4Variables& variables, Scenario& scenario) {
    for (ScenarioVehicle& vehicle : scenario.vehicles)
        if (auto done = read_home(variables, vehicle); !done) return done;
    double speed = scenario.speed;
    const auto read = variables.read("PX4_SIM_SPEED_FACTOR", {0.1, 100}, speed);
    if (!read) return tl::unexpected(read.error());
    const auto* const setting = setting_of(scenario, sim_section, "speed");
    if (setting == nullptr || setting->origin == config::Origin::by_default) scenario.speed = speed;
    return {};
}

// PX4 answers only a part of the steps if sensors come more often.
SetupResult<void> check_imu_rate(const Px4Variables& variables, const hil::SensorRates& rates) {
    double integration_hz = 250;
    const auto read = variables.read("PX4_PARAM_IMU_INTEG_RATE", {1, 10'000}, integration_hz);
    if (!read) return tl::unexpected(read.error());
    if (rates.imu_hz <= integration_hz) return {};
    return hil_error(fmt::format(
        "hil_sensors: imu:{} is more than PX4's parameter IMU_INTEG_RATE ({}), and PX4 would answer only a part of the "
        "steps; set PX4_PARAM_IMU_INTEG_RATE={} in the environment of both programs",
        rates.imu_hz, integration_hz, rates.imu_hz));
}

SetupResult<void> check_board(const Scenario& scenario, std::size_t vehicles) {
    if (scenario.hil->row().form != endpoint::Form::device) return {};
    const auto label = scenario.hil->label();
    if (scenario.hil_rates.imus > 1)
        return hil_error(fmt::format("{}: a flight controller takes one IMU, so hil_sensors has imus:1", label));
    if (scenario.speed != 1)
        return hil_error(
            fmt::format("{}: a flight controller flies in real time, so speed and PX4_SIM_SPEED_FACTOR are 1", label));
    if (vehicles > 1)
        return hil_error(fmt::format("{}: a flight controller flies one vehicle, not {}", label, vehicles));
    return {};
}

// Keys of a scenario that PX4 decides itself, and those that are for PX4 outside only.
struct OwnKey {
    std::string_view section, key, why;
};
constexpr std::string_view it_sends = "PX4 sends the telemetry", it_has = "PX4 has its own",
                           flies_all = "PX4 flies the vehicle";
constexpr std::array keys_of_px4{
    OwnKey{sim_section, "profile", it_sends},
    OwnKey{sim_section, "record", it_sends},
    OwnKey{sim_section, "record_input", "clients talk to PX4"},
    OwnKey{sim_section, "replay_input", "clients talk to PX4"},
    OwnKey{sim_section, "ring", it_sends},
    OwnKey{web_section, "listen", it_sends},
    OwnKey{vehicle_section, "autopilot", "the autopilot is PX4"},
    OwnKey{vehicle_section, "motion", flies_all},
    OwnKey{vehicle_section, "battery", it_has},
    OwnKey{vehicle_section, "gimbal", it_has},
    OwnKey{vehicle_section, "traffic", it_has},
    OwnKey{vehicle_section, "logs", it_has},
    OwnKey{vehicle_section, "ready_after", it_has},
    OwnKey{vehicle_section, "parameters", it_has},
};

// An error at the place where the setting was made.
tl::unexpected<SetupError> wrong_setting(const config::Document& document, const config::Setting& setting,
                                         std::string_view what) {
    if (setting.origin == config::Origin::file)
        return document.error(setting.line, fmt::format("{}: {}", setting.key, what));
    return hil_error(fmt::format("{}: {}", setting.variable, what));
}

bool is_given(const config::Setting& setting) { return setting.origin != config::Origin::by_default; }

// `autopilot = "px4"` changes nothing.
bool is_usual(const config::Setting& setting) { return setting.key == "autopilot" && setting.value == "px4"; }

SetupResult<void> check_settings(const Scenario& scenario, const config::Document& document) {
    for (const config::Section& section : scenario.sections)
        for (const config::Setting& setting : section.settings) {
            const auto own = std::ranges::find_if(
                keys_of_px4, [&](const OwnKey& key) { return key.section == section.name && key.key == setting.key; });
            if (own != keys_of_px4.end() && is_given(setting) && !is_usual(setting))
                return wrong_setting(document, setting, fmt::format("not with hil: {}", own->why));
        }
    return {};
}

// With PX4, the time line has faults only.
SetupResult<void> check_event(const config::Section& event, const config::Document& document) {
    const auto& order = *std::ranges::find(event.settings, "do", &config::Setting::key);
    const auto fault = fault_of_order(order.value);
    if (!fault) return wrong_setting(document, order, fmt::format("with hil, only fail PART FAULT: {}", flies_all));
    const auto part = parse_vehicle_fault(*fault)->part;
    if (hil::has_part(part)) return {};
    return wrong_setting(document, order,
                         fmt::format("not with hil: {}", part == sim::FaultPart::autopilot ? flies_all : it_has));
}

SetupResult<void> check_sections(const Scenario& scenario, const config::Document& document) {
    for (const config::Section& section : scenario.sections) {
        if (section.name == event_section)
            if (auto good = check_event(section, document); !good) return good;
        const bool is_for_own_pilots = section.name == streams_section || section.name == endpoint_section;
        if (is_for_own_pilots && section.line != 0)
            return document.error(section.line, fmt::format("no [{}] with hil: {}", section.name, it_sends));
    }
    if (scenario.endpoints.empty()) return {};
    return hil_error(fmt::format("{}: not with hil: {}", scenario.endpoints.front().endpoint.label(), it_sends));
}

// Without `hil`.
SetupResult<void> check_no_hil(const Scenario& scenario, const config::Document& document) {
    const auto* const sensors = setting_of(scenario, sim_section, "hil_sensors");
    if (sensors == nullptr || !is_given(*sensors)) return {};
    return wrong_setting(document, *sensors, "it is for hil, which is not set");
}

SetupResult<void> check_ports(const Scenario& scenario, std::size_t vehicles) {
    const unsigned first = scenario.hil->address.port;
    if (!scenario.hil->has_address() || first == 0 || first + vehicles - 1 <= 65'535) return {};
    return hil_error(fmt::format("{}: there are not {} ports from this one on", scenario.hil->label(), vehicles));
}

}  // namespace

SetupResult<void> complete_hil(Scenario& scenario, const config::Document& document, const config::Environment& px4) {
    if (!scenario.hil) return check_no_hil(scenario, document);
    const Px4Variables variables(px4);
    if (auto done = read_px4_variables(variables, scenario); !done) return done;
    if (auto good = check_imu_rate(variables, scenario.hil_rates); !good) return good;
    if (auto good = check_settings(scenario, document); !good) return good;
    if (auto good = check_sections(scenario, document); !good) return good;
    std::size_t vehicles = 0;
    for (const ScenarioVehicle& group : scenario.vehicles) vehicles += group.count;
    if (auto good = check_board(scenario, vehicles); !good) return good;
    return check_ports(scenario, vehicles);
}

std::vector<hil::TimedFault> Scenario::hil_faults(SystemId system) const {
    std::vector<hil::TimedFault> faults;
    for (const TimedOrder& order : orders)
        if (!order.system || *order.system == system)
            faults.push_back({order.at, *parse_vehicle_fault(*fault_of_order(order.text))});
    std::ranges::stable_sort(faults, {}, &hil::TimedFault::at);
    return faults;
}

std::vector<Endpoint> Scenario::hil_endpoints() const {
    std::vector<Endpoint> all;
    if (!hil) return all;
    for (const ScenarioVehicle& group : vehicles)
        for (std::size_t i = 0; i < group.count; ++i) {
            Endpoint next = *hil;
            if (next.address.port != 0) next.address.port = static_cast<std::uint16_t>(hil->address.port + all.size());
            if (!next.options.name.empty() && !all.empty()) next.options.name += fmt::format("-{}", all.size() + 1);
            all.push_back(std::move(next));
        }
    return all;
}

}  // namespace mavloom::simserve
