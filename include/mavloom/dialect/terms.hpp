// SPDX-License-Identifier: MIT
// The words by which options name messages and rates: "ATTITUDE", "30", "ATTITUDE:10,*:50". One grammar for command lines, endpoint options and
// configuration files. Parsing needs no definitions; looking up does. Pure functions; allocate their results. Errors are `usage`.
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

// A message name as a dialect could spell it, or an id of 24 bits.
[[nodiscard]] SetupResult<std::string> parse_message_term(std::string_view text);
// "ATTITUDE:10" or "*:50".
[[nodiscard]] SetupResult<RateTerm> parse_rate_term(std::string_view text);
// A number above 0 that is finite.
[[nodiscard]] SetupResult<double> parse_positive(std::string_view text);

// Calls `each` for the parts of "a,b,c" until one fails; an empty part is an error.
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

// The id of a message by its name in `dialect`, or as the number itself, which needs no definition. The error has the nearest name.
[[nodiscard]] SetupResult<MessageId> find_message_id(const Dialect& dialect, std::string_view name_or_id);
// The definition by name or id.
[[nodiscard]] SetupResult<const Message*> find_message(const Dialect& dialect, std::string_view name_or_id);

}  // namespace mavloom::dialect
