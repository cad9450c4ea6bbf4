// SPDX-License-Identifier: MIT
#include "mavloom/route/filter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>

#include "mavloom/dialect/dialect.hpp"

namespace mavloom::route {

namespace {

constexpr std::uint32_t max_message_id = 0xffffff;  // 24 bits on the wire

SetupResult<std::uint32_t> message_id(const dialect::Dialect& dialect, std::string_view name_or_id) {
    const bool digits = !name_or_id.empty() && name_or_id.find_first_not_of("0123456789") == std::string_view::npos;
    if (!digits) {
        const auto message = dialect.message(name_or_id);
        if (!message) return tl::unexpected(message.error());
        return (*message)->id().value;
    }
    std::uint32_t id = 0;
    const auto [end, error] = std::from_chars(name_or_id.data(), name_or_id.data() + name_or_id.size(), id);
    if (error != std::errc{} || id > max_message_id)
        return setup_error(SetupCode::usage, fmt::format("'{}' is no message id (0 to {})", name_or_id, max_message_id));
    return id;
}

SetupResult<std::vector<std::uint32_t>> message_ids(const dialect::Dialect& dialect, const FilterTerms& terms) {
    std::vector<std::uint32_t> ids;
    for (const std::string& name : terms.messages) {
        auto id = message_id(dialect, name);
        if (!id) return tl::unexpected(std::move(id.error()).within(terms.option));
        ids.push_back(*id);
    }
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    return ids;
}

template <std::size_t n>
void set(std::array<std::uint64_t, n>& bits, std::uint32_t at, bool value) noexcept {
    const std::uint64_t bit = std::uint64_t{1} << (at % 64);
    bits[at / 64] = value ? bits[at / 64] | bit : bits[at / 64] & ~bit;
}

template <std::size_t n>
std::array<std::uint64_t, n> all() noexcept {
    std::array<std::uint64_t, n> bits;
    bits.fill(~std::uint64_t{0});
    return bits;
}

std::array<std::uint64_t, 4> passing(std::span<const std::uint8_t> allow, std::span<const std::uint8_t> block) {
    std::array<std::uint64_t, 4> bits{};
    if (allow.empty()) bits = all<4>();
    for (const std::uint8_t id : allow) set(bits, id, true);
    for (const std::uint8_t id : block) set(bits, id, false);
    return bits;
}

}  // namespace

Filter::Filter() noexcept : systems_(all<4>()), components_(all<4>()), near_(all<near_size / 64>()) {}

SetupResult<Filter> Filter::compile(const dialect::Dialect& dialect, const FilterTerms& allow, const FilterTerms& block) {
    const auto allowed = message_ids(dialect, allow);
    if (!allowed) return tl::unexpected(allowed.error());
    const auto blocked = message_ids(dialect, block);
    if (!blocked) return tl::unexpected(blocked.error());
    Filter filter;
    filter.systems_ = passing(allow.systems, block.systems);
    filter.components_ = passing(allow.components, block.components);
    filter.far_passes_ = allowed->empty();
    if (!filter.far_passes_) filter.near_.fill(0);
    const auto is_blocked = [&](std::uint32_t id) { return std::binary_search(blocked->begin(), blocked->end(), id); };
    for (const std::uint32_t id : *allowed) {
        if (is_blocked(id)) continue;
        if (id < near_size) set(filter.near_, id, true);
        else filter.far_.push_back(id);
    }
    for (const std::uint32_t id : *blocked) {
        if (id < near_size) set(filter.near_, id, false);
        else if (filter.far_passes_) filter.far_.push_back(id);
    }
    return filter;
}

bool Filter::admits_far(std::uint32_t id) const noexcept {
    return far_passes_ != std::binary_search(far_.begin(), far_.end(), id);
}

static SetupResult<void> add_rate(const dialect::Dialect& dialect, const RateTerm& term, Rates& rates) {
    const auto wrong = [&](std::string_view what) {
        return setup_error(SetupCode::usage, fmt::format("'{}' {}", term.message, what));
    };
    if (!std::isfinite(term.rate_hz) || term.rate_hz <= 0) return wrong("needs a rate above 0, in Hz");
    constexpr double ten_years_ns = 3653 * 86400e9;
    const Nanoseconds interval{std::llround(std::min(1e9 / term.rate_hz, ten_years_ns))};
    if (term.message == "*") {
        if (rates.others) return wrong("has two rates");
        rates.others = interval;
        return {};
    }
    auto id = message_id(dialect, term.message);
    if (!id) return tl::unexpected(std::move(id.error()));
    const auto at = std::lower_bound(rates.named.begin(), rates.named.end(), *id,
                                     [](const Rates::Named& n, std::uint32_t v) { return n.id < v; });
    if (at != rates.named.end() && at->id == *id) return wrong("has two rates");
    rates.named.insert(at, {*id, interval});
    return {};
}

SetupResult<Rates> Rates::compile(const dialect::Dialect& dialect, std::span<const RateTerm> terms) {
    Rates rates;
    for (const RateTerm& term : terms)
        if (auto done = add_rate(dialect, term, rates); !done)
            return tl::unexpected(std::move(done.error()).within("max_rate"));
    return rates;
}

}  // namespace mavloom::route
