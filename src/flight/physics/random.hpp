// SPDX-License-Identifier: MIT
// Random numbers of a vehicle: one seeded generator, so that runs repeat bit for bit on every machine. Private to
// flight and sim. Header only, because noise is drawn thousands of times a second. xoshiro256++ by Blackman and Vigna
// (https://prng.di.unimi.it), seeded through splitmix64. std::normal_distribution is not used: each standard library
// gives different numbers.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace mavloom::flight {

class Random {
public:
    explicit Random(std::uint64_t seed) noexcept {
        for (auto& word : state_) word = split_mix(seed);
    }

    [[nodiscard]] std::uint64_t bits() noexcept {
        const std::uint64_t result = std::rotl(state_[0] + state_[3], 23) + state_[0];
        const std::uint64_t t = state_[1] << 17;
        state_[2] ^= state_[0];
        state_[3] ^= state_[1];
        state_[1] ^= state_[2];
        state_[0] ^= state_[3];
        state_[2] ^= t;
        state_[3] = std::rotl(state_[3], 45);
        return result;
    }
    // In [0, 1).
    [[nodiscard]] double unit() noexcept { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
    // In [low, high).
    [[nodiscard]] double uniform(double low, double high) noexcept { return low + (high - low) * unit(); }
    // Standard normal: the sum of the four 16-bit parts of one draw, scaled. It has mean 0, variance 1 and tails up to
    // 3.46, and costs a fraction of an exact method.
    [[nodiscard]] double normal() noexcept {
        const std::uint64_t b = bits();
        const auto sum = static_cast<std::int64_t>((b & 0xffff) + (b >> 16 & 0xffff) + (b >> 32 & 0xffff) + (b >> 48));
        constexpr double mean = 2 * 65535.0;
        constexpr double deviation = 37837.22722;  // sqrt(4 * (65536^2 - 1) / 12)
        return (static_cast<double>(sum) - mean) / deviation;
    }

private:
    static std::uint64_t split_mix(std::uint64_t& x) noexcept {
        std::uint64_t z = (x += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }

    std::array<std::uint64_t, 4> state_{};
};

}  // namespace mavloom::flight
