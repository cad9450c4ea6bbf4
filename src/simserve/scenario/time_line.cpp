// SPDX-License-Identifier: MIT
#include "simserve/scenario/time_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <limits>
#include <nlohmann/json.hpp>

#include "mavloom/base/shown.hpp"
#include "mavloom/base/suggest.hpp"
#include "mavloom/endpoint/grammar.hpp"
#include "simserve/scenario/values.hpp"
#include "simserve/scenario/vehicle_fault.hpp"

namespace mavloom::simserve {

namespace {

struct Argument {
    const char* key = nullptr;  // in the request; null: there is none
    enum class Kind : std::uint8_t { number, optional_number, text } kind = Kind::number;
    Range range{-std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};
};

// An order of the time line: its words, and the request that it stands for.
struct OrderForm {
    std::string_view name;
    std::array<Argument, 3> arguments{};
    std::string_view usage;

    [[nodiscard]] std::size_t most() const {
        return static_cast<std::size_t>(std::ranges::count_if(arguments, [](const auto& a) { return a.key; }));
    }
    [[nodiscard]] std::size_t least() const {
        return static_cast<std::size_t>(std::ranges::count_if(
            arguments, [](const auto& a) { return a.key && a.kind != Argument::Kind::optional_number; }));
    }
};

constexpr std::string_view fail_order = "fail";
using Kind = Argument::Kind;
constexpr std::array order_forms{
    OrderForm{"arm", {}, "arm"},
    OrderForm{"disarm", {}, "disarm"},
    OrderForm{"takeoff", {{{"altitude", Kind::number, takeoff_range}}}, "takeoff ALTITUDE"},
    OrderForm{"goto",
              {{{"latitude", Kind::number, latitude_range},
                {"longitude", Kind::number, longitude_range},
                {"altitude", Kind::optional_number}}},
              "goto LATITUDE LONGITUDE [ALTITUDE]"},
    OrderForm{"mode", {{{"mode", Kind::text}}}, "mode NAME"},
    OrderForm{"param", {{{"name", Kind::text}, {"value"}}}, "param NAME VALUE"},
};

std::vector<std::string_view> words_of_order(std::string_view text) {
    auto words = words_of(text);
    if (words == std::vector<std::string_view>{"land"}) return {"mode", "Land"};
    if (words == std::vector<std::string_view>{"rtl"}) return {"mode", "RTL"};
    return words;
}

SetupResult<const OrderForm*> form_of(std::string_view name) {
    std::vector<std::string_view> names{"land", "rtl", fail_order};
    for (const auto& form : order_forms) names.push_back(form.name);
    const auto form = std::ranges::find(order_forms, name, &OrderForm::name);
    if (form != order_forms.end()) return &*form;
    return endpoint::usage(fmt::format("there is no order {}{}; there are {}", in_quotes(name),
                                       did_you_mean(name, names), fmt::join(names, ", ")));
}

SetupResult<std::string> request_of_fault(std::string_view fault, std::optional<SystemId> system) {
    if (const auto good = parse_vehicle_fault(fault); !good) return tl::unexpected(good.error());
    nlohmann::ordered_json request{{"cmd", fail_order}, {"fault", fault}};
    if (system) request["system"] = system->value;
    return request.dump();
}

}  // namespace

std::optional<std::string> fault_of_order(std::string_view text) {
    const auto words = words_of(text);
    if (words.empty() || words.front() != fail_order) return std::nullopt;
    return fmt::format("{}", fmt::join(words.begin() + 1, words.end(), " "));
}

SetupResult<std::string> request_of_order(std::string_view text, std::optional<SystemId> system) {
    if (const auto fault = fault_of_order(text)) return request_of_fault(*fault, system);
    const auto words = words_of_order(text);
    const auto form = form_of(words.empty() ? std::string_view() : words.front());
    if (!form) return tl::unexpected(form.error());
    const auto& its = **form;
    if (words.size() - 1 < its.least() || words.size() - 1 > its.most())
        return endpoint::usage(fmt::format("{}: write {}", in_quotes(text), its.usage));
    nlohmann::ordered_json request{{"cmd", its.name}};
    if (system) request["system"] = system->value;
    for (std::size_t i = 1; i < words.size(); ++i) {
        const auto& argument = its.arguments[i - 1];
        if (argument.kind == Kind::text) {
            request[argument.key] = words[i];
            continue;
        }
        const auto number = parse_number(words[i], argument.range);
        if (!number) return tl::unexpected(SetupError(number.error()).within(argument.key));
        request[argument.key] = *number;
    }
    return request.dump();
}

std::string error_of(const control::Report& report) {
    std::string text;
    for (auto more = report.next_text(); !more.empty(); more = report.next_text()) text += more;
    if (!text.empty()) text.pop_back();
    const auto last = nlohmann::json::parse(text.substr(text.rfind('\n') + 1), nullptr, false);
    return last.is_object() ? last.value("error", std::string()) : "no answer";
}

}  // namespace mavloom::simserve
