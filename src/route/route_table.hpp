// SPDX-License-Identifier: MIT
// The learned routes: which system and component was heard on which link, when, and how often. Lookups return the set
// of links for a system, or for a pair of system and component. Routes expire exactly at the timeout.
//
// Memory is bounded: at most `per_link` routes on one link and `max_routes` in total. A new route evicts the stalest
// route of its link, or, if the table is full, that of the link with the most routes.
//
// Private to module route; one owner thread.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/base/secret_hash.hpp"
#include "route/link_set.hpp"
#include "route/zeroed_array.hpp"

namespace mavloom::route {

using Pair = std::uint16_t;  // system * 256 + component
[[nodiscard]] constexpr Pair pair_of(Source source) noexcept {
    return static_cast<Pair>(source.system.value << 8 | source.component.value);
}
[[nodiscard]] constexpr Source source_of(Pair pair) noexcept {
    return {SystemId{static_cast<std::uint8_t>(pair >> 8)}, ComponentId{static_cast<std::uint8_t>(pair)}};
}

struct Route {
    std::int64_t heard_ns;  // the last frame; steady clock
    std::int64_t since_ns;  // when the route became known, or the claim began
    std::uint64_t frames;
    std::uint32_t older, newer;  // neighbors in the list of the link's routes by age
    Slot slot;
    Pair pair;
    enum class Known : std::uint8_t {
        no,       // forgotten; the entry then only keeps `frames`
        claimed,  // heard, but not believed
        yes
    } known;

    [[nodiscard]] bool is_known() const noexcept { return known == Known::yes; }
};

class RouteTable {
public:
    static constexpr std::size_t pairs = 1u << 16;  // all pairs of system and component
    struct Change {
        std::uint32_t learned = 0, expired = 0, evicted = 0;
    };

    RouteTable(std::size_t max_routes, std::size_t per_link);

    // Sets the number of words in a set of links. Keeps the learned routes.
    void resize(std::size_t words);
    void add_link(Slot slot);
    void remove_link(Slot slot) noexcept;
    void set_timeout(Nanoseconds timeout) noexcept;

    // Removes routes older than the timeout. Call it before using the sets.
    void expire(MonoTime now, Change& change) noexcept {
        if (now.time_since_epoch().count() >= next_expiry_ns_) expire_now(now.time_since_epoch().count(), change);
    }
    // Adds or refreshes the route for a frame of this source. The reference is valid until the next call.
    Route& learn(Slot slot, Pair pair, MonoTime now, Change& change) noexcept;
    // Frames of a source that is not believed on the link, without a gap: the first one, and the one before this.
    struct Claim {
        MonoTime since, last_heard;
    };
    // Notes such a frame.
    Claim claim(Slot slot, Pair pair, MonoTime now, Nanoseconds gap, Change& change) noexcept;
    // Forgets the route, but keeps its count of frames.
    void forget(Slot slot, Pair pair) noexcept;
    // The same for all routes of the system on one link.
    void forget_system(Slot slot, SystemId system) noexcept;
    // Null if the source is not known on the link. Valid until the next call that changes the table.
    [[nodiscard]] const Route* find(Slot slot, Pair pair) const noexcept {
        const std::uint32_t index = index_[place_of(slot, pair)] - 1;
        return index == none || !routes_[index].is_known() ? nullptr : &routes_[index];
    }

    [[nodiscard]] ConstWords links_of(Pair pair) const noexcept { return &pair_links_[pair * words_]; }
    [[nodiscard]] ConstWords links_of(SystemId system) const noexcept { return &system_links_[system.value * words_]; }

    // Calls f(const Route&) for every known route, link by link.
    template <class F>
    void each_known(F&& f) const {
        for (std::size_t slot = 0; slot < links_.size(); ++slot) each_known(static_cast<Slot>(slot), f);
    }
    // The same for one link.
    template <class F>
    void each_known(Slot slot, F&& f) const {
        for (std::uint32_t i = links_[slot].oldest; i != none; i = routes_[i].newer)
            if (routes_[i].is_known()) f(routes_[i]);
    }

private:
    static constexpr std::uint32_t none = ~std::uint32_t{0};
    static constexpr std::int64_t never = std::numeric_limits<std::int64_t>::max();

    struct Link {
        std::uint32_t oldest = none, newest = none;
        std::uint32_t count = 0;
    };

    [[nodiscard]] std::size_t home(Slot slot, Pair pair) const noexcept {
        return secret_hash(std::uint64_t{slot} << 16 | pair) >> shift_;
    }
    [[nodiscard]] std::size_t place_of(Slot slot, Pair pair) const noexcept;
    // Finds or adds the entry, and makes it the newest of its link.
    Route& renew(Slot slot, Pair pair, Change& change) noexcept;
    Route& insert(Slot slot, Pair pair, std::size_t place, Change& change) noexcept;
    void make_room(Slot slot, Change& change) noexcept;
    void set_known(Route& route) noexcept;
    void set_unknown(Route& route) noexcept;
    void append(std::uint32_t index) noexcept;
    void unlink(std::uint32_t index) noexcept;
    void remove(std::uint32_t index) noexcept;
    void erase_place(std::size_t place) noexcept;
    void expire_now(std::int64_t now_ns, Change& change) noexcept;

    std::size_t max_routes_, per_link_, words_ = 1;
    std::size_t used_ = 0;       // the first used_ entries of routes_ have been in use at some time
    std::uint32_t free_ = none;  // head of the free list, linked by `newer`
    std::size_t count_ = 0;
    std::unique_ptr<Route[]> routes_;   // uninitialized, so that pages are touched only when needed
    ZeroedArray<std::uint32_t> index_;  // open addressing by (slot, pair): index into routes_ plus one, or 0
    unsigned shift_;
    std::vector<Link> links_;  // by slot
    std::int64_t timeout_ns_ = 0;
    ZeroedArray<std::uint64_t> pair_links_, system_links_;
    ZeroedArray<std::uint16_t> system_counts_;  // known routes per system and slot
    std::int64_t next_expiry_ns_ = never;       // at or before the earliest expiry
};

}  // namespace mavloom::route
