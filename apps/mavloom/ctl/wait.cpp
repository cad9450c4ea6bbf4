// SPDX-License-Identifier: MIT
#include "ctl/wait.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "mavloom/base/shown.hpp"

namespace mavloom::app {

namespace {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;
using Condition = std::function<bool(const Json&)>;

constexpr auto between_questions = 100ms;
constexpr double close_m = 0.5;

std::optional<double> metres_of(const std::string& text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

SetupResult<Condition> condition_of(const std::vector<std::string>& words) {
    const auto& word = words.front();
    if (word == "alt" && words.size() == 2)
        if (const auto metres = metres_of(words[1]))
            return [height = *metres](const Json& vehicle) {
                return std::abs(vehicle.value("relative_alt_m", HUGE_VAL) - height) <= close_m;
            };
    if (words.size() == 1 && word == "ready") return [](const Json& vehicle) { return vehicle.value("ready", false); };
    if (words.size() == 1 && word == "armed") return [](const Json& vehicle) { return vehicle.value("armed", false); };
    if (words.size() == 1 && word == "disarmed")
        return [](const Json& vehicle) { return !vehicle.value("armed", true); };
    if (words.size() == 1 && word == "landed")
        return [](const Json& vehicle) { return vehicle.value("landed_state", "") == "on_ground"; };
    return setup_error(
        SetupCode::usage,
        fmt::format("wait takes ready, armed, disarmed, landed, or alt and the metres above home, not {}",
                    in_quotes(fmt::format("{}", fmt::join(words, " ")))));
}

bool holds_for_all(const std::vector<std::string>& lines, const Condition& condition) {
    return !lines.empty() && std::ranges::all_of(lines, [&](const std::string& line) {
        const auto vehicle = Json::parse(line, nullptr, false);
        return vehicle.is_object() && condition(vehicle);
    });
}

// "vehicle 1: Hold, armed, in_air, 8.6 m above home". A simulator for PX4 has `state` in place of the mode.
std::string brief_state(const std::string& line) {
    const auto o = Json::parse(line, nullptr, false);
    if (!o.is_object()) return line;
    auto text = fmt::format("vehicle {}: {}, {}", o.value("system", 0), o.value("mode", o.value("state", "")),
                            o.value("armed", false) ? "armed" : "disarmed");
    if (const auto landed = o.value("landed_state", ""); !landed.empty()) text += ", " + landed;
    return text + fmt::format("{}, {:.1f} m above home", o.value("ready", true) ? "" : ", not ready",
                              o.value("relative_alt_m", 0.0));
}

std::string brief_states(const std::vector<std::string>& lines) {
    std::string text;
    for (const auto& line : lines) text += (text.empty() ? "" : "; ") + brief_state(line);
    return text;
}

bool is_flown_by_px4(const std::vector<std::string>& lines) {
    return std::ranges::any_of(lines, [](const std::string& line) {
        const auto object = Json::parse(line, nullptr, false);
        return object.is_object() && object.value("kind", "") == "hil";
    });
}

}  // namespace

SetupResult<std::vector<std::string>> wait_for_state(const std::vector<std::string>& words, Nanoseconds limit,
                                                     const AskState& ask) {
    const auto condition = condition_of(words);
    if (!condition) return tl::unexpected(condition.error());
    for (const auto end = mono_now() + limit;;) {
        auto lines = ask();
        if (lines && words.front() == "ready" && is_flown_by_px4(*lines))
            return setup_error(SetupCode::usage,
                               "PX4 flies the vehicles, and only PX4 knows when they are ready; "
                               "armed, disarmed, landed and alt can be waited for");
        if (!lines || holds_for_all(*lines, *condition)) return lines;
        if (mono_now() >= end)
            return setup_error(
                SetupCode::unreachable,
                fmt::format("waited {:.1f} s for {}; the vehicles are not there yet: {}",
                            std::chrono::duration<double>(limit).count(), fmt::join(words, " "), brief_states(*lines)));
        std::this_thread::sleep_for(between_questions);
    }
}

}  // namespace mavloom::app
