// SPDX-License-Identifier: MIT
#include "mavloom/route/engine.hpp"

#include <algorithm>
#include <cassert>

#include "mavloom/dialect/message_class.hpp"
#include "route/engine_impl.hpp"

namespace mavloom::route {

static constexpr MessageId heartbeat_id{0};

Engine::Engine(const wire::MessageTable& table, const Options& options)
    : impl_(std::make_unique<Impl>(table, options)) {}
Engine::Engine(Engine&&) noexcept = default;
Engine& Engine::operator=(Engine&&) noexcept = default;
Engine::~Engine() = default;

bool Engine::add_link(LinkId link, const LinkPolicy& policy, const LinkCounters& counts) {
    return impl_->add_link(link, policy, counts);
}
void Engine::remove_link(LinkId link) { impl_->remove_link(link); }
void Engine::close_link(LinkId link) { impl_->close_link(link); }
void Engine::close_endpoint(std::uint32_t endpoint) { impl_->close_endpoint(endpoint); }
void Engine::set_options(const Options& options) { impl_->set_options(options); }
void Engine::set_group_orders(std::span<const GroupOrder> orders) { impl_->set_group_orders(orders); }
std::size_t Engine::links() const noexcept { return impl_->link_count; }
std::uint64_t Engine::mark_of(const wire::FrameView& frame) const noexcept { return impl_->mark_of(frame); }
// Inlining all steps with `flatten` saves a quarter of the instructions.
[[gnu::flatten]] Decision Engine::route(const wire::FrameView& frame, std::uint64_t mark, const wire::MessageInfo* info,
                                        LinkId ingress, MonoTime now, bool is_repeated) noexcept {
    return impl_->route(frame, mark, info, ingress, now, is_repeated);
}
Decision Engine::route(const wire::FrameView& frame, LinkId ingress, MonoTime now) noexcept {
    return route(frame, impl_->table.find(frame.id()), ingress, now);
}
Decision Engine::explain(const wire::FrameView& frame, const wire::MessageInfo* info, LinkId ingress, MonoTime now,
                         std::vector<Explanation>& why, bool is_repeated) {
    return impl_->explain(frame, info, ingress, now, why, is_repeated);
}
void Engine::note_sent(const wire::FrameView& frame, LinkId link, MonoTime now) noexcept {
    impl_->note_sent(frame, link, now);
}
void Engine::note_reboot(LinkId link, Source source, MonoTime now) noexcept { impl_->note_reboot(link, source, now); }
std::vector<RouteInfo> Engine::routes(MonoTime now) const { return impl_->routes(now); }
std::vector<RouteInfo> Engine::routes(LinkId link, MonoTime now) const { return impl_->routes(link, now); }
std::span<const DuplicateId> Engine::duplicate_ids() const noexcept { return impl_->duplicates; }
std::span<const RouteConflict> Engine::route_conflicts() const noexcept { return impl_->conflicts; }
std::vector<UnknownTargetInfo> Engine::unknown_targets() const { return impl_->unknown_targets(0, RouteTable::pairs); }
std::vector<UnknownTargetInfo> Engine::unknown_targets(SystemId system) const {
    return impl_->unknown_targets(std::size_t{system.value} << 8, (std::size_t{system.value} + 1) << 8);
}
const EngineCounters& Engine::counters() const noexcept { return impl_->counters; }
const LinkCounters* Engine::counters(LinkId link) const noexcept {
    const Slot slot = impl_->slot_of(link);
    return slot == no_slot ? nullptr : &impl_->links[slot]->counters;
}

std::uint64_t Engine::Impl::mark_of(const wire::FrameView& frame) const noexcept {
    if (!recent_.active()) return 0;
    const std::uint64_t hash = hash_of(frame.bytes(), options.seed);
    recent_.prefetch(hash);
    return hash;
}

Decision Engine::Impl::route(const wire::FrameView& frame, std::uint64_t hash, const wire::MessageInfo* info,
                             LinkId ingress, MonoTime now, bool is_repeated) noexcept {
    const Slot slot = slot_of(ingress);
    if (slot == no_slot) [[unlikely]] {
        counters.unknown_link.add();
        return {Verdict::unknown_link, {}};
    }
    now_ = std::max(now, now_);
    assert(links[slot] != nullptr && links[slot]->id == ingress);
    Link& link = *links[slot];
    Passage p{frame, hash, info, frame.id(), pair_of(frame.source()), slot, link, now_, is_repeated};
    RouteTable::Change change;
    routes_.expire(now_, change);
    count_routes(change);

    const Verdict verdict = judge(p);
    assert(verdict != Verdict::forwarded || any(candidates_.data(), words_));
    assert(verdict != Verdict::forwarded || !has(candidates_.data(), slot));
    assert(verdict != Verdict::forwarded || !intersect(candidates_.data(), taps_.data(), words_));
    link.counters.frames.add();
    count(link.counters, verdict);
    if (verdict != Verdict::forwarded) each_word(words_, [&](std::size_t w) { candidates_[w] = 0; });
    if (has_taps_ && verdict != Verdict::tap) [[unlikely]]
        add_taps(p);
    if (p.is_copy) [[unlikely]]
        unite(recent_.sent(p.recent), candidates_.data(), words_);
    else if (p.is_remembered) assign(recent_.sent(p.recent), candidates_.data(), words_);
    return {verdict, list_candidates(link)};
}

// Frames of one link mostly go to the same links, so the link keeps its last long list.
std::span<const LinkId> Engine::Impl::list_candidates(Link& from) noexcept {
    if (from.listed_at == links_version_ && equal(candidates_.data(), from.listed_set.data(), words_))
        return {from.list.data(), from.listed};
    std::size_t n = 0;
    each(candidates_.data(), words_, [&](Slot to) {
        assert(links[to] != nullptr && n < out_.size());
        out_[n++] = ids_[to];
    });
    if (n >= worth_a_list && n <= from.list.size()) {
        std::copy_n(out_.begin(), n, from.list.begin());
        assign(from.listed_set.data(), candidates_.data(), words_);
        from.listed = n;
        from.listed_at = links_version_;
    }
    return {out_.data(), n};
}

// Leaves in candidates_ the links that the frame goes to, without taps.
Verdict Engine::Impl::judge(Passage& p) noexcept {
    if (p.link.policy.tap) [[unlikely]]
        return Verdict::tap;
    if (p.link.filters_in && !p.link.policy.in.admits(p.id, p.frame.source())) return Verdict::filtered;
    Verdict verdict = Verdict::forwarded;
    if (is_heard_before(p, verdict)) return verdict;
    learn(p);
    if (p.link.policy.is_private) return Verdict::private_link;

    verdict = choose_by_target(p);
    if (verdict != Verdict::forwarded) return verdict;
    leave_out_origin(p);
    if (!any(candidates_.data(), words_)) return Verdict::nowhere;
    apply_filters(p);
    if (!any(candidates_.data(), words_)) return Verdict::filtered;
    if (chooses_members_) apply_groups(p);
    if (p.is_copy) [[unlikely]] {
        leave_out(recent_.sent(p.recent), Reason::already_sent);
        leave_out(recent_.heard(p.recent), Reason::source_here);
        if (!any(candidates_.data(), words_)) return Verdict::duplicate;
    }
    if (!has_limits_) [[likely]]
        return Verdict::forwarded;
    apply_limits(p);
    return any(candidates_.data(), words_) ? Verdict::forwarded : Verdict::rate_limited;
}

// Decides what to do with bytes that were received before:
// - On a link that the frame was sent to, it is an echo.
// - On another link of the same group, or on any link within `dedup`, it is a duplicate.
// - On a link that delivered it before, it is a repetition by its sender and counts as a new frame.
// - On any other link it is a copy. It goes only to links that the frame has not reached yet. Otherwise two routers
//   connected by two paths would pass it round forever.
bool Engine::Impl::is_heard_before(Passage& p, Verdict& verdict) noexcept {
    if (!recent_.active()) return false;
    const bool found = recent_.find(p.hash, p.recent);
    if (found && counts_as_heard(p)) {
        const Nanoseconds age = p.now - recent_.time(p.recent);
        if (age < echo_window && has(recent_.sent(p.recent), p.slot)) {
            verdict = Verdict::echo;
            return true;
        }
        const Words heard = recent_.heard(p.recent);
        const bool again_here = has(heard, p.slot);
        const bool copy_in_group = age < echo_window && p.link.group != no_group && !again_here && came_by_group(p);
        p.is_copy = age < echo_window && !again_here && !copy_in_group;
        if (copy_in_group || (age < options.dedup && any(heard, words_))) {
            if (!again_here) learn(p);
            insert(heard, p.slot);
            verdict = Verdict::duplicate;
            return true;
        }
        // Does not add the link to `heard`: a second copy on this link must not look like a repetition.
        if (p.is_copy) return false;
    }
    remember(p, found);
    return false;
}

bool Engine::Impl::came_by_group(const Passage& p) noexcept {
    assert(p.link.group < groups_.size());
    const Words heard = recent_.heard(p.recent);
    std::uint64_t links_of_group = 0;
    each_word(words_, [&](std::size_t w) { links_of_group |= heard[w] & same_place(p.link, w); });
    return links_of_group != 0;
}

// On a verified link, what unverified links brought does not count: somebody without a key may have repeated the frame
// before it arrived here. Frames from private links went nowhere, so they count only there. A frame that no link
// brought was sent by the program itself.
bool Engine::Impl::counts_as_heard(const Passage& p) noexcept {
    const bool is_verified = p.link.policy.rank == Rank::verified;
    if (!is_verified && !has_private_) return true;
    const Words heard = recent_.heard(p.recent);
    if (!any(heard, words_)) return true;
    if (is_verified && !intersect(heard, verified_.data(), words_)) return false;
    return p.link.policy.is_private || !is_subset(heard, private_.data(), words_);
}

void Engine::Impl::remember(Passage& p, bool found) noexcept {
    assert(recent_.active() && p.hash != 0);
    if (recent_.put(p.hash, p.now, window_, found, p.recent)) counters.recent_evicted.add();
    insert(recent_.heard(p.recent), p.slot);
    p.is_remembered = true;
}

bool Engine::Impl::is_on_two_members(const Passage& p) const noexcept {
    assert(p.link.group < groups_.size());
    const ConstWords where = routes_.links_of(p.source), members = groups_[p.link.group].members.data();
    int count = 0;
    each_word(words_, [&](std::size_t w) { count += std::popcount(where[w] & members[w]); });
    return count > 1;
}

// Uses an entry of its own under the inverted hash, because the frame's own entry restarts when a link repeats the
// frame.
bool Engine::Impl::is_doubled(const Passage& p) noexcept {
    if (!recent_.active()) return false;
    std::size_t at = 0;
    const bool found = recent_.find(~p.hash, at);
    const bool is_new = !found || p.now - recent_.time(at) >= doubled_within;
    if (!is_new && has(recent_.heard(at), p.slot)) return true;
    if (is_new && recent_.put(~p.hash, p.now, window_, found, at)) counters.recent_evicted.add();
    insert(recent_.heard(at), p.slot);
    return false;
}

// Every link of a group carries HEARTBEAT, so a link that received fewer of them lost the others. Other frames go on
// the chosen link only, so they cannot show loss. A source heard on only one link is not counted either. A link that is
// new, or was silent, starts with the count of the best link.
void Engine::Impl::count_beats(const Passage& p) noexcept {
    assert(p.link.group < groups_.size());
    const std::vector<Slot>& members = groups_[p.link.group].order;
    const bool is_beat = p.id == heartbeat_id && !is_doubled(p);
    if (!is_alive(p.link, p.now)) {
        p.link.beats = 0;
        for (const Slot slot : members)
            if (is_alive(*links[slot], p.now)) p.link.beats = std::max(p.link.beats, links[slot]->beats);
        return;
    }
    if (!is_beat || !is_on_two_members(p) || ++p.link.beats < max_heartbeats) return;
    for (const Slot slot : members) links[slot]->beats = (links[slot]->beats + 1) / 2;
}

Verdict Engine::Impl::to_everybody() noexcept {
    assign(candidates_.data(), ordinary_.data(), words_);
    if (reasons_ != nullptr) [[unlikely]]
        each(private_.data(), words_, [&](Slot slot) { note(slot, Reason::private_link); });
    return Verdict::forwarded;
}

// A target beyond the end of the payload is 0: MAVLink 2 truncates trailing zeros, MAVLink 1 omits extensions.
static Source target_of(const wire::FrameView& frame, const wire::MessageInfo* info) noexcept {
    if (info == nullptr) return {};
    const ByteView payload = frame.payload();
    const auto byte = [&](std::size_t at) { return at < payload.size() ? payload[at] : std::uint8_t{0}; };
    return {SystemId{byte(info->target_system_offset)}, ComponentId{byte(info->target_component_offset)}};
}

Verdict Engine::Impl::choose_by_target(Passage& p) noexcept {
    const Source target = target_of(p.frame, p.info);
    if (target.system.value == 0) return to_everybody();
    if (options.own == target) return Verdict::consumed;
    p.is_directed = true;
    const bool floods = options.unknown_target == UnknownTarget::flood;
    if (floods && !any(routes_.links_of(target.system), words_)) return to_everybody();
    const bool is_reached = choose_links_of(target);
    if (floods && !is_known_to_equals(target.system, p.link.policy.rank)) {
        add_equals(p.link.policy.rank, is_reached);
    } else if (!is_reached) {
        ++unknown_[pair_of(target)];
        return Verdict::unknown_target;
    }
    if (reasons_ != nullptr) [[unlikely]]
        explain_target();
    return Verdict::forwarded;
}

// Whether a link of this rank or a higher one has the system. A route that only lower ranks taught keeps no frame from
// the others.
bool Engine::Impl::is_known_to_equals(SystemId system, Rank rank) const noexcept {
    const ConstWords where = routes_.links_of(system);
    if (rank == Rank::stranger) return any(where, words_);
    return intersect(where, at_least(rank), words_);
}

// For `flood`, if only lower ranks have the system: the links of this rank and above get the frame as if nobody had it.
void Engine::Impl::add_equals(Rank rank, bool is_reached) noexcept {
    const ConstWords equals = at_least(rank);
    each_word(words_,
              [&](std::size_t w) { candidates_[w] = (is_reached ? candidates_[w] : 0) | (ordinary_[w] & equals[w]); });
}

// Makes the links of exactly the target the candidates, or else the links of its system that are not private. Returns
// false if no link knows the system, or if an unknown component is to be dropped. If only private links know the
// system, there are no candidates, and it returns true.
bool Engine::Impl::choose_links_of(Source target) noexcept {
    const ConstWords pair = routes_.links_of(pair_of(target)), of_system = routes_.links_of(target.system);
    if (target.component.value != 0 && any(pair, words_)) {
        assign(candidates_.data(), pair, words_);
        if (options.unknown_component == UnknownComponent::system && !Trust::is_autopilot(pair_of(target)))
            add_higher_ranks(of_system);
        return true;
    }
    if (!any(of_system, words_)) return false;
    if (target.component.value != 0 && options.unknown_component == UnknownComponent::drop) return false;
    each_word(words_, [&](std::size_t w) { candidates_[w] = of_system[w] & ~private_[w]; });
    return true;
}

// If only lower ranks know the component, somebody may have invented it to get its commands. So they also go to the
// links of higher ranks that have the system.
void Engine::Impl::add_higher_ranks(ConstWords of_system) noexcept {
    if (intersect(candidates_.data(), verified_.data(), words_)) return;
    const auto& higher = intersect(candidates_.data(), trusted_.data(), words_) ? verified_ : trusted_;
    each_word(words_, [&](std::size_t w) { candidates_[w] |= of_system[w] & higher[w] & ~private_[w]; });
}

void Engine::Impl::explain_target() noexcept {
    const auto note_others = [&](ConstWords links_of_kind, Reason reason) {
        each(links_of_kind, words_, [&](Slot slot) {
            if (!has(candidates_.data(), slot)) note(slot, reason);
        });
    };
    note_others(ordinary_.data(), Reason::other_target);
    note_others(private_.data(), Reason::private_link);
}

void Engine::Impl::leave_out(ConstWords set, Reason reason) noexcept {
    each_word(words_, [&](std::size_t w) {
        if (reasons_ != nullptr) [[unlikely]]
            each_in_word(candidates_[w] & set[w], static_cast<Slot>(64 * w), [&](Slot slot) { note(slot, reason); });
        candidates_[w] &= ~set[w];
    });
}

void Engine::Impl::leave_out_origin(const Passage& p) noexcept {
    erase(candidates_.data(), p.slot);
    note(p.slot, Reason::ingress);
    if (p.link.group != no_group) leave_out(groups_[p.link.group].members.data(), Reason::same_group);
    // Mostly the source is known on its own link only.
    const ConstWords where = routes_.links_of(p.source);
    if (!intersect(where, candidates_.data(), words_)) [[likely]]
        return;
    each_word(words_, [&](std::size_t w) {
        scratch_[w] = 0;
        each_in_word(where[w] & candidates_[w], static_cast<Slot>(64 * w), [&](Slot slot) {
            if (is_origin(slot, p)) insert(scratch_.data(), slot);
        });
    });
    leave_out(scratch_.data(), Reason::source_here);
}

// Whether the link has the frame's source itself, and so does not need the frame: it heard the source lately, and
// first. An own link need not be first, but one frame there may be forged. A lower rank keeps nothing from a higher
// one, and no link keeps a targeted frame from its target.
bool Engine::Impl::is_origin(Slot slot, const Passage& p) const noexcept {
    const Route* const there = routes_.find(slot, p.source);
    if (p.is_directed || there == nullptr || links[slot]->policy.rank < p.link.policy.rank) return false;
    if (p.now.time_since_epoch().count() - there->heard_ns >= present_for.count()) return false;
    const Route* const here = routes_.find(p.slot, p.source);
    if (here == nullptr || there->since_ns <= here->since_ns) return true;
    return has(trusted_.data(), slot) && there->heard_ns - there->since_ns >= repeated_after.count();
}

void Engine::Impl::apply_filters(const Passage& p) noexcept {
    for (const OutFilter& filter : filters_) {
        if (!intersect(candidates_.data(), filter.links.data(), words_)) continue;
        if (filter.filter.admits(p.id, p.frame.source())) continue;
        for (std::size_t w = 0; w < words_; ++w)
            each_in_word(candidates_[w] & filter.links[w], static_cast<Slot>(64 * w),
                         [&](Slot slot) { links[slot]->counters.out_filtered.add(); });
        leave_out(filter.links.data(), Reason::filtered);
    }
}

// HEARTBEAT goes on every link of a group, so that each side can tell which links are alive.
void Engine::Impl::apply_groups(const Passage& p) noexcept {
    if (p.id == heartbeat_id) return;
    for (Group& group : groups_) {
        if (group.mode == GroupMode::all) continue;
        std::size_t size = 0;
        for (std::size_t w = 0; w < words_; ++w) {
            scratch_[w] = candidates_[w] & group.members[w];
            size += static_cast<std::size_t>(std::popcount(scratch_[w]));
        }
        if (size < 2) continue;
        const Slot chosen = choose_member(group, scratch_.data(), p.now);
        if (chosen == no_slot) continue;
        erase(scratch_.data(), chosen);
        // It chooses an endpoint: which of its peers is the vehicle, nobody knows.
        if (const auto peers = links[chosen]->peers; peers != no_peers)
            each_word(words_, [&](std::size_t w) { scratch_[w] &= ~peers_[peers].links[w]; });
        leave_out(scratch_.data(), Reason::other_member);
    }
}

bool Engine::Impl::is_alive(const Link& link, MonoTime now) const noexcept {
    return link.heard && now - link.last_heard < member_silence;
}

bool Engine::Impl::is_better(const Link& a, const Link& b, GroupMode mode) noexcept {
    const bool is_verified = a.policy.rank == Rank::verified;
    if (is_verified != (b.policy.rank == Rank::verified)) return is_verified;
    if (mode == GroupMode::primary) return false;
    return std::pair{a.beats, a.last_heard} > std::pair{b.beats, b.last_heard};
}

// Returns no_slot if no member is alive; the frame then goes to all of them.
Slot Engine::Impl::choose_member(Group& group, Words candidates, MonoTime now) noexcept {
    assert(group.mode != GroupMode::all);
    Slot best = no_slot;
    for (const Slot slot : group.order) {
        const Link& link = *links[slot];
        if (!has(candidates, slot) || !is_alive(link, now)) continue;
        if (best == no_slot || is_better(link, *links[best], group.mode)) best = slot;
    }
    if (best == no_slot || group.mode == GroupMode::primary) return best;
    const Slot current = group.current;
    const bool stays = current != no_slot && has(candidates, current) && is_alive(*links[current], now) &&
                       has(verified_.data(), current) == has(verified_.data(), best) &&
                       links[best]->beats < links[current]->beats + best_switch_margin;
    if (!stays) group.current = best;
    assert(has(candidates, group.current));
    return group.current;
}

EgressLimiter::Answer Engine::Impl::limit(Link& link, const Passage& p) noexcept {
    const bool is_trusted = p.link.policy.rank > Rank::stranger && !p.is_repeated;
    const auto answer = link.limiter.admit(p.frame, dialect::is_essential(p.id), is_trusted, p.now);
    if (answer == EgressLimiter::Answer::rate_limited) link.counters.out_rate_limited.add();
    if (answer == EgressLimiter::Answer::bytes_limited) link.counters.out_bytes_limited.add();
    return answer;
}

static constexpr Reason reason_of(EgressLimiter::Answer answer) noexcept {
    return answer == EgressLimiter::Answer::rate_limited ? Reason::rate_limited : Reason::bytes_limited;
}

void Engine::Impl::apply_limits(const Passage& p) noexcept {
    for (std::size_t w = 0; w < words_; ++w)
        each_in_word(candidates_[w] & limited_[w], static_cast<Slot>(64 * w), [&](Slot slot) {
            const auto answer = limit(*links[slot], p);
            if (answer == EgressLimiter::Answer::admitted) return;
            erase(candidates_.data(), slot);
            note(slot, reason_of(answer));
        });
}

void Engine::Impl::add_taps(const Passage& p) noexcept {
    each(taps_.data(), words_, [&](Slot slot) {
        Link& link = *links[slot];
        if (!link.policy.out.admits(p.id, p.frame.source())) {
            link.counters.out_filtered.add();
            note(slot, Reason::filtered);
            return;
        }
        const auto answer = has(limited_.data(), slot) ? limit(link, p) : EgressLimiter::Answer::admitted;
        if (answer == EgressLimiter::Answer::admitted) {
            insert(candidates_.data(), slot);
            note(slot, Reason::tap);
        } else {
            note(slot, reason_of(answer));
        }
    });
}

void Engine::Impl::count(LinkCounters& of, Verdict verdict) noexcept {
    switch (verdict) {
        case Verdict::forwarded: of.forwarded.add(); break;
        case Verdict::nowhere: of.nowhere.add(); break;
        case Verdict::filtered: of.filtered.add(); break;
        case Verdict::rate_limited: of.rate_limited.add(); break;
        case Verdict::duplicate: of.duplicate.add(); break;
        case Verdict::echo: of.echo.add(); break;
        case Verdict::unknown_target: of.unknown_target.add(); break;
        case Verdict::consumed: of.consumed.add(); break;
        case Verdict::tap: of.tap.add(); break;
        case Verdict::private_link: of.private_link.add(); break;
        case Verdict::unknown_link: break;
    }
}

void Engine::Impl::count_routes(const RouteTable::Change& change) noexcept {
    if ((change.learned | change.expired | change.evicted) == 0) [[likely]]
        return;
    counters.routes_learned.add(change.learned);
    counters.routes_expired.add(change.expired);
    counters.routes_evicted.add(change.evicted);
}

Decision Engine::Impl::explain(const wire::FrameView& frame, const wire::MessageInfo* info, LinkId ingress,
                               MonoTime now, std::vector<Explanation>& why, bool is_repeated) {
    std::vector<Reason> reasons(links.size(), Reason::dropped);
    reasons_ = &reasons;
    const Decision decision = route(frame, mark_of(frame), info, ingress, now, is_repeated);
    reasons_ = nullptr;
    why.clear();
    for (Slot slot = 0; slot < links.size(); ++slot) {
        if (links[slot] == nullptr) continue;
        const bool goes = has(candidates_.data(), slot) && decision.verdict != Verdict::unknown_link;
        if (goes && reasons[slot] != Reason::tap) reasons[slot] = Reason::sent;
        why.push_back({links[slot]->id, reasons[slot]});
    }
    std::sort(why.begin(), why.end(), [](const Explanation& a, const Explanation& b) { return a.link < b.link; });
    return decision;
}

void Engine::Impl::note_sent(const wire::FrameView& frame, LinkId link, MonoTime now) noexcept {
    const Slot slot = slot_of(link);
    if (slot == no_slot || !recent_.active()) return;
    now_ = std::max(now, now_);
    const std::uint64_t hash = hash_of(frame.bytes(), options.seed);
    std::size_t at = 0;
    const bool found = recent_.find(hash, at);
    if (!found || now_ - recent_.time(at) >= echo_window)
        if (recent_.put(hash, now_, window_, found, at)) counters.recent_evicted.add();
    insert(recent_.sent(at), slot);
}

}  // namespace mavloom::route
