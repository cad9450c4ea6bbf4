// SPDX-License-Identifier: MIT
#include "mavloom/base/secret_hash.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace mavloom {
namespace {

constexpr std::size_t buckets = 4096;

// Multiplies to 1 with the odd `factor`. Each round doubles the number of correct bits.
constexpr std::uint64_t inverse_of(std::uint64_t factor) {
    std::uint64_t inverse = factor;
    for (int round = 0; round < 6; ++round) inverse *= 2 - factor * inverse;
    return inverse;
}

// Keys whose product with a factor that everybody knows has the same upper 52 bits.
std::vector<std::uint64_t> colliding_keys(std::uint64_t factor) {
    std::vector<std::uint64_t> keys;
    for (std::uint64_t product = 0; product < buckets; ++product) keys.push_back(product * inverse_of(factor));
    return keys;
}

template <class Bucket>
int fullest(const std::vector<std::uint64_t>& keys, Bucket&& bucket) {
    std::vector<int> counts(buckets);
    for (const std::uint64_t key : keys) ++counts[bucket(key)];
    return *std::ranges::max_element(counts);
}

// Products of Python's integers.
TEST(FoldedProduct, IsTheSameWithAndWithoutWideIntegers) {
    struct Case {
        std::uint64_t a, b, folded;
    };
    constexpr std::uint64_t most = ~std::uint64_t{0};
    for (const auto& [a, b, folded] :
         {Case{0, 0, 0}, Case{1, 1, 1}, Case{most, most, most}, Case{1ull << 63, 2, 1}, Case{1ull << 32, 1ull << 32, 1},
          Case{0x9e3779b97f4a7c15, 0xc2b2ae3d27d4eb4f, 0x8dd9092e2a448508},
          Case{0xffffffff, 0xffffffff00000001, 0x100000001}}) {
        EXPECT_EQ(folded_product(a, b), folded);
        EXPECT_EQ(folded_product_of_halves(a, b), folded);
    }
}

TEST(SecretHash, SpreadsKeysThatCollideUnderAKnownFactor) {
    for (const std::uint64_t known : {0x9e3779b97f4a7c15u, 0xd6e8feb86659fd93u}) {
        const auto keys = colliding_keys(known);
        ASSERT_EQ(fullest(keys, [&](std::uint64_t key) { return key * known >> 52; }), int{buckets});
        const SecretHash sut(0x3c6ef372fe94f82bu, 0xa54ff53a5f1d36f1u);
        EXPECT_LT(fullest(keys, [&](std::uint64_t key) { return sut(key) >> 52; }), 64);
        EXPECT_LT(fullest(keys, [&](std::uint64_t key) { return sut(key) % buckets; }), 64);
        EXPECT_LT(fullest(keys, [&](std::uint64_t key) { return sut(1, key) % buckets; }), 64);
    }
}

TEST(SecretHash, AnotherSecretGivesAnotherOrder) {
    const SecretHash one = SecretHash::random(), other = SecretHash::random();
    const auto order = [](const SecretHash& hash) {
        std::vector<std::uint64_t> keys(100);
        for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = i;
        std::ranges::sort(keys, {}, hash);
        return keys;
    };
    EXPECT_NE(order(one), order(other));
    EXPECT_EQ(order(one), order(one));
}

TEST(SecretHash, TheProcessHasASecret) {
    const SecretHash known(0x9e3779b97f4a7c15u, 0xd6e8feb86659fd93u);  // what is used without one
    EXPECT_NE(secret_hash(1), known(1));
    EXPECT_NE(secret_hash(1), secret_hash(2));
    EXPECT_EQ(secret_hash(1), secret_hash(1));
}

}  // namespace
}  // namespace mavloom
