// SPDX-License-Identifier: MIT
// Parses the terms that options use for messages and rates: "ATTITUDE", "30", "ATTITUDE:10,*:50".
// Command lines, endpoint options and configuration files share this grammar. Parsing needs no definitions; the find
// functions do. Pure functions that allocate their results. Errors are `usage`.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/ids.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/dialect/dialect.hpp"

namespace mavloom::dialect {

struct RateTerm {
    std::string message;  // a name, an id, or "*"
    double rate_hz = 0;   // above 0, finite
    friend bool operator==(const RateTerm&, const RateTerm&) = default;
};

// Accepts a well-formed message name, or a 24-bit id. The name need not exist.
[[nodiscard]] SetupResult<std::string> parse_message_term(std::string_view text);
// Parses "ATTITUDE:10" or "*:50".
[[nodiscard]] SetupResult<RateTerm> parse_rate_term(std::string_view text);
// Parses a finite number above 0.
[[nodiscard]] SetupResult<double> parse_positive(std::string_view text);

// Calls `each` for every part of "a,b,c" until one fails. An empty part is an error.
template <class F>
SetupResult<void> for_each_term(std::string_view text, F&& each) {
    while (true) {
        const auto comma = text.find(',');
        const auto term = text.substr(0, comma);
        if (term.empty()) return setup_error(SetupCode::usage, "an empty term between commas");
        if (auto done = each(term); !done) return done;
        if (comma == std::string_view::npos) return {};
        text.remove_prefix(comma + 1);
    }
}

// Looks up the id of a message by name. A number is taken as the id itself and needs no definition.
// The error suggests the closest name.
[[nodiscard]] SetupResult<MessageId> find_message_id(const Dialect& dialect, std::string_view name_or_id);
// Looks up a definition by name or id.
[[nodiscard]] SetupResult<const Message*> find_message(const Dialect& dialect, std::string_view name_or_id);

}  // namespace mavloom::dialect
