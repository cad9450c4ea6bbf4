// SPDX-License-Identifier: MIT
#include "mavloom/base/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace mavloom {

static char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

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

// True if `typed` is the beginning of `candidate`, for example `dedup` for `dedup_ms`.
static bool begins(std::string_view typed, std::string_view candidate) {
    constexpr std::size_t shortest = 3;
    return typed.size() >= shortest && typed.size() < candidate.size() &&
           std::equal(typed.begin(), typed.end(), candidate.begin(),
                      [](char a, char b) { return lower(a) == lower(b); });
}

std::string_view nearest(std::string_view typed, std::span<const std::string_view> candidates) {
    constexpr std::size_t longest_name = 64;  // limits the work for names that come from files
    if (typed.empty() || typed.size() > longest_name) return {};
    std::string_view best;
    std::size_t best_distance = typed.size() / 3 + 1;
    for (const auto candidate : candidates) {
        if (candidate.size() > typed.size() + best_distance || typed.size() > candidate.size() + best_distance)
            continue;
        const auto d = distance(typed, candidate);
        if (d < best_distance || (d == best_distance && best.empty())) {
            best = candidate;
            best_distance = d;
        }
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
