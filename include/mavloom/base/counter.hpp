// SPDX-License-Identifier: MIT
// Counters as single-writer relaxed words: one thread adds, any thread (or process, over a shared page) reads without disturbing it.
#pragma once

#include <atomic>
#include <cstdint>

namespace mavloom {

// One word that its single writer owns. `add` is a plain load and store, not a locked instruction: two writers would lose counts.
class Counter {
public:
    constexpr Counter() noexcept = default;
    Counter(const Counter& other) noexcept : word_(other.value()) {}
    Counter& operator=(const Counter& other) noexcept {
        word_.store(other.value(), std::memory_order_relaxed);
        return *this;
    }

    void add(std::uint64_t n = 1) noexcept { word_.store(value() + n, std::memory_order_relaxed); }
    void set(std::uint64_t n) noexcept { word_.store(n, std::memory_order_relaxed); }
    [[nodiscard]] std::uint64_t value() const noexcept { return word_.load(std::memory_order_relaxed); }

private:
    std::atomic<std::uint64_t> word_{0};
};

static_assert(sizeof(Counter) == 8, "counters also live in a shared page");

}  // namespace mavloom
