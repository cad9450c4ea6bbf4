// SPDX-License-Identifier: MIT
// The limits set by the endpoint option `max_rate` and by `relay --max-rate`.
// Each limit is in frames per second, for each source and message.
// - "ATTITUDE:10" limits that message, whatever its class.
// - "*:50" limits every message that has no term of its own and can be thinned (message_class.hpp). Commands, missions
//   and parameters always pass it.
//
// See docs/guide/routing.md, "Filters and limits".
// Immutable values, safe from any thread. `compile` allocates; `interval_of` does not.
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
    // Errors are `usage`: an unknown message (suggests the closest name), a rate that is not a positive number, or two
    // rates for one message.
    [[nodiscard]] static SetupResult<Rates> compile(const Dialect& dialect, std::span<const RateTerm> terms);

    [[nodiscard]] bool empty() const noexcept { return rules_.empty() && !others_; }
    // The minimum time between two frames of this message from one source; null if there is no limit.
    [[nodiscard]] const Nanoseconds* interval_of(MessageId id) const noexcept;

private:
    struct Rule {
        std::uint32_t id = 0;
        std::optional<Nanoseconds> interval{};  // empty: never limited
    };
    [[nodiscard]] SetupResult<void> add(const Dialect& dialect, const RateTerm& term);
    void exempt_unthinnable_messages(const Dialect& dialect);

    std::vector<Rule> rules_;  // by ascending id
    std::optional<Nanoseconds> others_;
};

// Returns one warning for each term that limits a message which cannot be thinned. It states what the limit drops and
// what harm that does.
[[nodiscard]] std::vector<std::string> rate_warnings(const Dialect& dialect, std::span<const RateTerm> terms);

}  // namespace mavloom::dialect
