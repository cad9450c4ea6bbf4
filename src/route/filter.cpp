// SPDX-License-Identifier: MIT
#include "mavloom/route/filter.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "mavloom/dialect/terms.hpp"

namespace mavloom::route {

namespace {

SetupResult<std::vector<std::uint32_t>> message_ids(const dialect::Dialect& dialect, const FilterTerms& terms) {
    std::vector<std::uint32_t> ids;
    for (const std::string& name : terms.messages) {
        const auto id = dialect::find_message_id(dialect, name);
        if (!id) return tl::unexpected(SetupError(id.error()).within(terms.option));
        ids.push_back(id->value);
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

}  // namespace mavloom::route
