// SPDX-License-Identifier: MIT
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "command.hpp"
#include "commands/sim_for_px4.hpp"
#include "fault_log.hpp"
#include "frames/receiving.hpp"
#include "mavloom/base/durations.hpp"
#include "mavloom/control/service_manager.hpp"
#include "mavloom/fault/faults.hpp"
#include "mavloom/simserve/report.hpp"
#include "mavloom/simserve/scenario.hpp"
#include "mavloom/simserve/simulator.hpp"
#include "open_control.hpp"
#include "output.hpp"
#include "page/web_beside.hpp"
#include "signals.hpp"

namespace mavloom::app {

namespace {

using namespace std::chrono_literals;
using simserve::Override;
using simserve::Scenario;
using simserve::Simulator;

constexpr auto sim_send_limit = 500ms;  // to send what is still queued at the end
constexpr std::string_view usual_destination = "udpout://127.0.0.1:14550";

// An option that sets a key of the scenario.
struct KeyOption {
    const char* name;
    std::string_view section, key;
    const char* description;
    const char* type;  // null: a flag
};

constexpr KeyOption key_options[] = {
    {"--vehicle", "vehicle", "kind", "kind of the vehicles: quad (default), plane or rover", "KIND"},
    {"--vehicles", "vehicle", "count", "number of vehicles, 5 m apart, with consecutive system ids", "N"},
    {"--system", "vehicle", "system", "system id of the first vehicle (default: 1)", "N"},
    {"--autopilot", "vehicle", "autopilot", "firmware to imitate: px4 (default) or ardupilot", "NAME"},
    {"--home", "vehicle", "home",
     "start position: latitude and longitude in degrees, metres above sea level (default: 489.4), heading in degrees "
     "from north (default: 0)",
     "LAT,LON[,ALT[,HEADING]]"},
    {"--wind", "vehicle", "wind",
     "speed (m/s), direction that the wind comes from (degrees from north), and optionally gusts (m/s)",
     "SPEED,DIR[,GUST]"},
    {"--gimbal", "vehicle", "gimbal", "mount a gimbal", nullptr},
    {"--traffic", "vehicle", "traffic", "number of other aircraft, reported by ADSB_VEHICLE", "N"},
    {"--motion", "vehicle", "motion", "flight (default), or random: coherent random values instead of flight", "HOW"},
    {"--profile", "sim", "profile",
     "which messages to stream, and how often: lite, default, px4-normal, px4-onboard, ardupilot, original", "NAME"},
    {"--seed", "sim", "seed", "seed of the random numbers; the same seed gives the same flight (default: 1)", "N"},
    {"--speed", "sim", "speed",
     "speed of the flight clock, 0.1 to 100 (default: 1), or max: as fast as the vehicles can fly", "X"},
    {"--for", "sim", "for",
     "end after this time: 10s, 2m; of the flight with --speed max, with --record alone and in sessions that can be "
     "repeated, but of real time with --hil",
     "TIME"},
    {"--hil", "sim", "hil",
     "let PX4 fly the vehicles, in lock-step (docs/guide/hil.md): it connects to port 4560, the PX4 of a second "
     "vehicle "
     "to 4561 and so on; or at another endpoint",
     "px4[=ENDPOINT]"},
    {"--hil-sensors", "sim", "hil_sensors",
     "with --hil: samples a second, the delay of GPS in seconds, samples of a distance sensor, and how many IMUs "
     "(default: imu:250,mag:50,baro:50,gps:10,gps_delay:0,distance:0,imus:1)",
     "NAME:N,..."},
    {"--start-time", "sim", "start_time", "UTC at the begin of the flight, as in 2026-11-29T12:00:00Z (default: now)",
     "TIME"},
    {"--record", "sim", "record", "record what the vehicles send, with the times of the flight clock; opens no port",
     "FILE.tlog"},
    {"--record-input", "sim", "record_input", "record what clients send, so that the session can be repeated",
     "FILE.tlog"},
    {"--replay-input", "sim", "replay_input", "play what clients sent in such a session, with its --start-time",
     "FILE.tlog"},
    {"--report", "sim", "report", "at the end, print how well each stream kept its rate", nullptr},
    {"--ring", "sim", "ring", "also write all frames of the vehicles into the ring /dev/shm/mavloom.NAME", "NAME"},
    {"--name", "sim", "name", "name for `mavloom ctl` and `stat` (default: the name of the ring, or sim)", "NAME"},
    {"--metrics", "sim", "metrics", "serve Prometheus metrics at http://HOST:PORT/metrics", "HOST:PORT"},
    {"--web", "web", "listen",
     "serve the page and viewers at http://HOST:PORT, for example 127.0.0.1:8088 (docs/guide/web.md)", "HOST:PORT"},
    {"--web-origin", "web", "origin", "web pages that may connect to --web, as in https://app.foxglove.dev", "URL,..."},
    {"--web-host", "web", "host", "further names of this machine that clients of --web use", "NAME,..."},
    {"--web-token-file", "web", "token_file", "clients of --web must send the token that this file holds", "FILE"},
};

struct SimOptions {
    std::string fault_log;
    std::string file;
    std::vector<std::string> to, listen;
    std::vector<std::string> texts = std::vector<std::string>(std::size(key_options));
    bool gimbal = false, report = false, json = false;

    // The options as settings that take precedence over the scenario's.
    [[nodiscard]] std::vector<Override> overrides() const {
        std::vector<Override> all;
        for (std::size_t i = 0; i < std::size(key_options); ++i) {
            const KeyOption& option = key_options[i];
            const bool is_flag = option.type == nullptr;
            const bool is_set = is_flag ? (option.key == "gimbal" ? gimbal : report) : !texts[i].empty();
            if (is_set) all.push_back({option.name, option.section, option.key, is_flag ? "true" : texts[i]});
        }
        return all;
    }
};

SetupResult<void> add_endpoints(const std::vector<std::string>& texts, std::string_view option, bool listens,
                                Scenario& scenario) {
    auto endpoints = endpoint::parse_endpoints(texts, option);
    if (!endpoints) return tl::unexpected(std::move(endpoints.error()));
    for (auto& endpoint : *endpoints) {
        if (listens != endpoint.listens())
            return setup_error(SetupCode::usage,
                               fmt::format("{} is for {}; put {} {}", option,
                                           listens ? endpoint::schemes_text(endpoint::Side::listens) : "destinations",
                                           endpoint.label(), listens ? "after --to" : "after --listen"));
        if (auto good = Simulator::check(endpoint); !good) return good;
        scenario.endpoints.push_back({std::move(endpoint)});
    }
    return {};
}

SetupResult<config::Document> load_scenario(const std::string& file) {
    if (file.empty()) return config::Document{"options", {}};
    const auto endpoint = endpoint::parse_endpoint(file);
    if (endpoint && !endpoint->is_recording() && !file.starts_with('/'))
        return setup_error(SetupCode::usage, fmt::format("{} is no scenario file; for an endpoint, write {} {}", file,
                                                         endpoint->listens() ? "--listen" : "--to", file));
    auto loaded = config::load_document(file);
    if (!loaded) return tl::unexpected(of_input_file(std::move(loaded.error())));
    return loaded;
}

SetupResult<Scenario> make_scenario(const SimOptions& options) {
    const auto document = load_scenario(options.file);
    if (!document) return tl::unexpected(document.error());
    const auto overrides = options.overrides();
    const auto of_vehicle = std::ranges::find_if(overrides, [](const Override& o) {
        return o.section == "vehicle" && (o.key == "count" || o.key == "system" || o.key == "home");
    });
    auto scenario = simserve::read_scenario(*document, config::environment_of(environ), overrides);
    if (!scenario) return scenario;
    if (scenario->vehicles.size() > 1 && of_vehicle != overrides.end())
        return setup_error(SetupCode::usage,
                           fmt::format("{}: {} has several vehicles; write it there", of_vehicle->option, options.file));
    if (auto good = simserve::check_scenario(*scenario, *document); !good)
        return tl::unexpected(std::move(good.error()));
    if (auto added = add_endpoints(options.to, "--to", false, *scenario); !added)
        return tl::unexpected(std::move(added.error()));
    if (auto added = add_endpoints(options.listen, "--listen", true, *scenario); !added)
        return tl::unexpected(std::move(added.error()));
    if (auto good = simserve::complete_hil(*scenario, *document, config::environment_of(environ, simserve::px4_prefix));
        !good)
        return tl::unexpected(std::move(good.error()));
    const bool is_alone = scenario->hil || (!scenario->recording.empty() && scenario->input_recording.empty());
    if (scenario->endpoints.empty() && scenario->ring.name.empty() && !is_alone)
        scenario->endpoints.push_back({*endpoint::parse_endpoint(usual_destination)});
    return scenario;
}

// Opens the ring with its inlet, or a counter page of the simulator's name.
SetupResult<void> open_shared(const Common& common, const Scenario& scenario, Simulator& simulator) {
    if (scenario.ring.name.empty()) {
        // Another simulator may have the page. `stat` then asks for the counters of that one.
        const auto opened = simulator.open_page(scenario.control_name());
        if (!opened) print_notice(common, opened.error().text);
        return {};
    }
    if (auto opened = simulator.open_ring(scenario.ring); !opened) return opened;
    const auto path = link::Links::inlet_path(scenario.ring.name);
    if (path) return simulator.open_inlet(scenario.ring, *path);
    print_notice(common, fmt::format("{}; programs cannot send through ring {}", path.error().text, scenario.ring.name));
    return {};
}

void log_vehicles(const Common& common, const Scenario& scenario) {
    for (const auto& group : scenario.vehicles) {
        const auto& o = group.options;
        const unsigned first = o.system.value, last = first + static_cast<unsigned>(group.count) - 1;
        print_notice(common, fmt::format("vehicle{} {}: {}, {}", first == last ? "" : "s",
                                         first == last ? fmt::format("{}", first) : fmt::format("{} to {}", first, last),
                                         sim::kind_names[static_cast<std::size_t>(o.kind)],
                                         sim::autopilot_names[static_cast<std::size_t>(o.autopilot)]));
    }
}

Exit print_report(const SimOptions& options, const Scenario& scenario, const Simulator& simulator, Exit otherwise) {
    if (!scenario.has_report) return otherwise;
    const auto reports = simulator.reports();
    const auto text_of = options.json ? simserve::json_of : simserve::text_of;
    return print_at_end(text_of(reports, scenario.speed), otherwise);
}

void fly(const Scenario& scenario, Simulator& simulator) {
    auto manager = control::ServiceManager::from_environment();
    const bool ends_by_clock = scenario.duration && !scenario.ends_by_flight();
    const MonoTime end = ends_by_clock ? mono_now() + *scenario.duration : MonoTime::max();
    manager.ready();
    while (!Signals::received() && !simulator.has_ended() && mono_now() < end) {
        simulator.turn(std::min(end, manager.watchdog_due()));
        manager.feed(mono_now());
    }
    manager.stopping();
}

sim::FlightTime flight_end_of(const Scenario& scenario) {
    return scenario.ends_by_flight() && scenario.duration ? *scenario.duration : sim::FlightTime::max();
}

SetupResult<std::unique_ptr<Simulator>> make_simulator(const Common& common, const Scenario& scenario,
                                                       const dialect::Dialect& dialect) {
    const auto notice = [&common](config::LogLevel level, std::string_view text) {
        if (level >= config::LogLevel::info || common.verbose > 0) print_event(common, text);
    };
    auto simulator = Simulator::create(dialect,
                                       {.speed = scenario.speed,
                                        .flight_end = flight_end_of(scenario),
                                        .utc_at_start = scenario.start_time,
                                        .orders = scenario.orders,
                                        .profile = scenario.profile,
                                        .rates = scenario.rates,
                                        .keeps_reports = scenario.has_report,
                                        .is_repeatable = scenario.is_repeatable()},
                                       notice);
    if (!simulator) return simulator;
    if (auto opened = open_shared(common, scenario, **simulator); !opened)
        return tl::unexpected(std::move(opened.error()));
    if (!scenario.recording.empty())
        if (auto opened = (*simulator)->open_recording(scenario.recording); !opened)
            return tl::unexpected(std::move(opened.error()));
    if (!scenario.input_recording.empty())
        if (auto opened = (*simulator)->open_input_recording(scenario.input_recording); !opened)
            return tl::unexpected(std::move(opened.error()));
    if (!scenario.input.empty())
        if (auto opened = (*simulator)->open_input(scenario.input); !opened)
            return tl::unexpected(of_input_file(std::move(opened.error())));
    for (const auto& vehicle : scenario.each_vehicle())
        if (auto added = (*simulator)->add(vehicle.options, vehicle.parameters); !added)
            return tl::unexpected(std::move(added.error()));
    for (const auto& endpoint : scenario.endpoints)
        if (auto added = (*simulator)->add(endpoint); !added) return tl::unexpected(std::move(added.error()));
    return simulator;
}

void log_recording(const Common& common, const Scenario& scenario, const Simulator& simulator) {
    const auto flight = seconds(simulator.flight_time()), real = seconds(simulator.uptime());
    print_notice(common, fmt::format("{}: {:.1f} s of flight in {:.2f} s", scenario.recording, flight, real));
}

Exit simulate(const Common& common, const SimOptions& options) {
    if (auto opened = fault::log_to(options.fault_log); !opened) return fail(opened.error());
    const auto dialect = load_dialect(common);
    if (!dialect) return fail(dialect.error());
    const auto scenario = make_scenario(options);
    if (!scenario) return fail(scenario.error());
    for (const auto& note : scenario->notes) print_notice(common, note);
    if (scenario->hil) return simulate_for_px4(common, *scenario, *dialect, options.json);
    const auto simulator = make_simulator(common, *scenario, *dialect);
    if (!simulator) return fail(simulator.error());
    const Signals signals([](void* s) noexcept { static_cast<Simulator*>(s)->wake(); }, simulator->get());
    control::ControlOptions control_options;
    control_options.metrics = scenario->metrics;
    control_options.on_notice = [&](std::string_view text) { (*simulator)->notify(config::LogLevel::warning, text); };
    const auto control = open_control(common, **simulator, std::move(control_options), scenario->name,
                                      scenario->control_name());
    if (!control) return fail(control.error());
    const auto web = WebBeside::open(
        common, *dialect, scenario->web,
        {scenario->ring.name.empty() ? scenario->control_name() : scenario->ring.name, scenario->ring.name, {}});
    if (!web) return fail(web.error());
    log_vehicles(common, *scenario);
    log_ports(common, (*simulator)->links().endpoints());
    fly(*scenario, **simulator);
    if (const auto finished = (*simulator)->finish(sim_send_limit); !finished) return fail(finished.error());
    if (!scenario->recording.empty()) log_recording(common, *scenario, **simulator);
    if (!scenario->input_recording.empty())
        print_notice(
            common, fmt::format("{}: play it with --replay-input and --start-time {:%FT%TZ}", scenario->input_recording,
                                std::chrono::floor<std::chrono::seconds>((*simulator)->options().utc_at_start)));
    return Signals::status(
        print_report(options, *scenario, **simulator, (*simulator)->refused_orders() == 0 ? Exit::done : Exit::failed));
}

}  // namespace

Run declare_sim(Arguments command, const Common& common) {
    auto options = std::make_shared<SimOptions>();
    command.add_option("scenario", "SCENARIO.toml", options->file,
                       "vehicles and endpoints, from a file (docs/guide/sim.md); `mavloom check` validates it");
    command
        .add_option("--to", "ENDPOINT", options->to,
                    fmt::format("send to {}, or shm://NAME, the inlet of a router's ring; may be repeated (default: "
                                "udpout://127.0.0.1:14550)",
                                endpoint::schemes_text(endpoint::Side::calls)))
        .one_value_each();
    command
        .add_option(
            "--listen", "ENDPOINT", options->listen,
            fmt::format("wait for clients at {}; may be repeated", endpoint::schemes_text(endpoint::Side::listens)))
        .one_value_each();
    for (std::size_t i = 0; i < std::size(key_options); ++i) {
        const KeyOption& option = key_options[i];
        if (option.type != nullptr) command.add_option(option.name, option.type, options->texts[i], option.description);
        else
            command.add_flag(option.name, option.key == "gimbal" ? options->gimbal : options->report,
                             option.description);
    }
    command.add_flag("--json", options->json, "with --report: print one JSON object per line");
    declare_fault_log(command, options->fault_log);
    command.footer(
        "Simulates vehicles that ground stations and SDKs take for real. Without options, one PX4 quadrotor sends to "
        "port 14550\nof this machine, where a ground station finds it. The vehicle answers every sender.\n\n"
        "Examples:\n"
        "  mavloom sim\n"
        "  mavloom sim --vehicle plane --autopilot ardupilot --listen tcpin://127.0.0.1:5760\n"
        "  mavloom sim --vehicles 5 --home 47.3977,8.5456,489,90 --to udpout://192.168.1.20:14550\n"
        "  mavloom sim scenario.toml --for 60s --report\n"
        "  mavloom sim --speed max --for 10m --record flight.tlog\n"
        "  mavloom sim --hil px4 --speed max\n"
        "  mavloom ctl sim takeoff 10");
    return [options, &common] { return simulate(common, *options); };
}

}  // namespace mavloom::app
