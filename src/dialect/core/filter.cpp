// SPDX-License-Identifier: MIT
#include "mavloom/dialect/filter.hpp"

#include <algorithm>
#include <iterator>

#include "mavloom/dialect/terms.hpp"

namespace mavloom::dialect {

namespace {

using Ids = std::vector<std::uint32_t>;

SetupResult<Ids> message_ids(const Dialect& dialect, const FilterTerms& terms) {
    Ids ids;
    for (const std::string& name : terms.messages) {
        const auto id = find_message_id(dialect, name);
        if (!id) return tl::unexpected(id.error());
        ids.push_back(id->value);
    }
    std::ranges::sort(ids);
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    return ids;
}

template <std::size_t n, class Values>
std::array<std::uint64_t, n> bits_of(const Values& values) noexcept {
    std::array<std::uint64_t, n> bits{};
    for (const std::uint32_t value : values)
        if (value < n * 64) bits[value / 64] |= std::uint64_t{1} << (value % 64);
    return bits;
}

template <std::size_t n, class Values>
void keep(std::array<std::uint64_t, n>& bits, const Values& values) noexcept {
    const auto kept = bits_of<n>(values);
    for (std::size_t i = 0; i < n; ++i) bits[i] &= kept[i];
}

template <std::size_t n, class Values>
void drop(std::array<std::uint64_t, n>& bits, const Values& values) noexcept {
    const auto removed = bits_of<n>(values);
    for (std::size_t i = 0; i < n; ++i) bits[i] &= ~removed[i];
}

}  // namespace

Filter::Filter() noexcept {
    systems_.fill(~std::uint64_t{0});
    components_.fill(~std::uint64_t{0});
    near_.fill(~std::uint64_t{0});
}

Filter Filter::none() noexcept {
    Filter filter;
    filter.systems_.fill(0);
    filter.near_.fill(0);
    filter.far_passes_ = false;
    return filter;
}

SetupResult<void> Filter::allow(const Dialect& dialect, const FilterTerms& terms) {
    const auto ids = message_ids(dialect, terms);
    if (!ids) return tl::unexpected(ids.error());
    if (!terms.systems.empty()) keep(systems_, terms.systems);
    if (!terms.components.empty()) keep(components_, terms.components);
    if (ids->empty()) return {};
    keep(near_, *ids);
    Ids passing;
    std::copy_if(std::ranges::lower_bound(*ids, near_size), ids->end(), std::back_inserter(passing),
                 [&](std::uint32_t id) { return admits_far(id); });
    far_passes_ = false;
    far_ = std::move(passing);
    return {};
}

SetupResult<void> Filter::block(const Dialect& dialect, const FilterTerms& terms) {
    const auto ids = message_ids(dialect, terms);
    if (!ids) return tl::unexpected(ids.error());
    drop(systems_, terms.systems);
    drop(components_, terms.components);
    drop(near_, *ids);
    const auto first_far = std::ranges::lower_bound(*ids, near_size);
    Ids exceptions;
    if (far_passes_) std::set_union(far_.begin(), far_.end(), first_far, ids->end(), std::back_inserter(exceptions));
    else std::set_difference(far_.begin(), far_.end(), first_far, ids->end(), std::back_inserter(exceptions));
    far_ = std::move(exceptions);
    return {};
}

bool Filter::admits_far(std::uint32_t id) const noexcept {
    return far_passes_ != std::binary_search(far_.begin(), far_.end(), id);
}

}  // namespace mavloom::dialect
