// SPDX-License-Identifier: MIT
// A histogram of short times. Each power of two of nanoseconds has eight buckets, so quantiles are at most 13 % too
// large. A plain value; nothing allocates.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "mavloom/base/clock.hpp"

namespace mavloom::hil {

class StepTimes {
public:
    void add(Nanoseconds time) noexcept {
        ++counts_[bucket_of(time.count() < 0 ? 0 : static_cast<std::uint64_t>(time.count()))];
        ++total_;
    }
    // The upper bound of the bucket in which the quantile lies; 0 if nothing was added. `quantile` is 0 to 1.
    [[nodiscard]] Nanoseconds at(double quantile) const noexcept {
        if (total_ == 0) return {};
        const auto wanted = static_cast<std::uint64_t>(quantile * static_cast<double>(total_ - 1)) + 1;
        std::uint64_t seen = 0;
        for (std::size_t bucket = 0; bucket < counts_.size(); ++bucket)
            if (seen += counts_[bucket]; seen >= wanted) return end_of(bucket);
        return {};
    }

private:
    static constexpr unsigned part_bits = 3, parts = 1u << part_bits;
    static constexpr unsigned max_bits = 35;  // half a minute

    [[nodiscard]] static std::size_t bucket_of(std::uint64_t time) noexcept {
        if (time < parts) return static_cast<std::size_t>(time);
        if (time >> max_bits != 0) return std::tuple_size_v<decltype(counts_)> - 1;
        const auto exponent = static_cast<unsigned>(std::bit_width(time)) - 1 - part_bits;
        return (exponent + 1) * parts + static_cast<std::size_t>(time >> exponent) - parts;
    }
    [[nodiscard]] static Nanoseconds end_of(std::size_t bucket) noexcept {
        if (bucket < parts) return Nanoseconds{static_cast<std::int64_t>(bucket)};
        const auto exponent = bucket / parts - 1;
        return Nanoseconds{static_cast<std::int64_t>((bucket % parts + parts + 1) << exponent) - 1};
    }

    std::array<std::uint64_t, (max_bits - part_bits + 1) * parts> counts_{};
    std::uint64_t total_ = 0;
};

}  // namespace mavloom::hil
