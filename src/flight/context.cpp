// SPDX-License-Identifier: MIT
#include "flight/context.hpp"

namespace mavloom::flight {

std::string filled(std::string_view text, std::string_view value) {
    std::string result(text);
    if (const auto at = result.find("{}"); at != std::string::npos) result.replace(at, 2, value);
    return result;
}

void FlightContext::say(Severity severity, std::string_view text) const {
    if (!text.empty()) observer.on_text(severity, text);
}

Outcome FlightContext::refuse(Result result, std::string_view text, std::string_view value, Severity severity) const {
    std::string why = filled(text, value);
    say(severity, why);
    return {result, std::move(why)};
}

}  // namespace mavloom::flight
