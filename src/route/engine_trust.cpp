// SPDX-License-Identifier: MIT
// Engine: which routes are believed. Without a key, nobody can prove an identity. So the rules favour the link that
// heard a vehicle first, and links whose frames are verified. docs/design/security.md, "Who is believed".
#include <algorithm>
#include <utility>

#include "route/engine_impl.hpp"

namespace mavloom::route {

static constexpr SystemId station{255};  // by convention

// An echo does not make its sender present here, so frames of the sender still go to this link.
void Engine::Impl::learn_from_echo(const wire::FrameView& frame, const wire::MessageInfo* info, Slot slot) noexcept {
    Passage p{frame, 0, info, frame.id(), pair_of(frame.source()), slot, *links[slot], now_};
    note_return(p);
    const Returns& returns = p.link.returns;
    const bool keeps_others = returns.kept >= kept_frames && p.now - returns.kept_since >= echo_window;
    if (p.info == nullptr || p.frame.system().value == 0) return;
    if (!keeps_others && routes_.find(p.slot, p.source) == nullptr) {
        note_claim(p);
        return;
    }
    if (!may_learn(p) || !may_return(p)) return;
    RouteTable::Change change;
    routes_.learn_from_echo(p.slot, p.source, p.now, change);
    count_routes(change);
}

void Engine::Impl::note_return(Passage& p) noexcept {
    Returns& returns = p.link.returns;
    if (!has(watched_.data(), p.slot) || p.now - returns.last >= returns_forgotten_after) returns = {};
    returns.last = p.now;
    insert(watched_.data(), p.slot);
    has_watched_ = true;
    const Slot system = p.frame.system().value;
    if (has(returns.systems.data(), system)) return;
    insert(returns.systems.data(), system);
    returns.kept = 0;
}

void Engine::Impl::watch_for_returns(SystemId system, ConstWords set) noexcept {
    for (std::size_t w = 0; w < words_; ++w)
        each_in_word(set[w] & watched_[w], static_cast<Slot>(64 * w), [&](Slot slot) {
            Returns& returns = links[slot]->returns;
            if (now_ - returns.last >= returns_forgotten_after) erase(watched_.data(), slot);
            if (has(returns.systems.data(), system.value)) return;
            if (returns.kept++ == 0) returns.kept_since = now_;
        });
    has_watched_ = any(watched_.data(), words_);
}

bool Engine::Impl::may_learn(const Passage& p) noexcept {
    const SystemId system = p.frame.system();
    const ConstWords where = routes_.links_of(system);
    std::uint64_t others = 0;
    each_word(words_, [&](std::size_t w) {
        const std::uint64_t own = w == p.slot / 64 ? std::uint64_t{1} << (p.slot % 64) : 0;
        scratch_[w] = where[w] & ~own & ~same_place(p.link, w);
        others |= scratch_[w];
    });
    if (others == 0) return true;
    if (p.link.policy.is_verified) {
        each(scratch_.data(), words_, [&](Slot slot) {
            if (!has(verified_.data(), slot)) routes_.forget_system(slot, system);
        });
        return true;
    }
    if (intersect(scratch_.data(), verified_.data(), words_)) return false;
    if (system == station || is_alive_on(p.slot, system, p.now)) return true;
    const Slot first = where_alive(p, scratch_.data());
    if (first == no_slot) return true;
    return is_consistent(p, first) || routes_.find(p.slot, p.source) != nullptr;
}

// Returns the link of `links` on which the system's autopilot is alive; no_slot if there is none.
Slot Engine::Impl::where_alive(const Passage& p, ConstWords links_of_system) const noexcept {
    Slot alive = no_slot;
    each(links_of_system, words_, [&](Slot slot) {
        if (is_alive_on(slot, p.frame.system(), p.now)) alive = slot;
    });
    return alive;
}

// An echo counts too if the link also brought frames that were none, and sends back no other system: then somebody may
// have predicted the heartbeats.
bool Engine::Impl::is_alive_on(Slot slot, SystemId system, MonoTime now) const noexcept {
    const Route* const route = routes_.find(slot, autopilot_of(system));
    if (route == nullptr || route->known != Route::Known::yes) return false;
    const auto& returned = links[slot]->returns.systems;
    const bool echoes_count = !has_other(returned.data(), system.value, returned.size());
    const std::int64_t last = echoes_count ? route->last_ns() : route->heard_ns;
    return now.time_since_epoch().count() - last < alive_for.count();
}

Place Engine::Impl::place_of(const Link& link) noexcept {
    return {link.policy.group, link.policy.endpoint, link.address, link.policy.is_verified};
}

bool Engine::Impl::may_return(const Passage& p) noexcept {
    const SystemId system = p.frame.system();
    const Place* const before = departed_.find(system, p.now);
    if (before == nullptr) return true;
    const Place here = place_of(p.link);
    if (here.is_verified || here.is_same(*before)) {
        departed_.forget(system);
        return true;
    }
    if (system == station) return true;
    const Claim* const claim = note_claim(p);
    if (before->is_verified) return false;
    return is_old(claim, p) || routes_.find(p.slot, p.source) != nullptr;
}

Engine::Impl::Claim* Engine::Impl::note_claim(const Passage& p) noexcept {
    const SystemId system = p.frame.system();
    auto claim = std::ranges::find(p.link.claims, system, &Claim::system);
    if (claim == p.link.claims.end()) claim = std::ranges::min_element(p.link.claims, {}, &Claim::last);
    const bool is_recent = claim->system != SystemId{} && p.now - claim->last < alive_for;
    if (is_recent && claim->system != system) return nullptr;
    if (!is_recent) *claim = {.system = system, .since = p.now};
    claim->last = p.now;
    return claim;
}

bool Engine::Impl::is_old(const Claim* claim, const Passage& p) noexcept {
    return claim != nullptr && !p.link.policy.learns_first && p.now - claim->since >= consistent_for;
}

bool Engine::Impl::is_consistent(const Passage& p, Slot first) noexcept {
    Claim* const claim = note_claim(p);
    if (!is_old(claim, p)) return false;
    if (!std::exchange(claim->is_reported, true)) note_conflict(p, first);
    return true;
}

void Engine::Impl::note_conflict(const Passage& p, Slot first) noexcept {
    counters.route_conflicts.add();
    if (conflicts.size() < max_route_conflicts) conflicts.push_back({p.frame.system(), ids_[first], p.link.id});
}

// `route` has already learned from the frame that showed the reboot, so that route is learned again.
void Engine::Impl::note_reboot(LinkId link, Source source, MonoTime now) noexcept {
    const Slot slot = slot_of(link);
    if (slot == no_slot || source.system.value == 0) return;
    Reboot& last = last_reboots_[source.system.value];
    const bool is_known = last.link != link && last.when != MonoTime{} && now - last.when < one_reboot;
    if (!is_known) {
        last = {link, now};
        counters.reboots.add();
    }
    const Route* const known = routes_.find(slot, pair_of(source));
    const bool was_learned = known != nullptr && known->known == Route::Known::yes;
    routes_.forget_system(slot, source.system);
    if (!was_learned) return;
    RouteTable::Change change;
    Route& route = routes_.learn(slot, pair_of(source), now, change);
    --route.frames;  // `route` already counted this frame
    count_routes(change);
}

void Engine::Impl::watch_for_duplicate_ids(const Passage& p) noexcept {
    const ConstWords where = routes_.links_of(p.source);
    if (!has_other(where, p.slot, words_)) return;
    Turns& turns = turns_[p.source];
    if (turns.last == p.link.id) return;
    const Slot last = slot_of(turns.last);
    const bool last_knows = last != no_slot && has(where, last);
    const bool one_group = last_knows && p.link.group != no_group && links[last]->group == p.link.group;
    if (one_group) return;
    turns.count = last_knows ? static_cast<std::uint8_t>(turns.count + 1) : std::uint8_t{1};
    if (turns.count >= turns_of_duplicates && !turns.is_reported) {
        turns.is_reported = true;
        counters.duplicate_ids.add();
        if (duplicates.size() < max_duplicate_ids) duplicates.push_back({source_of(p.source), turns.last, p.link.id});
    }
    turns.count = std::min(turns.count, turns_of_duplicates);
    turns.last = p.link.id;
}

}  // namespace mavloom::route
