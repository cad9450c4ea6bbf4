// SPDX-License-Identifier: MIT
#include "commands/sim_for_px4.hpp"

#include <algorithm>
#include <utility>

#include "frames/receiving.hpp"
#include "mavloom/control/service_manager.hpp"
#include "mavloom/simserve/hil_simulator.hpp"
#include "open_control.hpp"
#include "output.hpp"
#include "signals.hpp"

namespace mavloom::app {

namespace {

using simserve::HilSimulator;
using simserve::Scenario;

SetupResult<std::unique_ptr<HilSimulator>> make_hil_simulator(const Common& common, const Scenario& scenario,
                                                              const dialect::Dialect& dialect) {
    const auto notice = [&common](config::LogLevel level, std::string_view text) {
        if (level >= config::LogLevel::info || common.verbose > 0) print_event(common, text);
    };
    auto simulator = HilSimulator::create(
        dialect, {.speed = scenario.speed, .rates = scenario.hil_rates, .utc_at_start = scenario.start_time}, notice);
    if (!simulator) return simulator;
    const auto endpoints = scenario.hil_endpoints();
    auto endpoint = endpoints.begin();
    for (const auto& vehicle : scenario.each_vehicle())
        if (auto added = (*simulator)->add(vehicle.options, *endpoint++, scenario.hil_faults(vehicle.options.system));
            !added)
            return tl::unexpected(std::move(added.error()));
    return simulator;
}

void serve(const Scenario& scenario, HilSimulator& simulator) {
    auto manager = control::ServiceManager::from_environment();
    const MonoTime end = scenario.duration ? mono_now() + *scenario.duration : MonoTime::max();
    manager.ready();
    while (!Signals::received() && mono_now() < end) {
        simulator.turn(std::min(end, manager.watchdog_due()));
        manager.feed(mono_now());
    }
    manager.stopping();
}

}  // namespace

Exit simulate_for_px4(const Common& common, const Scenario& scenario, const dialect::Dialect& dialect, bool prints_json) {
    const auto simulator = make_hil_simulator(common, scenario, dialect);
    if (!simulator) return fail(simulator.error());
    const Signals signals([](void* s) noexcept { static_cast<HilSimulator*>(s)->wake(); }, simulator->get());
    control::ControlOptions control_options;
    control_options.metrics = scenario.metrics;
    control_options.on_notice = [&](std::string_view text) { (*simulator)->notify(config::LogLevel::warning, text); };
    const auto control = open_control(common, **simulator, std::move(control_options), scenario.name,
                                      scenario.control_name());
    if (!control) return fail(control.error());
    log_ports(common, (*simulator)->links().endpoints());
    serve(scenario, **simulator);
    const Exit done = (*simulator)->refused_orders() == 0 ? Exit::done : Exit::failed;
    if (!scenario.has_report) return Signals::status(done);
    const auto reports = (*simulator)->reports();
    return Signals::status(print_at_end(prints_json ? simserve::json_of(reports) : simserve::text_of(reports), done));
}

}  // namespace mavloom::app
