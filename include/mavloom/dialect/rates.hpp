// SPDX-License-Identifier: MIT
// The rates of `max_rate`, as an endpoint's option and as `relay --max-rate`: at most so many frames a second of each source and message.
// "ATTITUDE:10" holds for that message, whatever it is. "*:50" holds for each message that is not named and can be thinned
// (message_class.hpp): what a person or a protocol waits for always passes. docs/guide/routing.md, "Filters and limits".
// Immutable values, safe from any thread; compiling allocates, asking does not.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/dialect/terms.hpp"

namespace mavloom::dialect {

class Rates {
public:
    // Limits nothing.
    Rates() = default;
    // Errors are `usage`: an unknown message, with the nearest name; a rate that is no positive number; two rates for one message.
    [[nodiscard]] static SetupResult<Rates> compile(const Dialect& dialect, std::span<const RateTerm> terms);

    [[nodiscard]] bool empty() const noexcept { return rules_.empty() && !others_; }
    // The least time between two frames of this message from one source; null where there is no limit.
    [[nodiscard]] const Nanoseconds* interval_of(MessageId id) const noexcept;

private:
    struct Rule {
        std::uint32_t id = 0;
        std::optional<Nanoseconds> interval{};  // empty: never limited
    };
    [[nodiscard]] SetupResult<void> add(const Dialect& dialect, const RateTerm& term);
    void spare_what_cannot_be_thinned(const Dialect& dialect);

    std::vector<Rule> rules_;  // by rising id
    std::optional<Nanoseconds> others_;
};

// One line for each term that names a message which cannot be thinned: what it limits, and what goes wrong then.
[[nodiscard]] std::vector<std::string> rate_warnings(const Dialect& dialect, std::span<const RateTerm> terms);

}  // namespace mavloom::dialect
