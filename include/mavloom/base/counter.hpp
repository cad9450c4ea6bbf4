// SPDX-License-Identifier: MIT
// A counter that one thread increments and any other thread or process can read.
// All accesses are relaxed atomic operations, so reading does not slow the writer down.
#pragma once

#include <atomic>
#include <cstdint>
#include <string_view>

namespace mavloom {

// Exactly one thread may call `add` and `set`. `add` is a plain load and store, not a locked instruction, so two
// writers would lose counts.
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

// A row of the table that lists the counters of a struct. The name is the one in `ctl`, `stat`, the metrics, Python and
// docs/guide/route.md; the help is one line, for the metrics and Python.
template <class Counters>
struct CounterRow {
    std::string_view name, help;
    Counter Counters::*word;
};

}  // namespace mavloom
