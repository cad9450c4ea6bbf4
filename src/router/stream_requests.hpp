// SPDX-License-Identifier: MIT
// Decides when to request the data streams of an ArduPilot. Until it gets a request, an ArduPilot sends little more
// than heartbeats on a link. The router sends a request when it first hears a source on a link, and again at the first
// heartbeat after 30 s have passed.
//
// New sources are asked at a limited rate; a source above that rate is asked at a later heartbeat. Memory is bounded: a
// new source evicts the one that has been silent longest. So a flood of invented sources neither costs much nor
// displaces those that keep sending heartbeats. Private to module router. One owner thread; time is a parameter.
// Allocates for a new source.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <unordered_map>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/base/pace.hpp"
#include "mavloom/base/secret_hash.hpp"

namespace mavloom::router {

class StreamRequests {
public:
    static constexpr std::chrono::seconds interval{30};
    static constexpr std::size_t max_sources = 1024;
    static constexpr int new_at_once = 256, new_per_second = 20;

    // Notes a heartbeat of an ArduPilot. Returns true if the router should ask it now.
    [[nodiscard]] bool heard(LinkId link, Source source, MonoTime now) {
        const auto found = asked_.find(key_of(link, source));
        if (found == asked_.end()) return add(key_of(link, source), now);
        Asked& asked = found->second;
        asked.heard = now;
        if (now - asked.at < interval) return false;
        asked.at = now;
        return true;
    }
    void forget(LinkId link) {
        std::erase_if(asked_, [&](const auto& entry) { return entry.first >> 16 == link.value; });
    }
    void clear() noexcept { asked_.clear(); }

private:
    using Key = std::uint64_t;
    struct Hash {
        std::size_t operator()(Key key) const noexcept { return secret_hash(key); }
    };
    struct Asked {
        MonoTime at, heard;
    };

    [[nodiscard]] static Key key_of(LinkId link, Source source) noexcept {
        return Key{link.value} << 16 | Key{source.system.value} << 8 | source.component.value;
    }
    [[nodiscard]] bool add(Key key, MonoTime now) {
        if (!pace_.take(now)) return false;
        if (asked_.size() >= max_sources)
            asked_.erase(std::ranges::min_element(asked_, {}, [](const auto& entry) { return entry.second.heard; }));
        asked_.emplace(key, Asked{now, now});
        return true;
    }

    std::unordered_map<Key, Asked, Hash> asked_;
    static constexpr Nanoseconds new_interval = Nanoseconds{std::chrono::seconds{1}} / new_per_second;
    Pace pace_{new_interval, new_at_once};
};

}  // namespace mavloom::router
