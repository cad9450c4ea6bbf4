// SPDX-License-Identifier: MIT
// Checks the message names in a configuration against a dialect. Separate from reading the file, which needs no
// dialect.
#include <fmt/format.h>

#include <array>
#include <utility>

#include "config/places.hpp"
#include "mavloom/dialect/rates.hpp"

namespace mavloom::config {

namespace {

// The error text for the first term that the dialect does not define; empty if it defines all.
std::string unknown_in(const endpoint::Endpoint& endpoint, std::string_view key, const dialect::Dialect& dialect) {
    const endpoint::EndpointOptions& o = endpoint.options;
    const std::array<std::pair<std::string_view, const endpoint::FilterTerms*>, 4> filters{
        {{"in_allow", &o.in_allow}, {"in_block", &o.in_block}, {"out_allow", &o.out_allow}, {"out_block", &o.out_block}}};
    std::vector<std::string_view> names;
    for (const auto& [name, terms] : filters)
        if (name == key) names.assign(terms->messages.begin(), terms->messages.end());
    if (key == "max_rate")
        for (const endpoint::RateTerm& term : o.max_rate)
            if (term.message != "*") names.push_back(term.message);
    for (const auto name : names)
        if (const auto id = dialect::find_message_id(dialect, name); !id) return id.error().text;
    return {};
}

}  // namespace

SetupResult<void> check_message_names(const Config& config, std::string_view file_name, const dialect::Dialect& dialect) {
    return detail::each_endpoint(
        config, [&](const endpoint::Endpoint& endpoint, const Section& section) -> SetupResult<void> {
            for (const std::string_view key : {"in_allow", "in_block", "out_allow", "out_block", "max_rate"})
                if (const auto what = unknown_in(endpoint, key, dialect); !what.empty())
                    return setup_error(
                        SetupCode::bad_input,
                        fmt::format("{}:{}: {}: {}", file_name, detail::line_of(section, std::array{key}), key, what));
            return {};
        });
}

std::vector<std::string> config_warnings(const Config& config, std::string_view file_name,
                                         const dialect::Dialect& dialect) {
    std::vector<std::string> warnings;
    (void)detail::each_endpoint(
        config, [&](const endpoint::Endpoint& endpoint, const Section& section) -> SetupResult<void> {
            for (const auto& warning : dialect::rate_warnings(dialect, endpoint.options.max_rate))
                warnings.push_back(fmt::format("{}:{}: max_rate={}", file_name,
                                               detail::line_of(section, std::array{std::string_view("max_rate")}),
                                               warning));
            return {};
        });
    return warnings;
}

}  // namespace mavloom::config
