// SPDX-License-Identifier: MIT
#include "mavloom/base/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "mavloom/base/text.hpp"

namespace mavloom {

// The Levenshtein distance, ignoring case, computed with a single row.
static std::size_t distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t change = diagonal + (lower(a[i - 1]) != lower(b[j - 1]) ? 1 : 0);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, change});
        }
    }
    return row[b.size()];
}

// True if one begins or ends with the other, which is at least half of it.
static bool extends(std::string_view a, std::string_view b) {
    constexpr std::size_t shortest = 4;
    if (a.size() > b.size()) std::swap(a, b);
    if (a.size() < shortest || b.size() > 2 * a.size()) return false;
    return same_letters(a, b.substr(0, a.size())) || same_letters(a, b.substr(b.size() - a.size()));
}

// True if `typed` is the beginning of `candidate`, for example `dedup` for `dedup_ms`.
static bool begins(std::string_view typed, std::string_view candidate) {
    constexpr std::size_t shortest = 3;
    return typed.size() >= shortest && typed.size() < candidate.size() &&
           same_letters(typed, candidate.substr(0, typed.size()));
}

std::string_view nearest(std::string_view typed, std::span<const std::string_view> candidates) {
    constexpr std::size_t longest_name = 64;  // limits the work for names that come from files
    if (typed.empty() || typed.size() > longest_name) return {};
    std::string_view best;
    std::pair best_edits{typed.size() / 3 + 1, std::size_t{0}};  // where `extends` counts as one; exactly
    for (const auto candidate : candidates) {
        const bool is_extended = extends(typed, candidate);
        if (!is_extended &&
            std::max(candidate.size(), typed.size()) > std::min(candidate.size(), typed.size()) + best_edits.first)
            continue;
        const auto exact = distance(typed, candidate);
        const std::pair edits{is_extended ? std::min(exact, std::size_t{1}) : exact, exact};
        if (edits.first > typed.size() / 3 + 1 || (!best.empty() && edits >= best_edits)) continue;
        best = candidate;
        best_edits = edits;
    }
    if (!best.empty()) return best;
    const auto begun = std::ranges::find_if(candidates, [&](auto candidate) { return begins(typed, candidate); });
    return begun == candidates.end() ? std::string_view{} : *begun;
}

std::string did_you_mean(std::string_view typed, std::span<const std::string_view> candidates) {
    const auto best = nearest(typed, candidates);
    return best.empty() ? std::string{} : fmt::format(", did you mean '{}'?", best);
}

}  // namespace mavloom
