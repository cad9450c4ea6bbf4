// SPDX-License-Identifier: MIT
#include "simserve/scenario/vehicle_fault.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "mavloom/base/shown.hpp"
#include "mavloom/base/suggest.hpp"
#include "mavloom/endpoint/grammar.hpp"
#include "simserve/scenario/values.hpp"

namespace mavloom::simserve {

namespace {

using endpoint::usage;
using sim::FaultForm;
using sim::FaultKind;
using sim::FaultPart;

std::string_view name_of(FaultKind kind) { return sim::fault_kind_names[static_cast<std::size_t>(kind)]; }

std::string written(const FaultForm& form) {
    return form.usage.empty() ? std::string(name_of(form.kind)) : fmt::format("{} {}", name_of(form.kind), form.usage);
}

std::vector<std::string> forms_of(FaultPart part) {
    std::vector<std::string> all;
    for (const FaultForm& form : sim::fault_forms())
        if (form.part == part) all.push_back(written(form));
    return all;
}

SetupResult<FaultPart> part_of(std::string_view word) {
    const auto* const found = std::ranges::find(sim::fault_part_names, word);
    if (found != std::end(sim::fault_part_names))
        return static_cast<FaultPart>(found - std::begin(sim::fault_part_names));
    const std::vector<std::string_view> names(std::begin(sim::fault_part_names), std::end(sim::fault_part_names));
    return usage(fmt::format("a vehicle has no part {}{}; there are {}", in_quotes(word), did_you_mean(word, names),
                             fmt::join(names, ", ")));
}

SetupResult<const FaultForm*> form_of_fault(FaultPart part, std::string_view part_name, std::string_view word) {
    const auto forms = sim::fault_forms();
    const auto found = std::ranges::find_if(
        forms, [&](const FaultForm& form) { return form.part == part && name_of(form.kind) == word; });
    if (found != forms.end()) return &*found;
    return usage(fmt::format("{} takes {}, not {}", part_name, fmt::join(forms_of(part), ", "), in_quotes(word)));
}

SetupResult<double> number_for(const FaultForm& form, std::string_view word) {
    auto number = parse_number(word, {form.lowest, form.highest});
    const bool is_whole = form.part == FaultPart::motor || form.part == FaultPart::esc;
    if (number && is_whole && *number != std::floor(*number))
        return usage(fmt::format("{} is not a whole number", in_quotes(word)));
    return number;
}

}  // namespace

SetupResult<sim::Fault> parse_vehicle_fault(std::string_view text) {
    const auto words = words_of(text);
    if (words.size() < 2) return usage(fmt::format("{}: write PART FAULT, as in gps off", in_quotes(text)));
    const auto part = part_of(words[0]);
    if (!part) return tl::unexpected(part.error());
    const auto form = form_of_fault(*part, words[0], words[1]);
    if (!form) return tl::unexpected(form.error());
    const FaultForm& its = **form;
    if (words.size() - 2 < its.fewest || words.size() - 2 > its.most)
        return usage(fmt::format("{}: write {} {}", in_quotes(text), words[0], written(its)));
    sim::Fault fault{.part = its.part, .kind = its.kind};
    for (std::size_t i = 2; i < words.size(); ++i) {
        const auto number = number_for(its, words[i]);
        if (!number) return tl::unexpected(SetupError(number.error()).within(its.usage));
        fault.numbers.at(fault.count++) = *number;
    }
    return fault;
}

}  // namespace mavloom::simserve
