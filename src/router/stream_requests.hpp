// SPDX-License-Identifier: MIT
// Decides when to request the data streams of an ArduPilot. Until it gets a request, an ArduPilot sends only heartbeats
// on a link. The router sends a request when it first hears a source on a link, and again at the first heartbeat after
// 30 s have passed.
//
// Memory is bounded: a new source evicts the one that has been silent longest. A flood of sources that are heard only
// once therefore does not displace those that keep sending heartbeats. Private to module router. One owner thread; time
// is a parameter. Allocates for a new source.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/ids.hpp"

namespace mavloom::router {

class StreamRequests {
public:
    static constexpr std::chrono::seconds interval{30};
    static constexpr std::size_t most_sources = 1024;

    // Notes a heartbeat of an ArduPilot. Returns true if the router should ask it now.
    [[nodiscard]] bool heard(LinkId link, Source source, MonoTime now) {
        const auto asked = std::ranges::find_if(asked_,
                                                [&](const Asked& a) { return a.link == link && a.source == source; });
        if (asked == asked_.end()) {
            const Asked added{link, source, now, now};
            if (asked_.size() < most_sources) asked_.push_back(added);
            else *std::ranges::min_element(asked_, {}, &Asked::heard) = added;
            return true;
        }
        asked->heard = now;
        if (now - asked->at < interval) return false;
        asked->at = now;
        return true;
    }
    void forget(LinkId link) {
        std::erase_if(asked_, [&](const Asked& a) { return a.link == link; });
    }
    void clear() noexcept { asked_.clear(); }

private:
    struct Asked {
        LinkId link;
        Source source;
        MonoTime at, heard;
    };
    std::vector<Asked> asked_;
};

}  // namespace mavloom::router
