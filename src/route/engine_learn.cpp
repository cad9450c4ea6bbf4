// SPDX-License-Identifier: MIT
// Engine: which routes are learned, and which are forgotten. Trust decides who is believed.
#include <algorithm>
#include <cassert>
#include <utility>

#include "route/engine_impl.hpp"

namespace mavloom::route {

// A signed frame that another endpoint heard earlier teaches no new route.
void Engine::Impl::learn(Passage& p) noexcept {
    if (p.is_repeated && routes_.find(p.slot, p.source) == nullptr) [[unlikely]]
        return;
    if (p.link.group != no_group && groups_[p.link.group].mode == GroupMode::best) count_beats(p);
    p.link.heard = true;
    p.link.last_heard = p.now;
    if (p.info == nullptr || p.frame.system().value == 0 || !is_believed(p)) return;
    RouteTable::Change change;
    routes_.learn(p.slot, p.source, p.now, change);
    count_routes(change);
    assert(has(routes_.links_of(p.source), p.slot));
    const bool takes = !is_second_hand(p);
    if (takes) [[likely]]
        trust_.note(p.source, p.link.claimant, p.now);
    if (!has_other(routes_.links_of(p.source), p.slot, words_)) [[likely]]
        return;
    if (takes) [[likely]]
        end_lower_routes(p);
    watch_for_duplicate_ids(p);
}

// Whether this is a copy of an autopilot's frame while no own link has the autopilot: strangers brought the frame
// first. Such a copy takes the autopilot from nobody: the vehicle's own frames may have come back through another
// router.
bool Engine::Impl::is_second_hand(const Passage& p) noexcept {
    return p.is_copy && p.link.policy.rank == Rank::own && Trust::is_autopilot(p.source) &&
           !trust_.own_has(p.source, p.now);
}

bool Engine::Impl::is_believed(const Passage& p) noexcept {
    const Claimant* holder = nullptr;
    const auto answer = trust_.judge(p.source, p.link.claimant, p.now, holder);
    if (answer == Trust::Answer::believed) [[likely]]
        return true;
    const bool is_known = routes_.find(p.slot, p.source) != nullptr;
    if (is_known || !Trust::is_autopilot(p.source)) return is_known && answer == Trust::Answer::contested;
    RouteTable::Change change;
    const auto claim = routes_.claim(p.slot, p.source, p.now, alive_for, change);
    count_routes(change);
    if (p.now - claim.since < consistent_for) return false;
    const bool has_earned = answer == Trust::Answer::contested && !p.link.policy.learns_first;
    const bool is_new = claim.last_heard - claim.since < consistent_for;
    if ((has_earned || is_new) && holder->rank != Rank::verified)
        report_conflict({p.frame.system(), holder->link, p.link.id, has_earned});
    return has_earned;
}

void Engine::Impl::report_conflict(const RouteConflict& conflict) noexcept {
    counters.route_conflicts.add();
    const bool is_listed = std::ranges::find(conflicts, conflict) != conflicts.end();
    if (!is_listed && conflicts.size() < max_route_conflicts) conflicts.push_back(conflict);
}

// The first frame of a vehicle on an own or verified link ends its routes on lower ranks, and so does that of any
// source on a verified link.
void Engine::Impl::end_lower_routes(const Passage& p) noexcept {
    const Rank rank = p.link.policy.rank;
    if (rank == Rank::stranger || (rank == Rank::own && !Trust::is_autopilot(p.source))) return;
    const ConstWords kept = at_least(rank), where = routes_.links_of(p.source);
    each_word(words_, [&](std::size_t w) { scratch_[w] = where[w] & ~kept[w] & ~same_place(p.link, w); });
    each(scratch_.data(), words_, [&](Slot slot) { routes_.forget(slot, p.source); });
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
    const bool was_learned = routes_.find(slot, pair_of(source)) != nullptr;
    routes_.forget_system(slot, source.system);
    if (!was_learned) return;
    RouteTable::Change change;
    Route& route = routes_.learn(slot, pair_of(source), now, change);
    assert(route.frames > 1);
    --route.frames;  // `route` already counted this frame
    count_routes(change);
}

void Engine::Impl::watch_for_duplicate_ids(const Passage& p) noexcept {
    const ConstWords where = routes_.links_of(p.source);
    if (!has_other(where, p.slot, words_)) return;
    Alternation& alternation = alternations_[p.source];
    if (alternation.last == p.link.id) return;
    const Slot last = slot_of(alternation.last);
    const bool last_knows = last != no_slot && has(where, last);
    const bool one_group = last_knows && p.link.group != no_group && links[last]->group == p.link.group;
    if (one_group) return;
    alternation.count = last_knows ? static_cast<std::uint8_t>(alternation.count + 1) : std::uint8_t{1};
    if (alternation.count >= duplicate_alternations && !alternation.is_reported) {
        alternation.is_reported = true;
        counters.duplicate_ids.add();
        if (duplicates.size() < max_duplicate_ids)
            duplicates.push_back({source_of(p.source), alternation.last, p.link.id});
    }
    alternation.count = std::min(alternation.count, duplicate_alternations);
    alternation.last = p.link.id;
}

}  // namespace mavloom::route
