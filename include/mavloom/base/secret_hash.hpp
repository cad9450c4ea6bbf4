// SPDX-License-Identifier: MIT
// A hash for tables whose keys a sender can choose. It depends on a random secret, so that a sender cannot choose keys
// that collide. One multiplication per hash. Hashes differ from run to run: never store them.
#pragma once

#include <cstdint>

#ifndef __SIZEOF_INT128__
#include "mavloom/base/folded_product.hpp"
#endif

namespace mavloom {

#ifdef __SIZEOF_INT128__
// Folds the 128-bit product, so that every bit of the result depends on every bit of both factors.
[[nodiscard]] constexpr std::uint64_t folded_product(std::uint64_t a, std::uint64_t b) noexcept {
    __extension__ using Wide = unsigned __int128;
    const Wide product = static_cast<Wide>(a) * b;
    return static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64);
}
#endif

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
