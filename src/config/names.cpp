// SPDX-License-Identifier: MIT
// Checks the message names in a configuration against a dialect. Separate from reading the file, which needs no
// dialect.
#include <fmt/format.h>

#include <array>
#include <utility>

#include "config/places.hpp"
#include "mavloom/dialect/filter.hpp"
#include "mavloom/dialect/rates.hpp"

namespace mavloom::config {

namespace {

using Filter = std::pair<std::string_view, endpoint::FilterTerms endpoint::EndpointOptions::*>;
constexpr std::array filters{Filter{"in_allow", &endpoint::EndpointOptions::in_allow},
                             Filter{"in_block", &endpoint::EndpointOptions::in_block},
                             Filter{"out_allow", &endpoint::EndpointOptions::out_allow},
                             Filter{"out_block", &endpoint::EndpointOptions::out_block}};

}  // namespace

SetupResult<void> check_message_names(const Config& config, std::string_view file_name, const dialect::Dialect& dialect) {
    return detail::each_endpoint(
        config, [&](const endpoint::Endpoint& endpoint, const Section& section) -> SetupResult<void> {
            const auto wrong = [&](std::string_view key, const SetupError& error) {
                return setup_error(
                    SetupCode::bad_input,
                    fmt::format("{}:{}: {}: {}", file_name, detail::line_of(section, std::array{key}), key, error.text));
            };
            for (const auto& [key, terms] : filters)
                if (const auto done = dialect::Filter().allow(dialect, endpoint.options.*terms); !done)
                    return wrong(key, done.error());
            const auto rates = dialect::Rates::compile(dialect, endpoint.options.max_rate);
            return rates ? SetupResult<void>{} : wrong("max_rate", rates.error());
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
