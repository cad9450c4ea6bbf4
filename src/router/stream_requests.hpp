// SPDX-License-Identifier: MIT
// Whom an ArduPilot is to be asked for its streams, and when: each source on each link when it is first heard, and again when it is heard 30 s
// later. ArduPilot sends nothing but heartbeats on a link until it is asked. Of more sources than it has room for, the one that was not heard
// for longest makes room: who sends heartbeats outlasts a crowd that is heard once. Private to module router; one owner thread; allocates for
// a new source. Time is a parameter.
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

    // An ArduPilot was heard. True: it is to be asked now.
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
