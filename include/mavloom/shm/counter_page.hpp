// SPDX-License-Identifier: MIT
// Typed, labelled counters in a page of shared memory, /dev/shm/mavloom.NAME.stat, which other processes can read at
// any time.
//
// Reading does not affect the program that counts. The page also maps the link ids in the ring's records to link names.
// docs/formats/ring.md specifies the format. One thread owns a CounterPage; each Counter that it returns has one
// writer. The page has a fixed size: adding fails when it is full.
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
#include "mavloom/shm/trust.hpp"

namespace mavloom::shm {

class Segment;

enum class CounterType : std::uint32_t {
    counter = 1,  // only increases
    gauge = 2,    // goes up and down
    time_ns = 3,  // Unix time in nanoseconds
};

inline constexpr std::size_t longest_label = 96;       // bytes; longer ones are truncated
inline constexpr std::size_t longest_link_name = 104;  // bytes; longer ones are truncated

struct CounterPageOptions {
    std::uint32_t counters = 4096;
    std::uint32_t links = 512;
    bool sets_aside = false;  // if another user's file has the page's name, renames that file instead of failing
    unsigned mode = 0600;
};

class CounterPage {
public:
    // Creates the page, or replaces one whose owner is gone. Errors: `in_use` if the owner is alive; the text names its
    // process. `no_space` before anything is created.
    [[nodiscard]] static SetupResult<CounterPage> create(std::string_view name, const CounterPageOptions& options = {});
    CounterPage(CounterPage&& other) noexcept;
    CounterPage& operator=(CounterPage&& other) noexcept;
    ~CounterPage();  // removes the page

    // Adds a counter that starts at 0. The pointer is valid until the counter is removed or the page is destroyed.
    // Returns null if the page is full.
    [[nodiscard]] Counter* add(std::string_view label, CounterType type = CounterType::counter,
                               std::optional<LinkId> link = {}) noexcept;
    // Removes a counter. Its memory may be reused for another one. Ignores null and a counter that is already removed.
    void remove(Counter* counter) noexcept;

    // Gives a link a name; renames it if it already has one. `sends_to`: the URL that the link sends to, if the name is
    // not that; it is left out if both are too long together. Returns false if the page is full.
    bool name_link(LinkId link, std::string_view name, std::string_view sends_to = {});
    void forget_link(LinkId link);

    // If `create` renamed a file of another user, the reason; else empty.
    [[nodiscard]] const std::string& set_aside() const noexcept { return set_aside_; }

    // Returns whether the page was removed or replaced, so that new readers cannot find it. Makes two system calls.
    [[nodiscard]] bool is_removed() const noexcept;

private:
    CounterPage(std::unique_ptr<Segment> segment, const CounterPageOptions& options);
    void end() noexcept;

    std::unique_ptr<Segment> segment_;
    std::string set_aside_;
    std::uint32_t slots_ = 0;                                // number of counters; never re-read from the page
    std::vector<std::uint32_t> free_counters_, free_links_;  // free slots; the last one is used next
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
    std::vector<CounterValue> counters;      // in the order of the page
    std::map<LinkId, std::string> links;     // their names
    std::map<LinkId, std::string> sends_to;  // the URLs of those that have one beside their name
};

// Reads a page. Each value is from some moment during the call. Errors as for rings: `not_found`, `bad_input` or
// `permission`. A page that is not trusted is also `permission`.
[[nodiscard]] SetupResult<CounterSnapshot> read_counters(std::string_view name, const Trust& trust = {});

}  // namespace mavloom::shm
