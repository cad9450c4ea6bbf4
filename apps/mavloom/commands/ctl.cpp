// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "command.hpp"
#include "commands/ctl_wait.hpp"
#include "mavloom/base/counted.hpp"
#include "mavloom/base/shown.hpp"
#include "mavloom/base/suggest.hpp"
#include "mavloom/control/control.hpp"
#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/shm/counter_page.hpp"
#include "mavloom/shm/ring_info.hpp"
#include "output.hpp"
#include "page/page_hop.hpp"

namespace mavloom::app {

using Json = nlohmann::ordered_json;

namespace {

using namespace std::chrono_literals;

constexpr auto patience = 5s;

SetupResult<std::vector<std::string>> ask(std::string_view name, const Json& request) {
    return control::send_request(name, request.dump(-1, ' ', false, Json::error_handler_t::replace), patience);
}

Exit print_lines(const std::vector<std::string>& lines) {
    std::string text;
    for (const auto& line : lines) text.append(line).push_back('\n');
    return print_at_end(text, Exit::done);
}

// ---- ctl ------------------------------------------------------------------------------------------------------------

struct CtlOptions {
    std::string name, action;
    std::vector<std::string> arguments;
    std::string system;  // of the vehicle; empty: all
    std::string limit;   // of `wait`
    bool force = false;
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
        {"wait", {"state", "metres"}, 1, "wait takes ready, armed, disarmed, landed, or alt and metres", true},
        {"param", {"name", "value"}, 1, "param takes the name of a parameter, and its new value if it is to be set", true},
    };
    return all;
}

std::vector<std::string_view> action_names() {
    std::vector<std::string_view> names;
    for (const Action& action : actions()) names.push_back(action.name);
    return names;
}

SetupResult<double> number_of(std::string_view what, const std::string& text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
        return setup_error(SetupCode::usage, fmt::format("{}: {} is not a number", what, in_quotes(text)));
    return value;
}

SetupResult<void> add_arguments(const CtlOptions& options, const Action& action, Json& request) {
    if (options.arguments.size() < action.fewest) return setup_error(SetupCode::usage, std::string(action.missing));
    if (options.arguments.size() > action.arguments.size())
        return setup_error(SetupCode::usage, action.arguments.empty()
                                                 ? fmt::format("{} takes no argument", action.name)
                                                 : fmt::format("{} takes no argument {}", action.name,
                                                               in_quotes(options.arguments[action.arguments.size()])));
    for (std::size_t i = 0; i < options.arguments.size(); ++i) {
        const auto key = action.arguments[i];
        if (key == "url" || key == "name" || key == "mode") {
            request[std::string(key)] = options.arguments[i];
            continue;
        }
        const auto number = number_of(key, options.arguments[i]);
        if (!number) return tl::unexpected(number.error());
        request[std::string(key)] = *number;
    }
    return {};
}

bool is_action(std::string_view word) { return std::ranges::find(actions(), word, &Action::name) != actions().end(); }

// "mavloom ctl takeoff 10" lacks the name of the program that is asked.
SetupError without_name(const CtlOptions& options) {
    const Action& action = *std::ranges::find(actions(), options.name, &Action::name);
    auto typed = fmt::format("mavloom ctl {} {}", action.is_of_vehicles ? "sim" : "router", options.name);
    for (const auto& word : {options.action, fmt::format("{}", fmt::join(options.arguments, " "))})
        if (!word.empty()) typed += " " + shown(word);
    return {SetupCode::usage, 0,
            fmt::format("{} is an action; the name of the {} comes before it: {}", in_quotes(options.name),
                        action.is_of_vehicles ? "simulator" : "router or simulator", typed)};
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
    if (auto good = check_action(options); !good) return tl::unexpected(std::move(good.error()));
    const Action& action = *std::ranges::find(actions(), options.action, &Action::name);
    if (options.action != "wait" && !options.limit.empty())
        return setup_error(SetupCode::usage, fmt::format("--for is for wait, not for {}", action.name));
    Json request{{"cmd", options.action}};
    if (!action.mode.empty()) request = {{"cmd", "mode"}, {"mode", action.mode}};
    if (auto added = add_arguments(options, action, request); !added) return tl::unexpected(std::move(added.error()));
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
    return lines ? print_lines(*lines) : fail(lines.error());
}

Exit ctl(const CtlOptions& options) {
    if (options.action == "wait") return wait(options);
    const auto request = request_of(options);
    if (!request) return fail(request.error());
    const auto lines = ask(options.name, *request);
    return lines ? print_lines(*lines) : fail(lines.error());
}

// ---- stat -----------------------------------------------------------------------------------------------------------

struct StatOptions {
    std::string name = "router";
    bool json = false;
};

// Formats every nonzero number of an object as "name 12", except the keys in `left_out`.
std::string nonzero(const Json& object, std::initializer_list<std::string_view> left_out) {
    std::string text;
    for (const auto& [key, value] : object.items()) {
        if (!value.is_number_unsigned() || value.get<std::uint64_t>() == 0 ||
            std::ranges::find(left_out, key) != left_out.end())
            continue;
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", key, value.get<std::uint64_t>());
    }
    return text;
}

void print_program(fmt::appender out, const Json& o) {
    const auto counts = nonzero(o, {});
    fmt::format_to(out, "up {:.0f} s{}{}\n", o.value("uptime_s", 0.0), counts.empty() ? "" : "; ", counts);
}
void print_vehicle(fmt::appender out, const Json& o) {
    fmt::format_to(out, "vehicle {} ({}, {}): {}, {}, {:.1f} m above home, battery {:.0f} %\n", o.value("system", 0),
                   o.value("type", ""), o.value("autopilot", ""), o.value("mode", ""),
                   o.value("armed", false) ? "armed" : "disarmed", o.value("relative_alt_m", 0.0),
                   o.value("battery_percent", 0.0));
}
void print_endpoint(fmt::appender out, const Json& o) {
    const auto odd = nonzero(o, {"rcvbuf"});
    if (!odd.empty()) fmt::format_to(out, "endpoint {}: {}\n", o.value("endpoint", ""), odd);
}
void print_gone(fmt::appender out, const Json& o) {
    const auto all = nonzero(o, {});
    if (!all.empty()) fmt::format_to(out, "closed links of {}: {}\n", o.value("endpoint", ""), all);
}
void print_traffic(fmt::appender out, const Json& o) {
    fmt::format_to(out, "  in {}, {}; out {}, {}\n", counted(o.value("frames_in", 0ull), "frame"),
                   counted(o.value("bytes_in", 0ull), "byte"), counted(o.value("frames_out", 0ull), "frame"),
                   counted(o.value("bytes_out", 0ull), "byte"));
    const auto rest = nonzero(o, {"id", "frames_in", "bytes_in", "frames_out", "bytes_out", "forwarded"});
    if (!rest.empty()) fmt::format_to(out, "  {}\n", rest);
}
void print_link(fmt::appender out, const Json& o) {
    fmt::format_to(out, "link {}{}\n", o.value("link", ""), o.value("up", true) ? "" : " (down)");
    print_traffic(out, o);
}
void print_others(fmt::appender out, const Json& o) {
    fmt::format_to(out, "all other links, and closed links\n");
    print_traffic(out, o);
}
void print_page(fmt::appender out, const Json& o) {
    const auto pid = o.value("pid", 0u);
    fmt::format_to(out, "{}, counters of {}\n", o.value("name", ""),
                   o.value("alive", false) ? fmt::format("process {}", pid)
                                           : fmt::format("process {}, which was killed (last values)", pid));
    const auto counts = nonzero(o, {"pid", "started_us"});
    if (!counts.empty()) fmt::format_to(out, "  {}\n", counts);
}
void print_source(fmt::appender out, const Json& o) {
    const auto frames = o.value("frames", 0ull), lost = o.value("lost", 0ull);
    fmt::format_to(out, "source {}/{} on {}: {}, {} lost ({:.2f} %)\n", o.value("sys", 0), o.value("comp", 0),
                   o.value("link", ""), counted(frames, "frame"), lost,
                   frames + lost == 0 ? 0.0 : 100.0 * static_cast<double>(lost) / static_cast<double>(frames + lost));
}
void print_message_rate(fmt::appender out, const Json& o) {
    const auto name = o.at("name").is_null() ? fmt::format("{}", o.value("id", 0)) : o.at("name").get<std::string>();
    const auto frames = o.value("frames", 0ull);
    const auto mode = o.find("mode");
    fmt::format_to(out, "message {:<32} {:>3}/{:<3} {:>10} {:<6} {:>9.2f} Hz  {}{}\n", name, o.value("sys", 0),
                   o.value("comp", 0), frames, plural(frames, "frame"), o.value("rate_hz", 0.0), o.value("link", ""),
                   mode == o.end() || mode->is_null() ? "" : fmt::format("  mode {}", mode->get<std::string>()));
}
void print_recording(fmt::appender out, const Json& o) {
    fmt::format_to(out, "recording {}: {}\n", o.value("endpoint", ""), nonzero(o, {}));
}
void print_unknown_target(fmt::appender out, const Json& o) {
    fmt::format_to(out, "not routed: {} for {}/{}, which was not heard on any link\n",
                   counted(o.value("frames", 0ull), "frame"), o.value("sys", 0), o.value("comp", 0));
}

std::string table_of(const std::vector<std::string>& lines) {
    using Print = void (*)(fmt::appender, const Json&);
    static const std::map<std::string_view, Print> prints{
        {"router", print_program},      {"endpoint", print_endpoint},
        {"sim", print_program},         {"vehicle", print_vehicle},
        {"gone", print_gone},           {"link", print_link},
        {"page", print_page},           {"others", print_others},
        {"source", print_source},       {"message", print_message_rate},
        {"recording", print_recording}, {"unknown_target", print_unknown_target}};
    fmt::memory_buffer text;
    for (const auto& line : lines) {
        const auto object = Json::parse(line, nullptr, false);
        if (!object.is_object()) continue;
        try {
            if (const auto print = prints.find(object.value("kind", "")); print != prints.end())
                print->second(fmt::appender(text), object);
        } catch (const Json::exception&) {}  // skip a line from another version
    }
    return fmt::to_string(text);
}

// Converts the counters of a page (docs/formats/ring.md) to JSON objects like those of a router's answer: one for the
// page, one for each link, one for all other links.
std::vector<std::string> lines_of(std::string_view name, const shm::CounterSnapshot& snapshot) {
    constexpr std::string_view others_prefix = "others_";
    Json page{{"kind", "page"},
              {"name", name},
              {"alive", snapshot.owner_alive},
              {"pid", snapshot.owner_pid},
              {"started_us", unix_us(snapshot.started)}};
    Json others{{"kind", "others"}};
    std::map<LinkId, Json> links;
    for (const auto& counter : snapshot.counters) {
        if (counter.link && counter.label == "up") links[*counter.link]["up"] = counter.value != 0;
        else if (counter.link) links[*counter.link][counter.label] = counter.value;
        else if (counter.label.starts_with(others_prefix))
            others[counter.label.substr(others_prefix.size())] = counter.value;
        else page[counter.label] = counter.value;
    }
    const auto text_of = [](const Json& o) { return o.dump(-1, ' ', false, Json::error_handler_t::replace); };
    std::vector<std::string> lines{text_of(page)};
    for (const auto& [id, counts] : links) {
        const auto known = snapshot.links.find(id);
        Json link{{"kind", "link"}, {"id", id.value}, {"link", known == snapshot.links.end() ? "" : known->second}};
        link.update(counts);
        lines.push_back(text_of(link));
    }
    if (others.size() > 1) lines.push_back(text_of(others));
    return lines;
}

// A router without a ring knows more than its page: what each sender sent.
bool has_all(const shm::CounterSnapshot& page, std::string_view name) {
    const auto rings = shm::ring_names();
    return is_of_simulator(page) || std::ranges::find(rings, name) != rings.end();
}

// Prefers the counter page of a live process, because reading it does not disturb the router. A page that a killed
// process left behind is used only if no router answers.
SetupResult<std::vector<std::string>> stats_of(const std::string& name) {
    const auto page = shm::read_counters(name, {.user = link::Links::owner_of_inlets()});
    if (page && page->owner_alive && has_all(*page, name)) return lines_of(name, *page);
    auto asked = ask(name, {{"cmd", "stats"}});
    if (asked || (!page && page.error().code == SetupCode::not_found)) return asked;
    if (!page) return tl::unexpected(page.error());
    return lines_of(name, *page);
}

Exit stat(const StatOptions& options) {
    const auto lines = stats_of(options.name);
    if (!lines) return fail(lines.error());
    return options.json ? print_lines(*lines) : print_at_end(table_of(*lines), Exit::done);
}

}  // namespace

Run declare_ctl(Arguments command, const Common&) {
    auto options = std::make_shared<CtlOptions>();
    command.add_option("name", "NAME", options->name, "the --name of a router or simulator; by default router, or sim")
        .required();
    command.add_option("action", "ACTION", options->action,
                       "links, stats, add URL, remove NAME; of a router: routes; of a simulator: streams, state, arm, "
                       "disarm, takeoff ALTITUDE, land, rtl, goto LATITUDE LONGITUDE [ALTITUDE], mode NAME, param NAME "
                       "[VALUE], wait STATE (ready, armed, disarmed, landed, alt METRES)");
    command.add_option("argument", "ARGUMENT", options->arguments, "what the action takes");
    command.add_option("--system", "N", options->system, "the vehicle with this system id (default: all)");
    command.add_option("--for", "TIME", options->limit, "`wait` ends after this time, with status 1")
        .default_str("60s");
    command.add_flag("--force", options->force, "arm or disarm even if the vehicle's own checks fail");
    command.footer(
        "Answers are JSON, one object per line (docs/guide/route.md, docs/guide/sim.md). If a vehicle refuses, the "
        "exit\n"
        "status is 1, with the vehicle's own text.\n\nExamples:\n"
        "  mavloom ctl router links\n"
        "  mavloom ctl router add 'udpout://192.168.1.20:14550?name=tablet'\n"
        "  mavloom ctl router remove tablet\n"
        "  mavloom ctl sim wait ready\n"
        "  mavloom ctl sim takeoff 10\n"
        "  mavloom ctl sim wait alt 10 --for 30s\n"
        "  mavloom ctl sim mode Return --system 3");
    return [options] { return ctl(*options); };
}

Run declare_stat(Arguments command, const Common&) {
    auto options = std::make_shared<StatOptions>();
    command.add_option("name", "NAME", options->name, "the --ring of a router or simulator, or its --name")
        .capture_default_str();
    command.add_flag("--json", options->json, "print one JSON object per line");
    command.footer(
        "Reads the counter page of a router's --ring or of a simulator, without involving its process. If a\n"
        "router has no ring, asks the router itself, like `ctl NAME stats`.\n\n"
        "Examples: mavloom stat router\n"
        "          mavloom stat px4 --json\n"
        "          mavloom stat sim");
    return [options] { return stat(*options); };
}

}  // namespace mavloom::app
