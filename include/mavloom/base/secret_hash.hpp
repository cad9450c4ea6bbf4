// SPDX-License-Identifier: MIT
// A hash for tables whose keys a sender can choose. It depends on a random secret, so that a sender cannot choose keys
// that collide. One multiplication per hash. Hashes differ from run to run: never store them.
#pragma once

#include <cstdint>

namespace mavloom {

// For processors without integers of 128 bits: by four products of 32-bit halves.
[[nodiscard]] constexpr std::uint64_t folded_product_of_halves(std::uint64_t a, std::uint64_t b) noexcept {
    constexpr std::uint64_t half = 0xffff'ffff;
    const std::uint64_t low = (a & half) * (b & half);
    const std::uint64_t mixed = (a >> 32) * (b & half) + (low >> 32);
    const std::uint64_t other = (a & half) * (b >> 32) + (mixed & half);
    const std::uint64_t high = (a >> 32) * (b >> 32) + (mixed >> 32) + (other >> 32);
    return high ^ (other << 32 | (low & half));
}

// The upper 64 bits of the product, xor the lower ones: every bit depends on every bit of both factors.
[[nodiscard]] constexpr std::uint64_t folded_product(std::uint64_t a, std::uint64_t b) noexcept {
#ifdef __SIZEOF_INT128__
    __extension__ using Wide = unsigned __int128;
    const Wide product = static_cast<Wide>(a) * b;
    return static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64);
#else
    return folded_product_of_halves(a, b);
#endif
}

class SecretHash {
public:
    constexpr SecretHash(std::uint64_t a, std::uint64_t b) noexcept : a_(a), b_(b) {}
    // Takes a new secret from the kernel. If the kernel has no random numbers yet, uses fixed values, which a sender
    // can know.
    [[nodiscard]] static SecretHash random() noexcept;

    [[nodiscard]] constexpr std::uint64_t operator()(std::uint64_t key, std::uint64_t more = 0) const noexcept {
        return folded_product(key ^ a_, more ^ b_);
    }

private:
    std::uint64_t a_, b_;
};

// The hash of this process. Its secret is read once, at the start.
inline const SecretHash secret_hash = SecretHash::random();

}  // namespace mavloom
