// SPDX-License-Identifier: MIT
// The requests of `mavloom ctl`; see report.hpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "control/fault_request.hpp"
#include "control/json_request.hpp"
#include "mavloom/base/shown.hpp"
#include "mavloom/base/suggest.hpp"
#include "mavloom/simserve/report.hpp"
#include "simserve/request_values.hpp"
#include "simserve/scenario/values.hpp"
#include "simserve/scenario/vehicle_fault.hpp"

namespace mavloom::simserve {

namespace {

using control::failed;
using control::Json;
using control::text_at;

using Vehicles = SetupResult<std::vector<sim::Vehicle*>>;

Vehicles vehicles_of(Simulator& simulator, const Json& request) {
    return vehicles_at(request, [&](std::optional<SystemId> system) {
        auto vehicles = simulator.vehicles();
        if (system) std::erase_if(vehicles, [&](const sim::Vehicle* vehicle) { return vehicle->system() != *system; });
        return vehicles;
    });
}

// Gives the request's vehicles an order, and returns them. Of several vehicles, the error names those that refused.
Vehicles order(Simulator& simulator, const Json& request, const Simulator::Order& order) {
    auto vehicles = vehicles_of(simulator, request);
    if (!vehicles) return vehicles;
    std::string refusals;
    for (sim::Vehicle* const vehicle : *vehicles) {
        const auto given = simulator.give(*vehicle, order);
        if (given) continue;
        refusals += refusals.empty() ? "" : "; ";
        refusals += vehicles->size() == 1 ? given.error().text
                                          : fmt::format("vehicle {}: {}", vehicle->system().value, given.error().text);
    }
    if (!refusals.empty()) return setup_error(SetupCode::usage, std::move(refusals));
    return vehicles;
}

Report state_of(const Vehicles& vehicles) { return vehicles ? report_state(*vehicles) : failed(vehicles.error().text); }

Report arm(Simulator& simulator, const Json& request) {
    return state_of(flag_at(request, "force").and_then([&](bool forced) {
        return order(simulator, request, [forced](sim::Vehicle& vehicle) { return vehicle.arm(forced); });
    }));
}

Report disarm(Simulator& simulator, const Json& request) {
    return state_of(flag_at(request, "force").and_then([&](bool forced) {
        return order(simulator, request, [forced](sim::Vehicle& vehicle) { return vehicle.disarm(forced); });
    }));
}

Report take_off(Simulator& simulator, const Json& request) {
    const auto altitude = number_at(request, "altitude").value_or(std::nullopt);
    if (!altitude || !takeoff_range.has(*altitude))
        return failed(
            fmt::format("takeoff needs an altitude above home, {} to {} m", takeoff_range.least, takeoff_range.most));
    return state_of(
        order(simulator, request, [height = *altitude](sim::Vehicle& vehicle) { return vehicle.take_off(height); }));
}

Report go_to(Simulator& simulator, const Json& request) {
    const auto at = [&](const char* key) { return number_at(request, key).value_or(std::nullopt); };
    const auto latitude = at("latitude"), longitude = at("longitude");
    if (!latitude || !longitude || !latitude_range.has(*latitude) || !longitude_range.has(*longitude))
        return failed("goto needs a latitude, -90 to 90 degrees, and a longitude, -180 to 180 degrees");
    return state_of(order(simulator, request, [=, altitude = at("altitude")](sim::Vehicle& vehicle) {
        return vehicle.go_to(*latitude, *longitude, altitude);
    }));
}

SetupResult<void> check_mode(const sim::Vehicle& vehicle, std::string_view name) {
    if (vehicle.has_mode(name)) return {};
    const auto names = vehicle.mode_names();
    return setup_error(SetupCode::usage, fmt::format("there is no mode {}{}; there are {}", in_quotes(name),
                                                     did_you_mean(name, names), fmt::join(names, ", ")));
}

Report set_mode(Simulator& simulator, const Json& request) {
    return state_of(order(simulator, request, [name = text_at(request, "mode")](sim::Vehicle& vehicle) {
        return check_mode(vehicle, name).and_then([&] { return vehicle.set_mode(name); });
    }));
}

SetupResult<void> check_parameter(const sim::Vehicle& vehicle, std::string_view name) {
    if (vehicle.parameter(name)) return {};
    const auto names = vehicle.parameter_names();
    return setup_error(SetupCode::usage,
                       fmt::format("there is no parameter {}{}", in_quotes(name), did_you_mean(name, names)));
}

Report show_parameter(const std::vector<sim::Vehicle*>& vehicles, std::string_view name) {
    std::string text;
    for (const sim::Vehicle* const vehicle : vehicles) {
        if (const auto good = check_parameter(*vehicle, name); !good) return failed(good.error().text);
        control::append_line(text, {{"kind", "parameter"},
                                    {"system", vehicle->system().value},
                                    {"name", name},
                                    {"value", *vehicle->parameter(name)}});
    }
    return control::succeeded([text = std::move(text)](std::string& to) { to += text; });
}

// Sets the parameter if the request has a value, and reports it.
Report parameter(Simulator& simulator, const Json& request) {
    const auto name = text_at(request, "name");
    const auto value = number_at(request, "value");
    if (!value) return failed(value.error().text);
    const auto set = [&](sim::Vehicle& vehicle) {
        return check_parameter(vehicle, name).and_then([&] { return vehicle.set_parameter(name, **value); });
    };
    const auto vehicles = *value ? order(simulator, request, set) : vehicles_of(simulator, request);
    return vehicles ? show_parameter(*vehicles, name) : failed(vehicles.error().text);
}

Report fail_part(Simulator& simulator, const Json& request) {
    const auto fault = parse_vehicle_fault(text_at(request, "fault"));
    if (!fault) return failed(fault.error().text);
    return state_of(order(simulator, request, [&](sim::Vehicle& vehicle) { return vehicle.fail(*fault); }));
}

Report add(Simulator& simulator, const std::string& url) {
    const auto endpoint = endpoint::parse_endpoint(url);
    if (!endpoint) return failed(endpoint.error().text);
    if (const auto added = simulator.add(SimEndpoint{*endpoint}); !added) return failed(added.error().text);
    simulator.notify(config::LogLevel::info, endpoint->label() + ": added by ctl");
    return control::succeeded();
}

Report remove(Simulator& simulator, const std::string& name) {
    if (!simulator.remove(name)) return control::nothing_to_remove(name);
    simulator.notify(config::LogLevel::info, name + ": removed by ctl");
    return control::succeeded();
}

Report pause(Simulator& simulator, const Json&) {
    simulator.pause();
    return report_clock(simulator);
}

Report resume(Simulator& simulator, const Json&) {
    simulator.resume();
    return report_clock(simulator);
}

Report step(Simulator& simulator, const Json& request) {
    constexpr double max_s = std::chrono::duration<double>(Simulator::max_step).count();
    const auto time = number_at(request, "seconds").value_or(std::nullopt);
    if (!time || !(*time > 0 && *time <= max_s))
        return failed(fmt::format("step needs a time of the flight, up to {} s", max_s));
    if (!simulator.step(std::chrono::duration_cast<Nanoseconds>(std::chrono::duration<double>(*time))))
        return failed("the flight clock runs; pause it first");
    return report_clock(simulator);
}

Report fault_links(Simulator& simulator, const Json& request) {
    return control::set_faults(simulator.links(), request,
                               [&](const std::string& text) { simulator.notify(config::LogLevel::info, text); });
}

using Command = control::Command<Simulator>;

constexpr std::array commands{
    Command{"state", [](Simulator& s, const Json& r) { return state_of(vehicles_of(s, r)); }},
    Command{"arm", arm},
    Command{"disarm", disarm},
    Command{"takeoff", take_off},
    Command{"goto", go_to},
    Command{"mode", set_mode},
    Command{"param", parameter},
    Command{"fail", fail_part},
    Command{"pause", pause},
    Command{"resume", resume},
    Command{"step", step},
    Command{"links", [](Simulator& s, const Json&) { return report_links(s); }},
    Command{"streams", [](Simulator& s, const Json&) { return report_streams(s); }},
    Command{"stats", [](Simulator& s, const Json&) { return report_stats(s); }},
    Command{"add", [](Simulator& s, const Json& r) { return add(s, text_at(r, "url")); }},
    Command{"remove", [](Simulator& s, const Json& r) { return remove(s, text_at(r, "name")); }},
    Command{"fault", fault_links},
};

}  // namespace

Report answer_request(Simulator& simulator, std::string_view request) {
    return control::answer_request(simulator, request, commands);
}

Report Simulator::answer(std::string_view request) { return answer_request(*this, request); }

Report Simulator::metrics() { return report_metrics(*this); }

}  // namespace mavloom::simserve
