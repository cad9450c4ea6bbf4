// SPDX-License-Identifier: MIT
// Counters in a page of shared memory, /dev/shm/mavloom.NAME.stat: typed, labelled, readable at any time by anybody who may open it, without the
// program that counts noticing. The page also has the names of links, which records of the ring carry as numbers. docs/formats/ring.md has its bytes.
// CounterPage has one owner thread; each Counter that it gives has one writer. Of fixed size: adding fails when it is full, nothing grows.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/counter.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/base/result.hpp"

namespace mavloom::shm {

class Segment;

enum class CounterType : std::uint32_t {
    counter = 1,  // only grows
    gauge = 2,    // goes up and down
    time_ns = 3,  // Unix time in nanoseconds
};

inline constexpr std::size_t longest_label = 96;       // bytes; longer ones are cut
inline constexpr std::size_t longest_link_name = 104;  // likewise

struct CounterPageOptions {
    std::uint32_t counters = 4096;
    std::uint32_t links = 512;
    unsigned mode = 0600;
};

class CounterPage {
public:
    // Replaces a page whose owner is gone. `in_use` while one lives, with its process; `no_space` before anything is made.
    [[nodiscard]] static SetupResult<CounterPage> create(std::string_view name, const CounterPageOptions& options = {});
    CounterPage(CounterPage&& other) noexcept;
    CounterPage& operator=(CounterPage&& other) noexcept;
    ~CounterPage();  // removes the page

    // A new word, 0, valid until it is removed or the page goes; null when the page is full.
    [[nodiscard]] Counter* add(std::string_view label, CounterType type = CounterType::counter,
                               std::optional<LinkId> link = {}) noexcept;
    // Its word may then stand for another. Null, or what is removed already: nothing happens.
    void remove(Counter* counter) noexcept;

    // False when the page is full. A link that is there already gets the new name.
    bool name_link(LinkId link, std::string_view name);
    void forget_link(LinkId link);

    // Whether somebody removed or replaced the page: who looks now does not find it. Two system calls.
    [[nodiscard]] bool is_removed() const noexcept;

private:
    CounterPage(std::unique_ptr<Segment> segment, const CounterPageOptions& options);
    void end() noexcept;

    std::unique_ptr<Segment> segment_;
    std::uint32_t slots_ = 0;  // of counters; what the page says about it is not asked again
    std::vector<std::uint32_t> free_counters_, free_links_;  // the last one is taken next
    std::map<LinkId, std::uint32_t> links_;
};

struct CounterValue {
    std::string label;
    CounterType type = CounterType::counter;
    std::optional<LinkId> link;
    std::uint64_t value = 0;
};

struct CounterSnapshot {
    bool owner_alive = false;
    std::uint32_t owner_pid = 0;
    WallTime started{};
    std::vector<CounterValue> counters;  // in the order of the page
    std::map<LinkId, std::string> links;
};

// Each value is of some moment during the call. `not_found`, `permission`, `bad_input` as of rings.
[[nodiscard]] SetupResult<CounterSnapshot> read_counters(std::string_view name);

}  // namespace mavloom::shm
