// SPDX-License-Identifier: MIT
// The routing rules once more, naively: lists, linear scans, nothing remembered but what happened. Written from the
// rules' text, not from the engine.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "mavloom/dialect/filter.hpp"
#include "unit/route/route_frames.hpp"

namespace mavloom::route::test {

using Terms = dialect::FilterTerms;

struct ModelPolicy {
    Terms in_allow{}, in_block{}, out_allow{}, out_block{};
    std::uint32_t group = 0;
    GroupMode mode = GroupMode::all;
    std::uint32_t order = 0;
    std::uint32_t endpoint = 0;
    Rank rank = Rank::own;
    bool tap = false, is_private = false, learns_first = false;
    std::optional<Nanoseconds> attitude_interval{}, other_interval{};
    std::optional<std::uint64_t> bytes_per_s{};
};

class Model {
public:
    explicit Model(const Options& options) : options_(options) {}

    struct Result {
        Verdict verdict = Verdict::nowhere;
        std::map<std::uint32_t, Reason> why;

        [[nodiscard]] Ids links() const {
            Ids ids;
            for (const auto& [id, reason] : why)
                if (reason == Reason::sent || reason == Reason::tap) ids.push_back(id);
            return ids;
        }
    };

    void add(std::uint32_t id, const ModelPolicy& policy) {
        Link link;
        link.policy = policy;
        link.tokens = link.trusted_tokens = std::max(static_cast<double>(policy.bytes_per_s.value_or(0)) / 4, 560.0);
        if (policy.group != 0 && !policy.tap) {
            if (!group_modes_.contains(policy.group)) group_modes_[policy.group] = policy.mode;
            link.policy.mode = group_modes_[policy.group];
        }
        if (policy.tap) link.policy.group = 0;
        links_[id] = link;
    }
    // A frame of this source revealed a reboot. False where the source is not known on that link.
    bool reboot(std::uint32_t link, std::uint8_t system, std::uint8_t component, MonoTime now) {
        const auto is_it = [&](const Heard& h) {
            return h.link == link && h.system == system && h.component == component;
        };
        const auto source = std::find_if(heard_.begin(), heard_.end(), is_it);
        if (source == heard_.end() || !source->known || now - source->time >= options_.route_timeout) return false;
        for (Heard& h : heard_)
            if (h.link == link && h.system == system) h.known = is_it(h);
        if (source->known) source->time = source->since = now;
        return true;
    }
    void remove(std::uint32_t id) {
        links_.erase(id);
        std::erase_if(heard_, [&](const Heard& h) { return h.link == id; });
        for (Recent& r : recent_) {
            if (r.heard.erase(id) != 0) r.heard.insert(gone);
            r.sent.erase(id);
        }
        for (Recent& r : beats_) r.heard.erase(id);
        for (auto& [group, current] : current_)
            if (current == id) current = 0;
        const auto is_empty = [&](const auto& of_group) {
            return std::ranges::none_of(links_, [&](const auto& l) { return l.second.policy.group == of_group.first; });
        };
        std::erase_if(group_modes_, is_empty);
        std::erase_if(current_, is_empty);
    }

    Result route(std::uint32_t ingress, const Bytes& bytes, MonoTime now, bool is_repeated = false) {
        is_repeated_ = is_repeated;
        copy_of_ = nullptr;
        const auto frame = wire::FrameView::unchecked(bytes);
        now_ = now;
        Result result;
        if (!links_.contains(ingress)) {
            result.verdict = Verdict::unknown_link;
            for (const auto& [id, link] : links_) result.why[id] = Reason::dropped;
            return result;
        }
        is_trusted_ = links_[ingress].policy.rank != Rank::stranger && !is_repeated;
        std::erase_if(heard_, [&](const Heard& h) { return now - h.time >= options_.route_timeout; });
        for (const auto& [id, link] : links_) result.why[id] = Reason::dropped;
        Recent* remembered = nullptr;
        result.verdict = judge(ingress, bytes, frame, result.why, remembered);
        if (result.verdict != Verdict::tap) give_to_taps(frame, result.why);
        if (remembered != nullptr)
            for (const auto id : result.links()) remembered->sent.insert(id);
        return result;
    }

    // link, system, component and the number of frames that taught it.
    [[nodiscard]] std::set<std::tuple<std::uint32_t, int, int, std::uint64_t>> routes(MonoTime now) const {
        std::set<std::tuple<std::uint32_t, int, int, std::uint64_t>> list;
        for (const Heard& h : heard_)
            if (h.known && now - h.time < options_.route_timeout) list.emplace(h.link, h.system, h.component, h.frames);
        return list;
    }

private:
    struct Claim {
        MonoTime since{}, last{};
    };
    // The frames that `max_rate` let pass (docs/guide/routing.md): the first, and one for each interval since then.
    struct Stream {
        MonoTime begin{};
        int frames = 0;

        [[nodiscard]] MonoTime next(Nanoseconds interval) const { return begin + frames * interval; }
        // Early by half an interval or more, but less than 50 ms is never too early, and 0.5 s always is.
        [[nodiscard]] bool is_early(MonoTime now, Nanoseconds interval) const {
            const Nanoseconds early = next(interval) - now;
            if (early < std::chrono::milliseconds{50}) return false;
            return early >= std::chrono::milliseconds{500} || 2 * early >= interval;
        }
        // Late by a whole interval, and by 100 ms: the next frame is the first again.
        [[nodiscard]] bool has_paused(MonoTime now, Nanoseconds interval) const {
            const Nanoseconds late = now - next(interval);
            return late >= interval && late >= std::chrono::milliseconds{100};
        }
    };
    struct Link {
        ModelPolicy policy{};
        std::map<std::uint8_t, Claim> claims{};  // by system
        std::optional<MonoTime> last_heard{};
        std::uint32_t heartbeats = 0;  // against those of the other links of its group
        // By source, message and whether the frame was trusted.
        std::map<std::pair<std::uint64_t, bool>, Stream> streams{};
        double tokens = 0, trusted_tokens = 0;  // trusted frames take from both
        std::optional<MonoTime> filled{};
    };
    struct Heard {
        std::uint32_t link;
        std::uint8_t system, component;
        MonoTime time, since;
        std::uint64_t frames = 0;
        bool known = true;
    };
    // The link that had a source last. It may be gone.
    struct Had {
        std::uint32_t link;
        ModelPolicy policy;
        MonoTime last;
    };
    struct Recent {
        Bytes bytes;
        MonoTime time;
        std::set<std::uint32_t> heard, sent;
    };
    using Why = std::map<std::uint32_t, Reason>;
    static constexpr std::uint32_t gone = ~std::uint32_t{0};  // in the place of a removed link

    static bool in(const auto& list, const auto& value) {
        return std::find(list.begin(), list.end(), value) != list.end();
    }
    static bool admits(const Terms& allow, const Terms& block, const wire::FrameView& frame) {
        const auto id = std::to_string(frame.id().value);
        const auto system = frame.system().value, component = frame.component().value;
        if (!allow.messages.empty() && !in(allow.messages, id)) return false;
        if (!allow.systems.empty() && !in(allow.systems, system)) return false;
        if (!allow.components.empty() && !in(allow.components, component)) return false;
        return !in(block.messages, id) && !in(block.systems, system) && !in(block.components, component);
    }
    [[nodiscard]] bool is_fresh(std::uint32_t link, std::uint8_t system, int component) const {
        return std::any_of(heard_.begin(), heard_.end(), [&](const Heard& h) {
            return h.known && h.link == link && h.system == system && (component < 0 || h.component == component);
        });
    }
    [[nodiscard]] bool is_fresh_anywhere(std::uint8_t system, int component) const {
        return std::any_of(links_.begin(), links_.end(),
                           [&](const auto& l) { return is_fresh(l.first, system, component); });
    }

    Verdict judge(std::uint32_t ingress, const Bytes& bytes, const wire::FrameView& frame, Why& why,
                  Recent*& remembered) {
        Link& link = links_[ingress];
        if (link.policy.tap) return Verdict::tap;
        if (!admits(link.policy.in_allow, link.policy.in_block, frame)) return Verdict::filtered;
        const auto same = [&](const Recent& r) { return r.bytes == bytes; };
        if (const auto r = std::find_if(recent_.begin(), recent_.end(), same); r != recent_.end()) {
            if (!may_count(*r, link)) {
                recent_.erase(r);
                return remember(ingress, bytes, frame, why, remembered);
            }
            const auto age = now_ - r->time;
            if (age < std::chrono::seconds{2} && r->sent.contains(ingress)) return Verdict::echo;
            const bool again = r->heard.contains(ingress);
            const bool by_member = std::any_of(r->heard.begin(), r->heard.end(), [&](std::uint32_t id) {
                return id != gone && id != ingress && is_same_place(link.policy, links_[id].policy);
            });
            if (!by_member && !again && age < std::chrono::seconds{2}) copy_of_ = &*r;
            if ((by_member && !again && age < std::chrono::seconds{2}) || (age < options_.dedup && !r->heard.empty())) {
                if (!again) learn(ingress, frame);
                r->heard.insert(ingress);
                return Verdict::duplicate;
            }
            if (copy_of_ != nullptr) {
                remembered = &*r;
                return decide_unless_private(ingress, frame, why, r->sent, r->heard);
            }
            recent_.erase(r);
        }
        return remember(ingress, bytes, frame, why, remembered);
    }
    Verdict remember(std::uint32_t ingress, const Bytes& bytes, const wire::FrameView& frame, Why& why,
                     Recent*& remembered) {
        recent_.push_back({bytes, now_, {ingress}, {}});
        remembered = &recent_.back();
        return decide_unless_private(ingress, frame, why, {}, {});
    }
    // On a verified link, copies from unverified links do not count. Frames from private links count only there.
    [[nodiscard]] bool may_count(const Recent& r, const Link& link) const {
        if (r.heard.empty()) return true;
        const auto some = [&](auto is_it) {
            return std::ranges::any_of(
                r.heard, [&](std::uint32_t id) { return is_it(id == gone ? ModelPolicy{} : links_.at(id).policy); });
        };
        const auto is_verified = [](const ModelPolicy& policy) { return policy.rank == Rank::verified; };
        if (link.policy.rank == Rank::verified && !some(is_verified)) return false;
        return link.policy.is_private || some([](const ModelPolicy& policy) { return !policy.is_private; });
    }

    Verdict decide_unless_private(std::uint32_t ingress, const wire::FrameView& frame, Why& why,
                                  const std::set<std::uint32_t>& have_it, const std::set<std::uint32_t>& sent_it) {
        learn(ingress, frame);
        if (links_[ingress].policy.is_private) return Verdict::private_link;
        return decide(ingress, frame, why, have_it, sent_it);
    }

    [[nodiscard]] bool is_silent(const Link& link) const {
        return !link.last_heard || now_ - *link.last_heard >= std::chrono::seconds{3};
    }

    // A link that was silent begins even with the best of its group; who has heard 256 HEARTBEATs halves what all have
    // heard. HEARTBEATs of a source that was heard on one link of the group only do not count.
    void count_heartbeat(Link& link, const wire::FrameView& frame, bool doubled) {
        const auto each_of_group = [&](auto change) {
            for (auto& [id, other] : links_)
                if (other.policy.group == link.policy.group) change(other.heartbeats);
        };
        if (is_silent(link)) {
            link.heartbeats = 0;
            for (const auto& [id, other] : links_)
                if (other.policy.group == link.policy.group && !is_silent(other))
                    link.heartbeats = std::max(link.heartbeats, other.heartbeats);
            return;
        }
        const auto brought = std::ranges::count_if(links_, [&](const auto& l) {
            return l.second.policy.group == link.policy.group &&
                   is_fresh(l.first, frame.system().value, frame.component().value);
        });
        if (frame.id().value != 0 || doubled || brought < 2) return;
        ++link.heartbeats;
        if (link.heartbeats == 256) each_of_group([](std::uint32_t& n) { n = (n + 1) / 2; });
    }

    // The link brought this HEARTBEAT within half a second of when it came first.
    bool is_doubled(std::uint32_t ingress, const wire::FrameView& frame) {
        if (frame.id().value != 0) return false;
        std::erase_if(beats_, [&](const Recent& r) { return now_ - r.time >= std::chrono::milliseconds{500}; });
        const Bytes bytes = mavloom::test::copy(frame.bytes());
        const auto same = std::ranges::find(beats_, bytes, &Recent::bytes);
        if (same != beats_.end()) return !same->heard.insert(ingress).second;
        beats_.push_back({bytes, now_, {ingress}, {}});
        return false;
    }

    void learn(std::uint32_t ingress, const wire::FrameView& frame) {
        const auto system = frame.system().value, component = frame.component().value;
        if (is_repeated_ && !is_fresh(ingress, system, component)) return;
        if (links_[ingress].policy.group != 0) count_heartbeat(links_[ingress], frame, is_doubled(ingress, frame));
        links_[ingress].last_heard = now_;
        if (system == 0 || info(frame) == nullptr) return;
        if (!is_believed(ingress, system, component)) return;
        const auto same = [&](const Heard& h) {
            return h.link == ingress && h.system == system && h.component == component;
        };
        if (std::none_of(heard_.begin(), heard_.end(), same))
            heard_.push_back({ingress, system, component, now_, now_});
        Heard& heard = *std::find_if(heard_.begin(), heard_.end(), same);
        if (!heard.known) heard.since = now_;
        heard.known = true;
        heard.time = now_;
        ++heard.frames;
        if (!is_second_hand(ingress, system, component)) note_had(ingress, system, component);
    }

    // A copy, on an own link, of an autopilot's frame while no own link has the autopilot.
    [[nodiscard]] bool is_second_hand(std::uint32_t ingress, std::uint8_t system, std::uint8_t component) const {
        const bool is_own = links_.at(ingress).policy.rank == Rank::own;
        if (copy_of_ == nullptr || !is_own || !is_autopilot(system, component)) return false;
        const auto had = had_.find({Rank::own, system, component});
        return had == had_.end() || now_ - had->second.last >= std::chrono::seconds{2};
    }

    // Links of a group lead to the same place, but nobody knows that of the unverified peers of one endpoint.
    static bool are_peers(const ModelPolicy& a, const ModelPolicy& b) {
        return a.endpoint != 0 && a.endpoint == b.endpoint && a.rank != Rank::verified && b.rank != Rank::verified;
    }
    static bool is_same_place(const ModelPolicy& a, const ModelPolicy& b) {
        return a.group != 0 && a.group == b.group && !are_peers(a, b);
    }
    static bool is_autopilot(std::uint8_t system, std::uint8_t component) { return component == 1 && system != 255; }

    // Another place of this rank had the source within the time.
    [[nodiscard]] bool has(Rank rank, Nanoseconds time, std::uint32_t by, std::uint8_t system, std::uint8_t component) {
        const auto had = had_.find({rank, system, component});
        return had != had_.end() && now_ - had->second.last < time && had->second.link != by &&
               !is_same_place(had->second.policy, links_[by].policy);
    }
    // Rules 2 and 3.
    bool is_believed(std::uint32_t ingress, std::uint8_t system, std::uint8_t component) {
        const Rank rank = links_[ingress].policy.rank;
        const auto has_it = [&](Rank other, Nanoseconds time) { return has(other, time, ingress, system, component); };
        const bool is_protected = is_autopilot(system, component), is_fresh_here = is_fresh(ingress, system, component);
        const bool is_refused = (rank != Rank::verified && has_it(Rank::verified, options_.route_timeout)) ||
                                (rank == Rank::stranger && is_protected && has_it(Rank::own, std::chrono::seconds{2}));
        if (is_refused && (!is_protected || is_fresh_here)) return false;
        if (!is_refused && (rank != Rank::stranger || !is_protected || is_fresh_here ||
                            !has_it(Rank::stranger, std::chrono::seconds{2})))
            return true;
        for (Heard& h : heard_)  // the count of frames of an ended route lives as long as claims come
            if (h.link == ingress && h.system == system && h.component == component) h.time = now_;
        const Claim& claim = claim_of(links_[ingress], system);
        return !is_refused && now_ - claim.since >= std::chrono::seconds{5} && !links_[ingress].policy.learns_first;
    }
    // A gap of two seconds, or a route, begins a claim again.
    Claim& claim_of(Link& link, std::uint8_t system) const {
        Claim& claim = link.claims.try_emplace(system, Claim{now_, now_}).first->second;
        if (now_ - claim.last >= std::chrono::seconds{2}) claim.since = now_;
        claim.last = now_;
        return claim;
    }
    void note_had(std::uint32_t ingress, std::uint8_t system, std::uint8_t component) {
        const ModelPolicy& policy = links_[ingress].policy;
        links_[ingress].claims.erase(component == 1 ? system : std::uint8_t{0});
        if (policy.rank != Rank::verified && !is_autopilot(system, component)) return;
        had_[{policy.rank, system, component}] = {ingress, policy, now_};
        for (Heard& h : heard_)
            if (h.system == system && h.component == component && links_[h.link].policy.rank < policy.rank &&
                !is_same_place(links_[h.link].policy, policy))
                h.known = false;
    }

    // The link heard the source within 3 s, and no later than the other link did. An own link may be later, if it heard
    // the source for half a second.
    bool is_origin(std::uint32_t link, std::uint32_t ingress, const wire::FrameView& frame) const {
        const auto route_on = [&](std::uint32_t id) {
            return std::ranges::find_if(heard_, [&](const Heard& h) {
                return h.known && h.link == id && h.system == frame.system().value &&
                       h.component == frame.component().value;
            });
        };
        const auto there = route_on(link), here = route_on(ingress);
        if (there == heard_.end() || now_ - there->time >= std::chrono::seconds{3}) return false;
        if (links_.at(link).policy.rank < links_.at(ingress).policy.rank) return false;
        if (here == heard_.end() || there->since <= here->since) return true;
        return links_.at(link).policy.rank != Rank::stranger &&
               there->time - there->since >= std::chrono::milliseconds{500};
    }

    static const wire::MessageInfo* info(const wire::FrameView& frame) {
        return dialect::default_dialect().wire_table().find(frame.id());
    }
    static std::uint8_t target(const wire::FrameView& frame, std::string_view field_name) {
        const auto* message = dialect::default_dialect().find(frame.id());
        const auto* field = message == nullptr ? nullptr : message->find(field_name);
        return field != nullptr && field->offset < frame.payload().size() ? frame.payload()[field->offset]
                                                                          : std::uint8_t{0};
    }

    Verdict decide(std::uint32_t ingress, const wire::FrameView& frame, Why& why,
                   const std::set<std::uint32_t>& have_it, const std::set<std::uint32_t>& sent_it) {
        const auto system = std::max(target(frame, "target_system"), target(frame, "target"));
        const auto component = target(frame, "target_component");
        const bool exact = component != 0 && is_fresh_anywhere(system, component);
        if (system != 0 && options_.own == Source{SystemId{system}, ComponentId{component}}) return Verdict::consumed;
        const Rank rank = links_[ingress].policy.rank;
        const bool floods = system != 0 && options_.unknown_target == UnknownTarget::flood;
        const bool is_known = is_fresh_anywhere(system, -1);
        const bool broadcast = system == 0 || (floods && !is_known);
        // Only lower ranks know the system: links of this rank and above get the frame as if nobody did.
        const bool is_for_equals = floods && is_known && best_rank(system, -1) < std::optional(rank);
        const bool is_dropped = component != 0 && !exact && options_.unknown_component == UnknownComponent::drop;
        if (!broadcast && !is_for_equals && (!is_known || is_dropped)) return Verdict::unknown_target;
        for (auto& [id, link] : links_) {
            const auto& policy = link.policy;
            if (policy.tap) continue;
            // Of a component that only lower ranks have, the system's links of higher ranks hear too.
            const bool is_higher = exact && !is_autopilot(system, component) &&
                                   options_.unknown_component == UnknownComponent::system && !policy.is_private &&
                                   is_fresh(id, system, -1) && best_rank(system, component) < std::optional(policy.rank);
            const bool is_reached = !is_dropped && (is_fresh(id, system, exact ? component : -1) || is_higher);
            const bool has_target = !broadcast &&
                                    (is_reached || (is_for_equals && !policy.is_private && policy.rank >= rank));
            if (policy.is_private && !(exact && has_target)) why[id] = Reason::private_link;
            else if (!broadcast && !has_target) why[id] = Reason::other_target;
            else if (policy.group != 0 && policy.group == links_[ingress].policy.group) why[id] = Reason::same_group;
            else if (system == 0 && is_origin(id, ingress, frame)) why[id] = Reason::source_here;
            else why[id] = Reason::sent;
            if (id == ingress) why[id] = Reason::ingress;
        }
        return narrow(frame, why, have_it, sent_it);
    }

    // The highest rank of the links that have it; empty, which is less than all ranks, if none has.
    [[nodiscard]] std::optional<Rank> best_rank(std::uint8_t system, int component) const {
        std::optional<Rank> best;
        for (const auto& [id, link] : links_)
            if (is_fresh(id, system, component)) best = std::max(best, std::optional(link.policy.rank));
        return best;
    }

    static bool any_sent(const Why& why) {
        return std::any_of(why.begin(), why.end(), [](const auto& w) { return w.second == Reason::sent; });
    }

    Verdict narrow(const wire::FrameView& frame, Why& why, const std::set<std::uint32_t>& have_it,
                   const std::set<std::uint32_t>& sent_it) {
        if (!any_sent(why)) return Verdict::nowhere;
        for (auto& [id, reason] : why)
            if (reason == Reason::sent && !admits(links_[id].policy.out_allow, links_[id].policy.out_block, frame))
                reason = Reason::filtered;
        if (!any_sent(why)) return Verdict::filtered;
        if (frame.id().value != 0)
            for (const auto& [group, mode] : group_modes_)
                if (mode != GroupMode::all) choose(group, mode, why);
        for (auto& [id, reason] : why)
            if (reason == Reason::sent && have_it.contains(id)) reason = Reason::already_sent;
        for (auto& [id, reason] : why)
            if (reason == Reason::sent && sent_it.contains(id)) reason = Reason::source_here;
        if (!any_sent(why)) return Verdict::duplicate;
        for (auto& [id, reason] : why)
            if (reason == Reason::sent) reason = limit(links_[id], frame, Reason::sent);
        return any_sent(why) ? Verdict::forwarded : Verdict::rate_limited;
    }

    void choose(std::uint32_t group, GroupMode mode, Why& why) {
        std::vector<std::uint32_t> members, alive;
        for (const auto& [id, reason] : why)
            if (reason == Reason::sent && links_[id].policy.group == group) members.push_back(id);
        if (members.size() < 2) return;
        for (const auto id : members)
            if (!is_silent(links_[id])) alive.push_back(id);
        if (alive.empty()) return;
        const auto is_verified = [&](auto id) { return links_[id].policy.rank == Rank::verified; };
        if (std::ranges::any_of(alive, is_verified)) std::erase_if(alive, std::not_fn(is_verified));
        std::stable_sort(alive.begin(), alive.end(),
                         [&](auto a, auto b) { return links_[a].policy.order < links_[b].policy.order; });
        std::uint32_t chosen = alive.front();
        if (mode == GroupMode::best) {
            std::stable_sort(alive.begin(), alive.end(), [&](auto a, auto b) {
                return std::pair{links_[a].heartbeats, *links_[a].last_heard} >
                       std::pair{links_[b].heartbeats, *links_[b].last_heard};
            });
            chosen = alive.front();
            if (in(alive, current_[group]) && links_[current_[group]].heartbeats + 5 > links_[chosen].heartbeats)
                chosen = current_[group];
            current_[group] = chosen;
        }
        for (const auto id : members)
            if (id != chosen &&
                (links_[chosen].policy.endpoint == 0 || links_[id].policy.endpoint != links_[chosen].policy.endpoint))
                why[id] = Reason::other_member;
    }

    // docs/guide/queues.md: of class 0 the test has HEARTBEAT, COMMAND_LONG, SET_MODE; of class 1 MANUAL_CONTROL.
    static bool is_essential(std::uint32_t id) { return id == 0 || id == 76 || id == 11; }
    static bool is_spared_by_star(std::uint32_t id) { return is_essential(id) || id == 69; }

    Reason limit(Link& link, const wire::FrameView& frame, Reason otherwise) {
        std::optional<Nanoseconds> interval;
        if (frame.id().value == 30 && link.policy.attitude_interval) interval = link.policy.attitude_interval;
        else if (!is_spared_by_star(frame.id().value)) interval = link.policy.other_interval;
        const std::pair key{
            std::uint64_t{frame.system().value} << 40 | std::uint64_t{frame.component().value} << 32 | frame.id().value,
            is_trusted_};
        Stream stream = link.streams.contains(key) ? link.streams[key] : Stream{now_};
        if (interval && stream.is_early(now_, *interval)) return Reason::rate_limited;
        if (link.policy.bytes_per_s) {
            const auto rate = static_cast<double>(*link.policy.bytes_per_s);
            for (double* tokens : {&link.tokens, &link.trusted_tokens})
                if (link.filled)
                    *tokens = std::min(*tokens + std::chrono::duration<double>(now_ - *link.filled).count() * rate,
                                       std::max(rate / 4, 560.0));
            link.filled = now_;
            const auto size = static_cast<double>(frame.size());
            const double left = is_trusted_ ? link.trusted_tokens : link.tokens;
            if (!is_essential(frame.id().value) && left < size) return Reason::bytes_limited;
            link.tokens = std::max(link.tokens - size, -rate);
            if (is_trusted_) link.trusted_tokens = std::max(link.trusted_tokens - size, -rate);
        }
        if (interval) {
            if (stream.has_paused(now_, *interval)) stream = {now_};
            ++stream.frames;
            link.streams[key] = stream;
        }
        return otherwise;
    }

    void give_to_taps(const wire::FrameView& frame, Why& why) {
        for (auto& [id, link] : links_) {
            if (!link.policy.tap) continue;
            why[id] = admits(link.policy.out_allow, link.policy.out_block, frame) ? limit(link, frame, Reason::tap)
                                                                                  : Reason::filtered;
        }
    }

    Options options_;
    MonoTime now_{};
    // Of the frame being routed.
    bool is_trusted_ = false, is_repeated_ = false;
    const Recent* copy_of_ = nullptr;
    std::map<std::uint32_t, Link> links_;
    std::map<std::uint32_t, GroupMode> group_modes_;  // the first link of a group decides
    std::map<std::uint32_t, std::uint32_t> current_;  // of a `best` group
    std::map<std::tuple<Rank, std::uint8_t, std::uint8_t>, Had> had_;
    std::vector<Heard> heard_;
    std::vector<Recent> recent_;
    std::vector<Recent> beats_;  // HEARTBEATs of groups
};

}  // namespace mavloom::route::test
