// SPDX-License-Identifier: MIT
// The counter page of a router's ring: link names, and copies of the link counters for other processes to read.
//
// The router's thread refreshes the copies from time to time. One owner thread.
#pragma once

#include <array>
#include <deque>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/link/links.hpp"
#include "mavloom/shm/counter_page.hpp"

namespace mavloom::ring {

// A link counter that the page contains, and its label.
struct PagedCounter {
    std::string_view label;
    Counter link::LinkCounters::*word;
};
inline constexpr std::array<PagedCounter, 12> paged_counters{{{"frames_in", &link::LinkCounters::frames_in},
                                                              {"bytes_in", &link::LinkCounters::bytes_in},
                                                              {"frames_out", &link::LinkCounters::frames_out},
                                                              {"bytes_out", &link::LinkCounters::bytes_out},
                                                              {"lost", &link::LinkCounters::lost},
                                                              {"crc_error", &link::LinkCounters::crc_error},
                                                              {"junk_bytes", &link::LinkCounters::junk_bytes},
                                                              {"bad_signature", &link::LinkCounters::bad_signature},
                                                              {"queue_bytes", &link::LinkCounters::queue_bytes},
                                                              {"queue_age", &link::LinkCounters::queue_age},
                                                              {"frames_not_sent", &link::LinkCounters::frames_not_sent},
                                                              {"refused", &link::LinkCounters::refused}}};

class RingPage {
public:
    static constexpr std::size_t most_rows = 256;  // links that get counters of their own: the busiest ones
    // Number of closed links whose names stay, because the ring still holds their records.
    static constexpr std::size_t most_gone = 1024;

    [[nodiscard]] static SetupResult<RingPage> create(const std::string& ring, unsigned mode);

    void name_link(LinkId link, std::string_view name);
    void link_went(LinkId link);
    // Adds the link names that a killed router left. They count as closed links. The page forgets the lowest numbers
    // first.
    void inherit(const std::map<LinkId, std::string>& names);

    struct OfRing {
        std::uint64_t records = 0, dropped = 0;
    };
    // Copies the current counters into the page. `inlet`: which of the endpoints is the ring's inlet.
    void refresh(const std::vector<link::LinkInfo>& links, const std::vector<link::EndpointInfo>& endpoints,
                 std::optional<link::EndpointId> inlet, const OfRing& ring);
    // Returns whether the page was removed or replaced. Makes two system calls.
    [[nodiscard]] bool is_removed() const noexcept { return page_.is_removed(); }

private:
    using Words = std::array<Counter*, paged_counters.size()>;

    explicit RingPage(shm::CounterPage page);
    [[nodiscard]] Words add_words(std::string_view before, shm::CounterType type, std::optional<LinkId> link);
    void choose_rows(const std::vector<const link::LinkInfo*>& busiest);
    void add_row(LinkId link);
    void remove_row(std::map<LinkId, Words>::iterator row);

    shm::CounterPage page_;
    std::map<LinkId, Words> rows_;
    std::deque<LinkId> gone_;  // the link that closed first comes first
    Words others_{};
    Counter *records_, *dropped_, *links_, *stray_bytes_, *refused_, *evicted_;
};

// Returns the busiest links, at most `most`, ordered by id. Public for tests.
[[nodiscard]] std::vector<const link::LinkInfo*> busiest_links(const std::vector<link::LinkInfo>& links,
                                                               std::size_t most);

}  // namespace mavloom::ring
