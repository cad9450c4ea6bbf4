// SPDX-License-Identifier: MIT
// The counter page of a router's ring or of a simulator: link names, and copies of counters for other processes to
// read.
//
// One owner thread, which refreshes the copies from time to time.
#pragma once

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/link/links.hpp"
#include "mavloom/shm/counter_page.hpp"

namespace mavloom::ring {

// The link counters that the page contains.
inline constexpr auto paged_counters = [] {
    constexpr auto count = std::ranges::count_if(link::link_counters, &link::LinkCounter::on_page);
    std::array<link::LinkCounter, static_cast<std::size_t>(count)> paged{};
    std::ranges::copy_if(link::link_counters, paged.begin(), &link::LinkCounter::on_page);
    return paged;
}();

// A counter of the program that owns the page.
struct OwnCount {
    std::string_view label;
    std::uint64_t value = 0;
    shm::CounterType type = shm::CounterType::counter;
};

class RingPage {
public:
    static constexpr std::size_t max_rows = 256;  // links that get counters of their own: the busiest ones
    // Number of closed links whose names stay, because the ring still holds their records.
    static constexpr std::size_t max_gone = 1024;
    static constexpr std::size_t max_own_counts = 24;

    [[nodiscard]] static SetupResult<RingPage> create(const std::string& ring, unsigned mode);

    void name_link(LinkId link, std::string_view name);
    void link_removed(LinkId link);
    // Adds the link names that a killed router left in its page. These links count as closed. If there are too many,
    // the page forgets the lowest link numbers first.
    void inherit(const std::map<LinkId, std::string>& names);

    struct OfRing {
        std::uint64_t records = 0, dropped = 0;
    };
    // Copies the current counters into the page. `inlet`: the endpoint that is the ring's inlet, the socket through
    // which readers of the ring send frames. `own`: at most `max_own_counts` counts, the same ones in each call.
    void refresh(const std::vector<link::LinkInfo>& links, const std::vector<link::EndpointInfo>& endpoints,
                 std::optional<link::EndpointId> inlet, const OfRing& ring, std::span<const OwnCount> own = {});
    // See CounterPage::set_aside().
    [[nodiscard]] const std::string& set_aside() const noexcept { return page_.set_aside(); }
    // Returns whether the page was removed or replaced. Makes two system calls.
    [[nodiscard]] bool is_removed() const noexcept { return page_.is_removed(); }

private:
    using Words = std::array<Counter*, paged_counters.size()>;
    struct Row {
        Words words;
        Counter *up, *queued, *queue_limit;
        bool has_destination = false;  // it is known, and beside the name if the name is another
    };

    explicit RingPage(shm::CounterPage page);
    [[nodiscard]] Words add_words(std::string_view before, shm::CounterType type, std::optional<LinkId> link);
    void choose_rows(const std::vector<const link::LinkInfo*>& busiest);
    void add_row(LinkId link);
    void set_destination(const link::LinkInfo& link, const std::vector<link::EndpointInfo>& endpoints, Row& row);
    void remove_row(std::map<LinkId, Row>::iterator row);

    shm::CounterPage page_;
    std::map<LinkId, Row> rows_;
    std::deque<LinkId> gone_;  // the link that closed first comes first
    Words others_{};
    std::vector<Counter*> own_;
    Counter *records_, *dropped_, *links_, *stray_bytes_, *refused_, *evicted_;
};

// Returns the busiest links, at most `most`, ordered by id. Public for tests.
[[nodiscard]] std::vector<const link::LinkInfo*> busiest_links(const std::vector<link::LinkInfo>& links,
                                                               std::size_t most);

}  // namespace mavloom::ring
