// SPDX-License-Identifier: MIT
// Engine: adding and removing links, changing options, and the lists for reports.
#include <algorithm>
#include <bit>
#include <cassert>
#include <chrono>
#include <functional>
#include <utility>

#include "route/engine_impl.hpp"

namespace mavloom::route {

// Longer times are cut to this, which is practically forever. Sums with the clock then cannot overflow.
static constexpr Nanoseconds longest = std::chrono::hours{24 * 365 * 50};

static Options bounded(Options options) {
    options.dedup = std::clamp(options.dedup, Nanoseconds{}, longest);
    options.route_timeout = std::clamp(options.route_timeout, Nanoseconds{}, longest);
    return options;
}

Engine::Impl::Impl(const wire::MessageTable& message_table, const Options& given)
    : table(message_table),
      options(bounded(given)),
      window_(std::max(echo_window, options.dedup)),
      index_(128, no_slot),
      routes_(max_routes, max_routes_per_link),
      alternations_(RouteTable::pairs),
      unknown_(RouteTable::pairs) {
    conflicts.reserve(max_route_conflicts);
    duplicates.reserve(max_duplicate_ids);
    routes_.set_timeout(options.route_timeout);
    trust_.set_route_timeout(options.route_timeout);
    grow(64);
    rebuild();
}

Slot Engine::Impl::slot_of(LinkId id) const noexcept {
    const std::size_t mask = index_.size() - 1;
    for (std::size_t at = id.value & mask; index_[at] != no_slot; at = (at + 1) & mask)
        if (ids_[index_[at]] == id) return index_[at];
    return no_slot;
}

void Engine::Impl::grow(std::size_t slots) {
    assert(slots % 64 == 0 && slots > out_.size());
    words_ = slots / 64;
    routes_.resize(words_);
    for (auto* set : {&ordinary_, &taps_, &private_, &limited_, &verified_, &trusted_, &candidates_, &scratch_})
        set->resize(words_);
    out_.resize(slots);
    ids_.resize(slots);
}

bool Engine::Impl::add_link(LinkId id, const LinkPolicy& policy, const LinkCounters& counts) {
    if (id.value == 0 || link_count >= max_links || slot_of(id) != no_slot) return false;
    const std::size_t words = words_;
    const Slot slot = free_slot();
    assert(links[slot] == nullptr && slot < words_ * 64);
    links[slot].reset(new Link{.id = id,
                               .policy = policy,
                               .claimant = {id, policy.group, policy.endpoint, policy.rank},
                               .limiter = EgressLimiter(policy.max_rate, policy.max_bytes_per_s),
                               .filters_in = !policy.in.admits_all(),
                               .counters = counts});
    ids_[slot] = id;
    ++link_count;
    routes_.add_link(slot);
    add_to_index(slot);
    assert(slot_of(id) == slot);
    if (words != words_) {
        rebuild();
        return true;
    }
    enlist(slot);
    note_links_changed();
    return true;
}

void Engine::Impl::close_link(LinkId id) {
    trust_.release([&](const Claimant& by) { return by.link == id; });
    remove_link(id);
}

void Engine::Impl::close_endpoint(std::uint32_t endpoint) {
    trust_.release([&](const Claimant& by) { return by.endpoint == endpoint; });
}

void Engine::Impl::remove_link(LinkId id) {
    const Slot slot = slot_of(id);
    if (slot == no_slot) return;
    routes_.remove_link(slot);
    delist(slot);
    remove_from_index(slot);
    links[slot].reset();
    left_at_[slot] = now_;
    ids_[slot] = LinkId{};
    resting_.push_back(slot);
    --link_count;
    assert(slot_of(id) == no_slot);
    if (has_empty_group()) rebuild();
    else note_links_changed();
}

// Prefers a slot that has rested, then a new one. If many rest, takes the one that has rested longest.
Slot Engine::Impl::free_slot() {
    if (!resting_.empty()) {
        const Slot slot = resting_.front();
        const bool has_rested = now_ - left_at_[slot] >= window_;
        if (has_rested || resting_.size() >= max_resting || links.size() >= max_links) {
            if (!has_rested) recent_.retake(slot, now_, window_);
            resting_.pop_front();
            return slot;
        }
    }
    if (links.size() == words_ * 64) grow(2 * words_ * 64);
    links.emplace_back();
    left_at_.emplace_back();
    return static_cast<Slot>(links.size() - 1);
}

void Engine::Impl::set_options(const Options& given) {
    const auto [seed, recent_frames] = std::pair{options.seed, options.recent_frames};
    options = bounded(given);
    options.seed = seed;
    options.recent_frames = recent_frames;
    window_ = std::max(echo_window, options.dedup);
    std::ranges::fill(left_at_, now_);  // the window may have grown, so slots rest again
    routes_.set_timeout(options.route_timeout);
    trust_.set_route_timeout(options.route_timeout);
    rebuild();
}

void Engine::Impl::set_group_orders(std::span<const GroupOrder> orders) {
    bool changes = false;
    for (const auto& [id, order] : orders) {
        const Slot slot = slot_of(id);
        if (slot == no_slot || std::exchange(links[slot]->policy.group_order, order) == order) continue;
        changes = changes || links[slot]->policy.group.value != 0;
    }
    if (changes) rebuild();
}

void Engine::Impl::index_links() {
    index_.assign(std::bit_ceil(std::max<std::size_t>(128, 2 * links.size())), no_slot);
    const std::size_t mask = index_.size() - 1;
    for (Slot slot = 0; slot < links.size(); ++slot) {
        if (links[slot] == nullptr) continue;
        std::size_t at = links[slot]->id.value & mask;
        while (index_[at] != no_slot) at = (at + 1) & mask;
        index_[at] = slot;
    }
}

void Engine::Impl::add_to_index(Slot slot) {
    if (index_.size() < 2 * links.size()) return index_links();
    assert(std::has_single_bit(index_.size()));
    std::size_t at = home(slot);
    while (index_[at] != no_slot) at = (at + 1) & (index_.size() - 1);
    index_[at] = slot;
}

// Moves later entries into the hole, so that a search from an entry's home still reaches it before an empty place.
void Engine::Impl::remove_from_index(Slot slot) noexcept {
    const std::size_t mask = index_.size() - 1;
    std::size_t hole = home(slot);
    while (index_[hole] != slot) hole = (hole + 1) & mask;
    for (std::size_t at = (hole + 1) & mask; index_[at] != no_slot; at = (at + 1) & mask) {
        if (((at - home(index_[at])) & mask) < ((at - hole) & mask)) continue;
        index_[hole] = index_[at];
        hole = at;
    }
    index_[hole] = no_slot;
}

std::uint32_t Engine::Impl::group_index(const Link& link) {
    const auto same = [&](const Group& group) { return group.id == link.policy.group; };
    const auto index = std::find_if(groups_.begin(), groups_.end(), same) - groups_.begin();
    if (index == std::ssize(groups_))
        groups_.push_back({.id = link.policy.group, .mode = link.policy.group_mode, .members{}, .order{}});
    return static_cast<std::uint32_t>(index);
}

std::uint32_t Engine::Impl::peers_index(const Link& link) {
    const LinkPolicy& policy = link.policy;
    if (policy.endpoint == 0) return no_peers;
    const auto same = [&](const Peers& p) { return p.group == policy.group && p.endpoint == policy.endpoint; };
    const auto is_empty = [&](const Peers& p) { return !any(p.links.data(), words_); };
    auto at = std::ranges::find_if(peers_, same);
    if (at == peers_.end()) at = std::ranges::find_if(peers_, is_empty);
    if (at == peers_.end()) at = peers_.insert(at, {{}, 0, std::vector<std::uint64_t>(words_)});
    at->group = policy.group;
    at->endpoint = policy.endpoint;
    return static_cast<std::uint32_t>(at - peers_.begin());
}

// Recomputes all sets that depend on the links and their policies.
void Engine::Impl::rebuild() {
    for (auto* set : {&ordinary_, &taps_, &private_, &limited_, &verified_, &trusted_})
        std::fill(set->begin(), set->end(), 0);
    empty_groups();
    filters_.clear();
    for (Slot slot = 0; slot < links.size(); ++slot)
        if (links[slot] != nullptr) enlist(slot);
    note_links_changed();
}

// Computes what depends on the sets of links as a whole.
void Engine::Impl::note_links_changed() {
    ++links_version_;
    has_taps_ = any(taps_.data(), words_);
    has_private_ = any(private_.data(), words_);
    has_limits_ = any(limited_.data(), words_);
    chooses_members_ = std::ranges::any_of(
        groups_, [](const Group& group) { return group.mode != GroupMode::all && group.order.size() > 1; });
    // Remembers frames from the first link on: what the router itself sends there may come back on a second link.
    const bool remembers = link_count > 0 || options.dedup > Nanoseconds{} || recent_.active();
    recent_.resize(remembers ? options.recent_frames : 0, words_);
}

// Keeps the groups that have a link, without their members.
void Engine::Impl::empty_groups() {
    const auto has_link = [&](const Group& group) {
        return std::ranges::any_of(
            links, [&](const auto& l) { return l != nullptr && !l->policy.tap && l->policy.group == group.id; });
    };
    std::erase_if(groups_, std::not_fn(has_link));
    peers_.clear();
    for (Group& group : groups_) {
        group.members.assign(words_, 0);
        group.order.clear();
    }
}

// Adds the link to the sets that it belongs to.
void Engine::Impl::enlist(Slot slot) {
    assert(links[slot] != nullptr);
    Link& link = *links[slot];
    link.listed_set.resize(words_);
    link.list.resize(words_ * 64 <= max_listed ? words_ * 64 : 0);
    auto& kind = link.policy.tap ? taps_ : link.policy.is_private ? private_ : ordinary_;
    route::insert(kind.data(), slot);
    if (link.limiter.limits()) route::insert(limited_.data(), slot);
    if (link.policy.rank == Rank::verified) route::insert(verified_.data(), slot);
    if (link.policy.rank > Rank::stranger) route::insert(trusted_.data(), slot);
    if (link.policy.tap) return;
    if (!link.policy.out.admits_all()) {
        auto at = std::ranges::find(filters_, link.policy.out, &OutFilter::filter);
        if (at == filters_.end()) at = filters_.insert(at, {link.policy.out, std::vector<std::uint64_t>(words_)});
        route::insert(at->links.data(), slot);
    }
    if (link.policy.group.value == 0) return;
    link.group = group_index(link);
    link.peers = peers_index(link);
    if (link.peers != no_peers) route::insert(peers_[link.peers].links.data(), slot);
    Group& group = groups_[link.group];
    group.members.resize(words_);
    route::insert(group.members.data(), slot);
    const auto rank = [&](Slot s) { return std::pair{links[s]->policy.group_order, links[s]->id}; };
    group.order.insert(std::ranges::upper_bound(group.order, rank(slot), {}, rank), slot);
}

// Removes the link from the sets that it belongs to.
void Engine::Impl::delist(Slot slot) {
    for (auto* set : {&ordinary_, &taps_, &private_, &limited_, &verified_, &trusted_}) erase(set->data(), slot);
    for (OutFilter& filter : filters_) erase(filter.links.data(), slot);
    std::erase_if(filters_, [&](const OutFilter& filter) { return !any(filter.links.data(), words_); });
    if (links[slot]->group == no_group) return;
    assert(links[slot]->group < groups_.size() && has(groups_[links[slot]->group].members.data(), slot));
    Group& group = groups_[links[slot]->group];
    erase(group.members.data(), slot);
    if (const auto peers = links[slot]->peers; peers != no_peers) erase(peers_[peers].links.data(), slot);
    std::erase(group.order, slot);
    if (group.current == slot) group.current = no_slot;
}

bool Engine::Impl::has_empty_group() const noexcept {
    return std::ranges::any_of(groups_, [](const Group& group) { return group.order.empty(); });
}

static void add_route(std::vector<RouteInfo>& list, LinkId link, const Route& route, MonoTime now, Nanoseconds timeout) {
    const Nanoseconds age{now.time_since_epoch().count() - route.heard_ns};
    if (age < timeout) list.push_back({link, source_of(route.pair), std::max(age, Nanoseconds{}), route.frames});
}

std::vector<RouteInfo> Engine::Impl::routes(MonoTime now) const {
    std::vector<RouteInfo> list;
    routes_.each_known([&](const Route& route) { add_route(list, ids_[route.slot], route, now, options.route_timeout); });
    std::sort(list.begin(), list.end(), [](const RouteInfo& a, const RouteInfo& b) {
        return std::pair{a.source, a.link} < std::pair{b.source, b.link};
    });
    return list;
}

std::vector<RouteInfo> Engine::Impl::routes(LinkId link, MonoTime now) const {
    std::vector<RouteInfo> list;
    const Slot slot = slot_of(link);
    if (slot == no_slot) return list;
    routes_.each_known(slot, [&](const Route& route) { add_route(list, link, route, now, options.route_timeout); });
    return list;
}

std::vector<UnknownTargetInfo> Engine::Impl::unknown_targets(std::size_t first, std::size_t last) const {
    std::vector<UnknownTargetInfo> list;
    for (std::size_t pair = first; pair < std::min(last, unknown_.size()); ++pair)
        if (unknown_[pair] != 0) list.push_back({source_of(static_cast<Pair>(pair)), unknown_[pair]});
    return list;
}

}  // namespace mavloom::route
