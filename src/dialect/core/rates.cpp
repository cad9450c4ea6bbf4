// SPDX-License-Identifier: MIT
#include "mavloom/dialect/rates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "mavloom/dialect/message_class.hpp"

namespace mavloom::dialect {

SetupResult<Rates> Rates::compile(const Dialect& dialect, std::span<const RateTerm> terms) {
    Rates rates;
    for (const RateTerm& term : terms)
        if (auto done = rates.add(dialect, term); !done) return tl::unexpected(std::move(done.error()));
    if (rates.others_) rates.exempt_unthinnable_messages(dialect);
    return rates;
}

SetupResult<void> Rates::add(const Dialect& dialect, const RateTerm& term) {
    const auto wrong = [&](std::string_view what) {
        return setup_error(SetupCode::usage, fmt::format("'{}' {}", term.message, what));
    };
    if (!std::isfinite(term.rate_hz) || term.rate_hz <= 0) return wrong("needs a rate above 0, in Hz");
    constexpr double ten_years_ns = 3653 * 86400e9;
    const Nanoseconds interval{std::llround(std::min(1e9 / term.rate_hz, ten_years_ns))};
    if (term.message == "*") {
        if (others_) return wrong("has two rates");
        others_ = interval;
        return {};
    }
    const auto id = find_message_id(dialect, term.message);
    if (!id) return tl::unexpected(id.error());
    const auto at = std::ranges::lower_bound(rules_, id->value, {}, &Rule::id);
    if (at != rules_.end() && at->id == id->value) return wrong("has two rates");
    rules_.insert(at, {id->value, interval});
    return {};
}

void Rates::exempt_unthinnable_messages(const Dialect& dialect) {
    const auto named = rules_;
    for (const auto& message : dialect.messages()) {
        const bool is_named = std::ranges::binary_search(named, message.id().value, {}, &Rule::id);
        if (!is_named && !can_be_thinned(message.id(), &message.wire)) rules_.push_back({message.id().value, {}});
    }
    std::ranges::sort(rules_, {}, &Rule::id);
}

const Nanoseconds* Rates::interval_of(MessageId id) const noexcept {
    const auto rule = std::ranges::lower_bound(rules_, id.value, {}, &Rule::id);
    const auto& interval = rule != rules_.end() && rule->id == id.value ? rule->interval : others_;
    return interval ? &*interval : nullptr;
}

std::vector<std::string> rate_warnings(const Dialect& dialect, std::span<const RateTerm> terms) {
    std::vector<std::string> warnings;
    for (const RateTerm& term : terms) {
        const auto id = term.message == "*" ? std::nullopt : std::optional(find_message_id(dialect, term.message));
        if (!id || !*id) continue;
        const auto harm = harm_of_thinning(**id, dialect.wire_table().find(**id));
        if (!harm.empty())
            warnings.push_back(fmt::format("{}:{} drops {} frames over that rate: {}", term.message, term.rate_hz,
                                           dialect.find(**id) == nullptr ? term.message : dialect.find(**id)->name,
                                           harm));
    }
    return warnings;
}

}  // namespace mavloom::dialect
