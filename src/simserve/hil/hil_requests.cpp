// SPDX-License-Identifier: MIT
// The requests of `mavloom ctl` to a simulator for autopilots outside.
#include <fmt/format.h>

#include <array>
#include <utility>

#include "control/fault_request.hpp"
#include "control/json_request.hpp"
#include "mavloom/base/durations.hpp"
#include "mavloom/link/snapshot.hpp"
#include "mavloom/simserve/hil_simulator.hpp"
#include "simserve/request_values.hpp"
#include "simserve/scenario/values.hpp"
#include "simserve/scenario/vehicle_fault.hpp"

namespace mavloom::simserve {

using namespace std::chrono_literals;

namespace {

using control::failed;
using control::Json;
using control::Report;
using control::text_at;
using Pairs = SetupResult<std::vector<hil::Pair*>>;

Pairs pairs_of(HilSimulator& simulator, const Json& request) {
    return vehicles_at(request, [&](std::optional<SystemId> system) { return simulator.pairs(system); });
}

// Calls `use` with each of the request's pairs, and reports the state of all.
template <class Use>
Report for_each_pair(HilSimulator& simulator, const Json& request, Use&& use) {
    const auto pairs = pairs_of(simulator, request);
    if (!pairs) return failed(pairs.error().text);
    for (hil::Pair* const pair : *pairs) use(*pair);
    return report_hil(simulator, *system_at(request));
}

Report pause_flights(HilSimulator& simulator, const Json& request) {
    return for_each_pair(simulator, request, [](hil::Pair& pair) { pair.pause(mono_now()); });
}

Report resume_flights(HilSimulator& simulator, const Json& request) {
    return for_each_pair(simulator, request, [](hil::Pair& pair) { pair.resume(mono_now()); });
}

// How far the request moved each flight. A step that is not finished continues.
Report report_steps(HilSimulator& simulator, const Json& request, const std::vector<hil::Pair*>& pairs,
                    const std::vector<flight::FlightTime>& before) {
    std::string moved;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        control::append_line(moved, {{"kind", "step"},
                                     {"system", pairs[i]->status().system.value},
                                     {"moved_s", seconds(pairs[i]->lock_step().time() - before[i])}});
    return report_hil(simulator, *system_at(request), std::move(moved));
}

Report step_flights(HilSimulator& simulator, const Json& request) {
    constexpr double max_s = 10;
    const auto time = number_at(request, "seconds").value_or(std::nullopt);
    if (!time || !(*time > 0 && *time <= max_s))
        return failed(fmt::format("step needs a time of the flight, up to {} s", max_s));
    const auto pairs = pairs_of(simulator, request);
    if (!pairs) return failed(pairs.error().text);
    std::vector<flight::FlightTime> before;
    for (const hil::Pair* const pair : *pairs) {
        if (!pair->lock_step().is_paused()) return failed("the flight clock runs; pause it first");
        if (pair->lock_step().state() == hil::State::waiting)
            return failed(fmt::format("vehicle {} waits for its PX4, so it makes no step", pair->status().system.value));
        before.push_back(pair->lock_step().time());
    }
    const auto move_and_report = [&simulator, request, pairs = *pairs, before,
                                  time = std::chrono::duration<double>(*time)](std::function<void(Report)> then) {
        constexpr auto limit = 4s;  // `mavloom ctl` waits for five seconds
        simulator.step(pairs, std::chrono::duration_cast<Nanoseconds>(time), limit,
                       [&simulator, request, pairs, before, then = std::move(then)] {
                           then(report_steps(simulator, request, pairs, before));
                       });
    };
    return {.answer_later = move_and_report, .next_text = {}};
}

Report reset_vehicles(HilSimulator& simulator, const Json& request) {
    return for_each_pair(simulator, request, [](hil::Pair& pair) { pair.reset(); });
}

Report push_vehicles(HilSimulator& simulator, const Json& request) {
    const auto by = parse_three(text_at(request, "push"), {-100, 100});
    if (!by) return failed(fmt::format("push takes NORTH,EAST,DOWN in m/s, as in 3,0,0: {}", by.error().text));
    const auto& [north, east, down] = *by;
    const hil::Pair::Push push{.north_m_s = north, .east_m_s = east, .down_m_s = down};
    return for_each_pair(simulator, request, [&](hil::Pair& pair) { pair.push(push); });
}

Report turn_vehicles(HilSimulator& simulator, const Json& request) {
    const auto by = parse_three(text_at(request, "turn"), {-2000, 2000});
    if (!by) return failed(fmt::format("turn takes ROLL,PITCH,YAW in degrees/s, as in 0,0,90: {}", by.error().text));
    const auto& [roll, pitch, yaw] = *by;
    const hil::Pair::Push push{.roll_deg_s = roll, .pitch_deg_s = pitch, .yaw_deg_s = yaw};
    return for_each_pair(simulator, request, [&](hil::Pair& pair) { pair.push(push); });
}

Report blow(HilSimulator& simulator, const Json& request) {
    const auto wind = parse_wind(text_at(request, "wind"));
    if (!wind) return failed(fmt::format("wind: {}", wind.error().text));
    return for_each_pair(simulator, request, [&](hil::Pair& pair) { pair.set_wind(*wind); });
}

Report load(HilSimulator& simulator, const Json& request) {
    constexpr double min_kg = 0.05, max_kg = 500;
    const auto mass = number_at(request, "kg").value_or(std::nullopt);
    if (!mass || !(*mass >= min_kg && *mass <= max_kg))
        return failed(fmt::format("mass takes kilograms, {} to {}", min_kg, max_kg));
    return for_each_pair(simulator, request, [&](hil::Pair& pair) { pair.set_mass(*mass); });
}

// Of several vehicles, the first refusal is reported.
Report fail_parts(HilSimulator& simulator, const Json& request) {
    const auto fault = parse_vehicle_fault(text_at(request, "fault"));
    if (!fault) return failed(fault.error().text);
    SetupResult<void> done;
    auto report = for_each_pair(simulator, request, [&](hil::Pair& pair) {
        if (done) done = pair.fail(*fault);
    });
    return done ? std::move(report) : failed(done.error().text);
}

Report fault_port(HilSimulator& simulator, const Json& request) {
    return control::set_faults(simulator.links(), request,
                               [&](const std::string& text) { simulator.notify(config::LogLevel::info, text); });
}

Report report_ports(HilSimulator& simulator, const Json&) {
    return control::succeeded([s = link::snapshot_of(simulator.links())](std::string& text) {
        for (const auto& link : s.links) control::append_link(text, s, link);
    });
}

Report report_flights(HilSimulator& simulator, const Json& request) {
    return for_each_pair(simulator, request, [](const hil::Pair&) {});
}

Report refer_to_px4(HilSimulator&, const Json&) {
    return failed("PX4 flies this vehicle and takes orders over its own links, such as UDP port 14550");
}

using HilCommand = control::Command<HilSimulator>;

constexpr std::array hil_commands{
    HilCommand{"state", report_flights},
    HilCommand{"stats", report_flights},
    HilCommand{"links", report_ports},
    HilCommand{"pause", pause_flights},
    HilCommand{"resume", resume_flights},
    HilCommand{"step", step_flights},
    HilCommand{"reset", reset_vehicles},
    HilCommand{"push", push_vehicles},
    HilCommand{"turn", turn_vehicles},
    HilCommand{"wind", blow},
    HilCommand{"mass", load},
    HilCommand{"fail", fail_parts},
    HilCommand{"fault", fault_port},
    HilCommand{"arm", refer_to_px4},
    HilCommand{"disarm", refer_to_px4},
    HilCommand{"takeoff", refer_to_px4},
    HilCommand{"goto", refer_to_px4},
    HilCommand{"mode", refer_to_px4},
    HilCommand{"param", refer_to_px4},
    HilCommand{"streams", refer_to_px4},
};

}  // namespace

Report HilSimulator::answer(std::string_view request) { return control::answer_request(*this, request, hil_commands); }

}  // namespace mavloom::simserve
