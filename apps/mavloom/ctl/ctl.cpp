// SPDX-License-Identifier: MIT
// `mavloom ctl NAME ACTION`: asks and commands a running router or simulator.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "command.hpp"
#include "ctl/actions.hpp"
#include "ctl/answers.hpp"
#include "ctl/wait.hpp"
#include "mavloom/base/durations.hpp"
#include "mavloom/base/shown.hpp"
#include "mavloom/base/suggest.hpp"
#include "mavloom/control/control.hpp"
#include "mavloom/endpoint/endpoint.hpp"
#include "output.hpp"

namespace mavloom::app {

namespace {

struct CtlOptions {
    std::string name, action;
    std::vector<std::string> arguments;
    std::string system;         // of the vehicle; empty: all
    std::string limit;          // of `wait`
    std::string in, out, seed;  // of `fault`
    bool force = false;
    bool json = false;
};

// An action, and the keys of its arguments in the request.
struct Action {
    std::string_view name;
    std::vector<std::string_view> arguments{};
    std::size_t fewest = 0;       // of the arguments
    std::string_view missing{};   // the error if there are fewer
    bool is_of_vehicles = false;  // only a simulator has it
    std::string_view mode{};      // it is short for this mode
};

const std::vector<Action>& actions() {
    static const std::vector<Action> all{
        {"links"},
        {"routes"},
        {"stats"},
        {"add", {"url"}, 1, "add takes the URL of an endpoint"},
        {"remove", {"name"}, 1, "remove takes the name of an endpoint or link"},
        {"fault", {"name", "faults"}, 1, "fault takes the name of an endpoint or link, and the faults or off"},
        {"streams"},
        {"state", {}, 0, {}, true},
        {"arm", {}, 0, {}, true},
        {"disarm", {}, 0, {}, true},
        {"takeoff", {"altitude"}, 1, "takeoff takes the altitude above home in metres", true},
        {"mode", {"mode"}, 1, "mode takes the name of a mode", true},
        {"land", {}, 0, {}, true, "Land"},
        {"rtl", {}, 0, {}, true, "RTL"},
        {"goto",
         {"latitude", "longitude", "altitude"},
         2,
         "goto takes latitude and longitude in degrees, and the altitude above home in metres if it is to change",
         true},
        {"pause", {}, 0, {}, true},
        {"resume", {}, 0, {}, true},
        {"step", {"seconds"}, 1, "step takes a time of the flight, such as 10ms", true},
        {"reset", {}, 0, {}, true},
        {"push", {"push"}, 1, "push takes NORTH,EAST,DOWN in m/s, by which the velocity changes, as in 3,0,0", true},
        {"turn", {"turn"}, 1, "turn takes ROLL,PITCH,YAW in degrees/s, by which the rates change, as in 0,0,90", true},
        {"wind", {"wind"}, 1, "wind takes SPEED,DIR[,GUST], as --wind of sim does", true},
        {"mass", {"kg"}, 1, "mass takes kilograms", true},
        {"wait", {"state", "metres"}, 1, "wait takes ready, armed, disarmed, landed, or alt and metres", true},
        {"fail", {"fault"}, 2, "fail takes a part of the vehicle and its fault, as in fail gps off", true},
        {"param", {"name", "value"}, 1, "param takes the name of a parameter, and its new value if it is to be set", true},
    };
    return all;
}

std::vector<std::string_view> action_names() {
    std::vector<std::string_view> names;
    for (const Action& action : actions()) names.push_back(action.name);
    return names;
}

// Keys whose value is text; all others are numbers.
bool is_text_key(std::string_view key) {
    constexpr std::array<std::string_view, 7> keys{"url", "name", "mode", "faults", "push", "turn", "wind"};
    return std::ranges::find(keys, key) != keys.end();
}

SetupResult<double> number_of(std::string_view what, const std::string& text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
        return setup_error(SetupCode::usage, fmt::format("{}: {} is not a number", what, in_quotes(text)));
    return value;
}

SetupResult<double> seconds_of(const std::string& text) {
    return endpoint::parse_duration(text).map([](Nanoseconds time) { return seconds(time); });
}

SetupResult<void> add_arguments(const CtlOptions& options, const Action& action, Json& request) {
    if (options.arguments.size() < action.fewest) return setup_error(SetupCode::usage, std::string(action.missing));
    if (action.name == "fail") {
        request["fault"] = fmt::format("{}", fmt::join(options.arguments, " "));
        return {};
    }
    if (options.arguments.size() > action.arguments.size())
        return setup_error(SetupCode::usage, action.arguments.empty()
                                                 ? fmt::format("{} takes no argument", action.name)
                                                 : fmt::format("{} takes no argument {}", action.name,
                                                               in_quotes(options.arguments[action.arguments.size()])));
    for (std::size_t i = 0; i < options.arguments.size(); ++i) {
        const auto key = action.arguments[i];
        if (is_text_key(key)) {
            request[std::string(key)] = options.arguments[i];
            continue;
        }
        const auto number = key == "seconds" ? seconds_of(options.arguments[i]) : number_of(key, options.arguments[i]);
        if (!number) return tl::unexpected(number.error());
        request[std::string(key)] = *number;
    }
    return {};
}

// The faults of both directions, or of each.
SetupResult<void> add_faults(const CtlOptions& options, const Action& action, Json& request) {
    const bool has_options = !options.in.empty() || !options.out.empty() || !options.seed.empty();
    if (action.name != "fault") {
        if (!has_options) return {};
        return setup_error(SetupCode::usage,
                           fmt::format("--in, --out and --seed are for fault, not for {}", action.name));
    }
    const std::string both = request.value("faults", "");
    request.erase("faults");
    if (both.empty() == (options.in.empty() && options.out.empty()))
        return setup_error(SetupCode::usage,
                           "fault takes faults for both directions, as in fault NAME loss:0.1, or "
                           "those of each: fault NAME --in loss:0.1 --out delay:80ms");
    const auto put = [&](const char* key, const std::string& text) {
        if (!text.empty()) request[key] = text;
    };
    put("in", both.empty() ? options.in : both);
    put("out", both.empty() ? options.out : both);
    put("seed", options.seed);
    return {};
}

bool is_action(std::string_view word) { return std::ranges::find(actions(), word, &Action::name) != actions().end(); }

std::string what_runs() {
    const auto running = control::running_programs();
    return running.empty() ? "no router or simulator runs here" : fmt::format("running: {}", fmt::join(running, ", "));
}

// "mavloom ctl takeoff 10" lacks the name of the program that is asked.
SetupError without_name(const CtlOptions& options) {
    const Action& action = *std::ranges::find(actions(), options.name, &Action::name);
    auto typed = fmt::format("mavloom ctl {} {}", action.is_of_vehicles ? "sim" : "router", options.name);
    for (const auto& word : {options.action, fmt::format("{}", fmt::join(options.arguments, " "))})
        if (!word.empty()) typed += " " + shown(word);
    return {SetupCode::usage, 0,
            fmt::format("{} is an action; the name of the {} comes before it: {}; {}", in_quotes(options.name),
                        action.is_of_vehicles ? "simulator" : "router or simulator", typed, what_runs())};
}

SetupResult<void> check_action(const CtlOptions& options) {
    if (is_action(options.action)) return {};
    if (is_action(options.name)) return tl::unexpected(without_name(options));
    const auto names = action_names();
    if (options.action.empty())
        return setup_error(SetupCode::usage,
                           fmt::format("the action is missing: mavloom ctl {} ACTION, which is one of {}",
                                       shown(options.name), fmt::join(names, ", ")));
    auto hint = did_you_mean(options.action, names);
    if (hint.empty()) hint = fmt::format("; there are {}", fmt::join(names, ", "));
    return setup_error(SetupCode::usage, fmt::format("there is no action {}{}", in_quotes(options.action), hint));
}

SetupResult<Json> request_of(const CtlOptions& options) {
    if (options.name.empty())
        return setup_error(SetupCode::usage,
                           fmt::format("the name is missing: mavloom ctl NAME ACTION; {}", what_runs()));
    if (auto good = check_action(options); !good) return tl::unexpected(std::move(good.error()));
    const Action& action = *std::ranges::find(actions(), options.action, &Action::name);
    if (options.action != "wait" && !options.limit.empty())
        return setup_error(SetupCode::usage, fmt::format("--for is for wait, not for {}", action.name));
    Json request{{"cmd", options.action}};
    if (!action.mode.empty()) request = {{"cmd", "mode"}, {"mode", action.mode}};
    if (auto added = add_arguments(options, action, request); !added) return tl::unexpected(std::move(added.error()));
    if (auto added = add_faults(options, action, request); !added) return tl::unexpected(std::move(added.error()));
    if (options.force && action.name != "arm" && action.name != "disarm")
        return setup_error(SetupCode::usage, fmt::format("--force is for arm and disarm, not for {}", action.name));
    if (options.force) request["force"] = true;
    if (options.system.empty()) return request;
    if (!action.is_of_vehicles)
        return setup_error(SetupCode::usage, fmt::format("--system is not for {}", action.name));
    const auto system = number_of("--system", options.system);
    if (!system) return tl::unexpected(system.error());
    request["system"] = *system;
    return request;
}

std::string text_of(const CtlOptions& options, const Lines& lines) {
    constexpr int usual_width = 80;
    if (!lines.empty()) return tables_of(lines, width_of_output(usual_width));
    if (options.action == "routes") return "no routes: no system was heard so far\n";
    return options.action == "links" || options.action == "streams" ? fmt::format("no {}\n", options.action) : "";
}

Exit print_answer(const CtlOptions& options, const Lines& lines) {
    if (options.json || ::isatty(STDOUT_FILENO) == 0) return print_lines(lines);
    return print_at_end(text_of(options, lines), Exit::done);
}

// `land` is sent as `mode`, and `wait` as `state`. A router has neither, and refuses what the user did not type.
SetupError as_typed(SetupError error, const CtlOptions& options, const Json& request) {
    const auto sent = fmt::format("there is no command {};", in_quotes(request.value("cmd", "")));
    if (error.text.starts_with(sent))
        error.text.replace(0, sent.size(), fmt::format("there is no command {};", in_quotes(options.action)));
    return error;
}

Exit wait(const CtlOptions& options) {
    const auto limit = endpoint::parse_duration(options.limit.empty() ? "60s" : options.limit);
    if (!limit) return fail(SetupError(limit.error()).within("--for"));
    auto state = options;
    state.action = "state";
    state.arguments.clear();
    state.limit.clear();
    const auto request = request_of(state);
    if (!request) return fail(request.error());
    if (options.arguments.empty())
        return fail(Exit::wrong_use, std::ranges::find(actions(), "wait", &Action::name)->missing);
    const auto lines = wait_for_state(options.arguments, *limit, [&] { return ask(options.name, *request); });
    return lines ? print_answer(options, *lines) : fail(as_typed(lines.error(), options, *request));
}

Exit ctl(const CtlOptions& options) {
    if (options.action == "wait") return wait(options);
    const auto request = request_of(options);
    if (!request) return fail(request.error());
    const auto lines = ask(options.name, *request);
    return lines ? print_answer(options, *lines) : fail(as_typed(lines.error(), options, *request));
}

}  // namespace

std::vector<std::string> ctl_actions() {
    const auto names = action_names();
    return {names.begin(), names.end()};
}

Run declare_ctl(Arguments command, const Common&) {
    auto options = std::make_shared<CtlOptions>();
    command.add_option(
        "name", "NAME", options->name,
        "the --name of a router or simulator; by default router, or sim. Without it, lists those that run");
    command.add_option("action", "ACTION", options->action, "what to ask or command: one of the list below");
    command.add_option("argument", "ARGUMENT", options->arguments, "what the action takes");
    command.add_option("--system", "N", options->system, "the vehicle with this system id (default: all)");
    command.add_option("--for", "TIME", options->limit, "`wait` ends after this time, with status 1")
        .default_str("60s");
    command.add_option("--in", "FAULTS", options->in, "`fault`: of what arrives (docs/guide/faults.md)");
    command.add_option("--out", "FAULTS", options->out, "`fault`: of what is sent");
    command.add_option("--seed", "N", options->seed, "`fault`: the seed (default: that of the endpoint)");
    command.add_flag("--force", options->force, "arm or disarm even if the vehicle's own checks fail");
    command.add_flag("--json", options->json, "print JSON on a terminal, too");
    command.footer(
        "Prints tables on a terminal. Elsewhere answers are JSON, one object per line (docs/guide/route.md,\n"
        "docs/guide/sim.md). If a vehicle refuses, the exit status is 1, with the vehicle's own text.\n\n"
        "Actions:\n"
        "  links, stats, add URL, remove NAME, fault NAME FAULTS|off\n"
        "Of a router:\n"
        "  routes\n"
        "Of a simulator:\n"
        "  streams, state, arm, disarm, takeoff ALTITUDE, land, rtl, goto LATITUDE LONGITUDE [ALTITUDE], mode NAME,\n"
        "  param NAME [VALUE], fail PART FAULT, wait ready|armed|disarmed|landed, wait alt METRES, pause, resume,\n"
        "  step TIME\n"
        "Of a simulator with --hil:\n"
        "  state, pause, resume, step TIME, reset, push NORTH,EAST,DOWN, turn ROLL,PITCH,YAW, wind SPEED,DIR[,GUST],\n"
        "  mass KG, fail PART FAULT\n\n"
        "Examples:\n"
        "  mavloom ctl router links\n"
        "  mavloom ctl router add 'udpout://192.168.1.20:14550?name=tablet'\n"
        "  mavloom ctl router remove tablet\n"
        "  mavloom ctl router fault tablet loss:0.05/8,delay:80ms~20ms\n"
        "  mavloom ctl router fault tablet off\n"
        "  mavloom ctl sim wait ready\n"
        "  mavloom ctl sim takeoff 10\n"
        "  mavloom ctl sim wait alt 10 --for 30s\n"
        "  mavloom ctl sim fail gps off\n"
        "  mavloom ctl sim mode Return --system 3");
    return [options] { return ctl(*options); };
}

}  // namespace mavloom::app
