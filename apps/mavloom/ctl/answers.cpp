// SPDX-License-Identifier: MIT
#include "ctl/answers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "mavloom/base/counted.hpp"
#include "mavloom/control/control.hpp"
#include "output.hpp"

namespace mavloom::app {

SetupResult<Lines> ask(std::string_view name, const Json& request) {
    constexpr std::chrono::seconds patience{5};
    return control::send_request(name, request.dump(-1, ' ', false, Json::error_handler_t::replace), patience);
}

Exit print_lines(const Lines& lines) {
    std::string text;
    for (const auto& line : lines) text.append(line).push_back('\n');
    return print_at_end(text, Exit::done);
}

std::string nonzero(const Json& object, std::span<const std::string_view> left_out) {
    std::string text;
    for (const auto& [key, value] : object.items()) {
        if (!value.is_number_unsigned() || value.get<std::uint64_t>() == 0 ||
            std::ranges::find(left_out, key) != left_out.end())
            continue;
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", key, value.get<std::uint64_t>());
    }
    return text;
}

namespace {

std::string counts_of(const Json& object, std::initializer_list<std::string_view> left_out) {
    return nonzero(object, {left_out.begin(), left_out.size()});
}

void print_program(fmt::appender out, const Json& o) {
    const auto counts = counts_of(o, {});
    fmt::format_to(out, "up {:.0f} s{}{}\n", o.value("uptime_s", 0.0), counts.empty() ? "" : "; ", counts);
}
void print_vehicle(fmt::appender out, const Json& o) {
    fmt::format_to(out, "vehicle {} ({}, {}): {}, {}, {:.1f} m above home, battery {:.0f} %\n", o.value("system", 0),
                   o.value("type", ""), o.value("autopilot", ""), o.value("mode", ""),
                   o.value("armed", false) ? "armed" : "disarmed", o.value("relative_alt_m", 0.0),
                   o.value("battery_percent", 0.0));
}
void print_hil(fmt::appender out, const Json& o) {
    fmt::format_to(out, "vehicle {} flown by the autopilot at {}: {}, {}, {:.1f} m above home\n  {}\n",
                   o.value("system", 0), o.value("port", ""), o.value("state", ""),
                   o.value("armed", false) ? "armed" : "disarmed", o.value("relative_alt_m", 0.0),
                   counts_of(o, {"system"}));
}
void print_endpoint(fmt::appender out, const Json& o) {
    const auto odd = counts_of(o, {"rcvbuf"});
    if (!odd.empty()) fmt::format_to(out, "endpoint {}: {}\n", o.value("endpoint", ""), odd);
}
void print_gone(fmt::appender out, const Json& o) {
    const auto all = counts_of(o, {});
    if (!all.empty()) fmt::format_to(out, "closed links of {}: {}\n", o.value("endpoint", ""), all);
}
void print_traffic(fmt::appender out, const Json& o) {
    fmt::format_to(out, "  in {}, {}; out {}, {}\n", counted(o.value("frames_in", 0ull), "frame"),
                   counted(o.value("bytes_in", 0ull), "byte"), counted(o.value("frames_out", 0ull), "frame"),
                   counted(o.value("bytes_out", 0ull), "byte"));
    const auto rest = counts_of(
        o, {"id", "frames_in", "bytes_in", "frames_out", "bytes_out", "forwarded", "queue_limit_bytes"});
    if (!rest.empty()) fmt::format_to(out, "  {}\n", rest);
}
void print_link(fmt::appender out, const Json& o) {
    fmt::format_to(out, "link {}{}\n", o.value("link", ""), o.value("up", true) ? "" : " (down)");
    if (const auto faults = o.value("faults", "off"); faults != "off")
        fmt::format_to(out, "  faults on purpose: {}\n", faults);
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
    const auto counts = counts_of(o, {"pid", "started_us"});
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
    fmt::format_to(out, "recording {}: {}\n", o.value("endpoint", ""), counts_of(o, {}));
}
void print_unknown_target(fmt::appender out, const Json& o) {
    fmt::format_to(out, "not routed: {} for {}/{}, which was not heard on any link\n",
                   counted(o.value("frames", 0ull), "frame"), o.value("sys", 0), o.value("comp", 0));
}

}  // namespace

std::string paragraphs_of(const Lines& lines) {
    using Print = void (*)(fmt::appender, const Json&);
    static const std::map<std::string_view, Print> prints{{"router", print_program},
                                                          {"endpoint", print_endpoint},
                                                          {"sim", print_program},
                                                          {"vehicle", print_vehicle},
                                                          {"gone", print_gone},
                                                          {"link", print_link},
                                                          {"page", print_page},
                                                          {"others", print_others},
                                                          {"hil", print_hil},
                                                          {"source", print_source},
                                                          {"message", print_message_rate},
                                                          {"recording", print_recording},
                                                          {"unknown_target", print_unknown_target}};
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

}  // namespace mavloom::app
