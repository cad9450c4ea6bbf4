// SPDX-License-Identifier: MIT
// Random numbers that are the same on every machine: SplitMix64 (Steele, Lea, Flood: Fast splittable pseudorandom
// number generators, 2014). A stream for each fault. Private to module fault.
#pragma once

#include <cstdint>
#include <string_view>

namespace mavloom::fault::detail {

[[nodiscard]] constexpr std::uint64_t mixed(std::uint64_t word) noexcept {
    word = (word ^ (word >> 30)) * 0xbf58'476d'1ce4'e5b9;
    word = (word ^ (word >> 27)) * 0x94d0'49bb'1331'11eb;
    return word ^ (word >> 31);
}

// Names a stream. Each `with` gives the seed of a part of it.
class Seed {
public:
    explicit constexpr Seed(std::uint64_t value) noexcept : value_(value) {}
    [[nodiscard]] constexpr Seed with(std::uint64_t part) const noexcept { return Seed(mixed(value_ + step) ^ part); }
    [[nodiscard]] constexpr Seed with(std::string_view text) const noexcept {
        Seed seed = with(text.size());
        for (const char letter : text) seed = seed.with(static_cast<unsigned char>(letter));
        return seed;
    }
    [[nodiscard]] constexpr std::uint64_t value() const noexcept { return mixed(value_ + step); }

private:
    static constexpr std::uint64_t step = 0x9e37'79b9'7f4a'7c15;
    std::uint64_t value_;
};

class Draws {
public:
    explicit constexpr Draws(Seed seed) noexcept : state_(seed.value()) {}

    [[nodiscard]] constexpr std::uint64_t next() noexcept { return mixed(state_ += 0x9e37'79b9'7f4a'7c15); }
    // From 0 to below 1.
    [[nodiscard]] constexpr double share() noexcept { return static_cast<double>(next() >> 11) * 0x1p-53; }
    // From 0 to below `end`.
    [[nodiscard]] constexpr std::uint64_t below(std::uint64_t end) noexcept { return next() % end; }
    // True with this probability.
    [[nodiscard]] constexpr bool chance(double probability) noexcept { return share() < probability; }

private:
    std::uint64_t state_;
};

}  // namespace mavloom::fault::detail
