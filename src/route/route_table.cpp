// SPDX-License-Identifier: MIT
#include "route/route_table.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <type_traits>

namespace mavloom::route {

static_assert(std::is_trivially_default_constructible_v<Route>, "so that no page is touched before it is needed");

static constexpr std::size_t systems = 256;

RouteTable::RouteTable(std::size_t max_routes, std::size_t per_link)
    : max_routes_(max_routes),
      per_link_(per_link),
      routes_(new Route[max_routes]),
      index_(std::bit_ceil(2 * max_routes)),
      shift_(64u - static_cast<unsigned>(std::countr_zero(index_.size()))) {
    assert(max_routes != 0 && per_link != 0);
    resize(1);
}

void RouteTable::resize(std::size_t words) {
    assert(words != 0 && links_.size() <= words * 64);
    words_ = words;
    pair_links_ = ZeroedArray<std::uint64_t>(pairs * words);
    system_links_ = ZeroedArray<std::uint64_t>(systems * words);
    system_counts_ = ZeroedArray<std::uint16_t>(systems * words * 64);
    for (const Link& link : links_)
        for (std::uint32_t i = link.oldest; i != none; i = routes_[i].newer)
            if (routes_[i].is_known()) set_known(routes_[i]);
}

void RouteTable::add_link(Slot slot) {
    if (slot >= links_.size()) links_.resize(slot + 1);
    assert(slot < words_ * 64 && links_[slot].count == 0);
    links_[slot] = Link{};
}

void RouteTable::remove_link(Slot slot) noexcept {
    while (links_[slot].oldest != none) remove(links_[slot].oldest);
    assert(links_[slot].count == 0);
}

void RouteTable::set_timeout(Nanoseconds timeout) noexcept {
    timeout_ns_ = timeout.count();
    next_expiry_ns_ = 0;  // the next `expire` recomputes it
}

inline Route& RouteTable::renew(Slot slot, Pair pair, Change& change) noexcept {
    assert(slot < links_.size());
    Link& link = links_[slot];
    std::uint32_t index = link.newest;
    if (index == none || routes_[index].pair != pair) {
        const std::size_t place = place_of(slot, pair);
        index = index_[place] - 1;
        if (index == none) {
            index = static_cast<std::uint32_t>(&insert(slot, pair, place, change) - routes_.get());
        } else {
            unlink(index);
            append(index);
        }
    }
    return routes_[index];
}

Route& RouteTable::learn(Slot slot, Pair pair, MonoTime now, Change& change) noexcept {
    Route& route = renew(slot, pair, change);
    route.heard_ns = now.time_since_epoch().count();
    ++route.frames;
    if (!route.is_known()) [[unlikely]] {
        route.since_ns = route.heard_ns;
        set_known(route);
        ++change.learned;
        next_expiry_ns_ = std::min(next_expiry_ns_, route.heard_ns + timeout_ns_);
    }
    return route;
}

RouteTable::Claim RouteTable::claim(Slot slot, Pair pair, MonoTime now, Nanoseconds gap, Change& change) noexcept {
    Route& route = renew(slot, pair, change);
    const std::int64_t now_ns = now.time_since_epoch().count();
    const bool goes_on = route.known == Route::Known::claimed && now_ns - route.heard_ns < gap.count();
    if (!goes_on) route.since_ns = route.heard_ns = now_ns;
    const Claim claim{MonoTime{Nanoseconds{route.since_ns}}, MonoTime{Nanoseconds{route.heard_ns}}};
    route.heard_ns = now_ns;
    route.known = Route::Known::claimed;
    next_expiry_ns_ = std::min(next_expiry_ns_, now_ns + timeout_ns_);
    return claim;
}

void RouteTable::forget(Slot slot, Pair pair) noexcept {
    const std::uint32_t index = index_[place_of(slot, pair)] - 1;
    if (index != none && routes_[index].is_known()) set_unknown(routes_[index]);
}

// The place of the route in index_, or the empty place where it belongs.
std::size_t RouteTable::place_of(Slot slot, Pair pair) const noexcept {
    std::size_t at = home(slot, pair);
    while (index_[at] != 0 && (routes_[index_[at] - 1].slot != slot || routes_[index_[at] - 1].pair != pair))
        at = (at + 1) & (index_.size() - 1);
    return at;
}

Route& RouteTable::insert(Slot slot, Pair pair, std::size_t place, Change& change) noexcept {
    if (links_[slot].count >= per_link_ || count_ >= max_routes_) {
        make_room(slot, change);
        place = place_of(slot, pair);
    }
    assert(count_ < max_routes_ && links_[slot].count < per_link_ && index_[place] == 0);
    std::uint32_t index = free_;
    if (index != none) {
        free_ = routes_[index].newer;
    } else {
        index = static_cast<std::uint32_t>(used_++);
    }
    assert(index < used_ && used_ <= max_routes_);
    routes_[index] = Route{.heard_ns = 0,
                           .since_ns = 0,
                           .frames = 0,
                           .older = none,
                           .newer = none,
                           .slot = slot,
                           .pair = pair,
                           .known = Route::Known::no};
    index_[place] = index + 1;
    append(index);
    ++links_[slot].count;
    ++count_;
    return routes_[index];
}

void RouteTable::make_room(Slot slot, Change& change) noexcept {
    const auto fewer = [](const Link& a, const Link& b) { return a.count < b.count; };
    const bool own_limit = links_[slot].count >= per_link_;
    const Link& from = own_limit ? links_[slot] : *std::max_element(links_.begin(), links_.end(), fewer);
    assert(from.oldest != none);
    remove(from.oldest);
    ++change.evicted;
}

void RouteTable::set_known(Route& route) noexcept {
    assert(route.slot < links_.size());
    const std::size_t system = route.pair >> 8;
    route.known = Route::Known::yes;
    route::insert(&pair_links_[route.pair * words_], route.slot);
    if (system_counts_[system * words_ * 64 + route.slot]++ == 0)
        route::insert(&system_links_[system * words_], route.slot);
}

void RouteTable::set_unknown(Route& route) noexcept {
    const std::size_t system = route.pair >> 8;
    assert(route.is_known() && system_counts_[system * words_ * 64 + route.slot] != 0);
    assert(has(&pair_links_[route.pair * words_], route.slot));
    route.known = Route::Known::no;
    erase(&pair_links_[route.pair * words_], route.slot);
    if (--system_counts_[system * words_ * 64 + route.slot] == 0) erase(&system_links_[system * words_], route.slot);
}

void RouteTable::append(std::uint32_t index) noexcept {
    Link& link = links_[routes_[index].slot];
    routes_[index].older = link.newest;
    routes_[index].newer = none;
    (link.newest != none ? routes_[link.newest].newer : link.oldest) = index;
    link.newest = index;
}

void RouteTable::unlink(std::uint32_t index) noexcept {
    const Route& route = routes_[index];
    Link& link = links_[route.slot];
    assert((route.older != none ? routes_[route.older].newer : link.oldest) == index);
    assert((route.newer != none ? routes_[route.newer].older : link.newest) == index);
    (route.older != none ? routes_[route.older].newer : link.oldest) = route.newer;
    (route.newer != none ? routes_[route.newer].older : link.newest) = route.older;
}

void RouteTable::remove(std::uint32_t index) noexcept {
    Route& route = routes_[index];
    assert(index < used_ && count_ != 0 && links_[route.slot].count != 0);
    if (route.is_known()) set_unknown(route);
    assert(index_[place_of(route.slot, route.pair)] == index + 1);
    erase_place(place_of(route.slot, route.pair));
    unlink(index);
    --links_[route.slot].count;
    --count_;
    route.newer = free_;
    free_ = index;
}

// Moves later entries into the hole, so that a search from an entry's home still reaches it before an empty place.
void RouteTable::erase_place(std::size_t place) noexcept {
    const std::size_t mask = index_.size() - 1;
    std::size_t hole = place;
    for (std::size_t at = (hole + 1) & mask; index_[at] != 0; at = (at + 1) & mask) {
        const Route& route = routes_[index_[at] - 1];
        if (((at - home(route.slot, route.pair)) & mask) < ((at - hole) & mask)) continue;
        index_[hole] = index_[at];
        hole = at;
    }
    index_[hole] = 0;
}

void RouteTable::forget_system(Slot slot, SystemId system) noexcept {
    for (std::uint32_t i = links_[slot].oldest; i != none; i = routes_[i].newer)
        if (routes_[i].is_known() && routes_[i].pair >> 8 == system.value) set_unknown(routes_[i]);
}

void RouteTable::expire_now(std::int64_t now_ns, Change& change) noexcept {
    next_expiry_ns_ = never;
    for (Link& link : links_) {
        while (link.oldest != none && now_ns - routes_[link.oldest].heard_ns >= timeout_ns_) {
            change.expired += routes_[link.oldest].is_known() ? 1 : 0;
            remove(link.oldest);
        }
        if (link.oldest != none)
            next_expiry_ns_ = std::min(next_expiry_ns_, routes_[link.oldest].heard_ns + timeout_ns_);
    }
}

}  // namespace mavloom::route
