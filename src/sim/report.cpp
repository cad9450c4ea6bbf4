// SPDX-License-Identifier: MIT
#include "mavloom/sim/report.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

namespace mavloom::sim {

namespace {

constexpr std::int64_t first_bucket_ns = 10'000;

}  // namespace

void Lateness::add(Nanoseconds late) noexcept {
    const auto units = static_cast<std::uint64_t>(std::max<std::int64_t>(late.count(), 0) / first_bucket_ns);
    ++counts[std::min<std::size_t>(static_cast<std::size_t>(std::bit_width(units)), buckets - 1)];
}

Nanoseconds Lateness::at(double quantile) const noexcept {
    const auto total = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
    if (total == 0) return Nanoseconds{0};
    const double wanted = quantile * static_cast<double>(total);
    std::uint64_t seen = 0;
    std::size_t bucket = 0;
    for (; bucket + 1 < buckets; ++bucket) {
        seen += counts[bucket];
        if (static_cast<double>(seen) >= wanted) break;
    }
    return Nanoseconds{first_bucket_ns << bucket};
}

}  // namespace mavloom::sim
