// SPDX-License-Identifier: MIT
// The routing rules once more, naively: lists, linear scans, nothing remembered but what happened. Written from the
// rules' text, not from the engine.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "unit/route/route_frames.hpp"

namespace mavloom::route::test {

struct ModelPolicy {
    Terms in_allow{}, in_block{}, out_allow{}, out_block{};
    std::uint32_t group = 0;
    GroupMode mode = GroupMode::all;
    std::uint32_t order = 0;
    std::uint32_t endpoint = 0;
    std::uint64_t address = 0;
    bool tap = false, is_private = false, is_verified = false, learns_first = false;
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
        link.tokens = link.verified_tokens = std::max(static_cast<double>(policy.bytes_per_s.value_or(0)) / 4, 560.0);
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
        if (source == heard_.end() || !source->known || now - source->last() >= options_.route_timeout) return false;
        for (Heard& h : heard_)
            if (h.link == link && h.system == system) h.known = is_it(h) && !h.only_echoes;
        if (source->known) source->time = source->since = now;
        return true;
    }
    void remove(std::uint32_t id) {
        if (const auto link = links_.find(id); link != links_.end()) note_departure(id, link->second.policy);
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
        const auto frame = wire::FrameView::unchecked(bytes);
        now_ = now;
        is_verified_ = links_.contains(ingress) && links_[ingress].policy.is_verified;
        Result result;
        if (!links_.contains(ingress)) {
            result.verdict = Verdict::unknown_link;
            for (const auto& [id, link] : links_) result.why[id] = Reason::dropped;
            return result;
        }
        std::erase_if(heard_, [&](const Heard& h) { return now - h.last() >= options_.route_timeout; });
        for (const auto& [id, link] : links_) result.why[id] = Reason::dropped;
        Recent* remembered = nullptr;
        result.verdict = judge(ingress, bytes, frame, result.why, remembered);
        if (result.verdict != Verdict::tap) give_to_taps(frame, result.why);
        if (remembered != nullptr)
            for (const auto id : result.links()) remembered->sent.insert(id);
        for (const auto id : result.links()) note_kept(links_[id], frame.system().value);
        return result;
    }

    // link, system, component and the number of frames that taught it.
    [[nodiscard]] std::set<std::tuple<std::uint32_t, int, int, std::uint64_t>> routes(MonoTime now) const {
        std::set<std::tuple<std::uint32_t, int, int, std::uint64_t>> list;
        for (const Heard& h : heard_)
            if (h.known && now - h.last() < options_.route_timeout)
                list.emplace(h.link, h.system, h.component, h.frames);
        return list;
    }

private:
    struct Claim {
        MonoTime since{}, last{};
    };
    struct Link {
        ModelPolicy policy{};
        std::map<std::uint8_t, Claim> claims{};  // by system
        std::optional<MonoTime> last_echo{};
        std::set<std::uint8_t> returned{};  // systems of which an echo came
        std::vector<MonoTime> kept{};       // when frames of other systems were sent here, since the last of them came
        std::optional<MonoTime> last_heard{};
        std::uint32_t heartbeats = 0;  // against those of the other links of its group
        // By source, message and whether the frame was verified.
        std::map<std::pair<std::uint64_t, bool>, MonoTime> due{};
        double tokens = 0, verified_tokens = 0;  // verified frames take from both
        std::optional<MonoTime> filled{};
    };
    struct Heard {
        std::uint32_t link;
        std::uint8_t system, component;
        MonoTime time, since;
        std::uint64_t frames = 0;
        bool known = true;
        bool only_echoes = false;
        std::optional<MonoTime> echoed{};

        [[nodiscard]] MonoTime last() const { return only_echoes ? *echoed : std::max(time, echoed.value_or(time)); }
    };
    struct Recent {
        Bytes bytes;
        MonoTime time;
        std::set<std::uint32_t> heard, sent;
    };
    struct Departed {
        ModelPolicy policy;
        MonoTime until;
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
            if (age < std::chrono::seconds{2} && r->sent.contains(ingress)) {
                learn_from_echo(ingress, frame);
                return Verdict::echo;
            }
            const bool again = r->heard.contains(ingress);
            const bool by_member = std::any_of(r->heard.begin(), r->heard.end(), [&](std::uint32_t id) {
                return id != gone && id != ingress && is_same_place(link, links_[id]);
            });
            if ((by_member && !again && age < std::chrono::seconds{2}) || (age < options_.dedup && !r->heard.empty())) {
                r->heard.insert(ingress);
                if (!again) learn(ingress, frame);
                return Verdict::duplicate;
            }
            if (age < std::chrono::seconds{2} && !again) {
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
        const auto some = [&](bool ModelPolicy::*kind, bool wanted) {
            return std::ranges::any_of(
                r.heard, [&](std::uint32_t id) { return (id != gone && links_.at(id).policy.*kind) == wanted; });
        };
        if (link.policy.is_verified && !some(&ModelPolicy::is_verified, true)) return false;
        return link.policy.is_private || some(&ModelPolicy::is_private, false);
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
        if (!may_learn(ingress, system, component) || !may_return(ingress, system, component)) return;
        const auto same = [&](const Heard& h) {
            return h.link == ingress && h.system == system && h.component == component;
        };
        if (std::none_of(heard_.begin(), heard_.end(), same))
            heard_.push_back({ingress, system, component, now_, now_});
        Heard& heard = *std::find_if(heard_.begin(), heard_.end(), same);
        if (!heard.known || heard.only_echoes) heard.since = now_;
        heard.known = true;
        heard.only_echoes = false;
        heard.time = now_;
        ++heard.frames;
    }

    // For a minute after each echo, what the link does not send back is looked at.
    void note_kept(Link& link, std::uint8_t system) const {
        const bool is_watched = link.last_echo && now_ - *link.last_echo < std::chrono::seconds{60};
        if (is_watched && !link.returned.contains(system)) link.kept.push_back(now_);
    }

    // A link that kept five frames of systems of which it returned nothing, the first of them 2 s ago, does not send
    // back what it gets: then an echo shows where its sender is. An echo also refreshes a route.
    void learn_from_echo(std::uint32_t ingress, const wire::FrameView& frame) {
        if (is_repeated_) return;
        Link& link = links_[ingress];
        const auto system = frame.system().value, component = frame.component().value;
        if (link.last_echo && now_ - *link.last_echo >= std::chrono::seconds{60}) link.returned.clear();
        link.last_echo = now_;
        if (link.returned.insert(system).second) link.kept.clear();
        const bool keeps_others = link.kept.size() >= 5 && now_ - link.kept.front() >= std::chrono::seconds{2};
        if (system == 0 || info(frame) == nullptr) return;
        if (!keeps_others && !is_fresh(ingress, system, component)) {
            claim(link, system);
            return;
        }
        if (!may_learn(ingress, system, component) || !may_return(ingress, system, component)) return;
        const auto same = [&](const Heard& h) {
            return h.link == ingress && h.system == system && h.component == component;
        };
        auto heard = std::find_if(heard_.begin(), heard_.end(), same);
        if (heard == heard_.end()) {
            heard_.push_back({ingress, system, component, {}, {}, 0, false});
            heard = heard_.end() - 1;
        }
        if (!heard->known) heard->only_echoes = true;
        heard->known = true;
        heard->echoed = now_;
    }

    // Links of a group lead to the same place, but nobody knows that of the unverified peers of one endpoint.
    static bool are_peers(const Link& a, const Link& b) {
        return a.policy.endpoint != 0 && a.policy.endpoint == b.policy.endpoint && !a.policy.is_verified &&
               !b.policy.is_verified;
    }
    static bool is_same_place(const Link& a, const Link& b) {
        return a.policy.group != 0 && a.policy.group == b.policy.group && !are_peers(a, b);
    }

    // A vehicle that is alive elsewhere is learned only after 5 s without a gap of 2 s. Verified links come first.
    bool may_learn(std::uint32_t ingress, std::uint8_t system, std::uint8_t component) {
        Link& link = links_[ingress];
        std::vector<std::uint32_t> others;
        for (const auto& [id, other] : links_)
            if (id != ingress && is_fresh(id, system, -1) && !is_same_place(link, other)) others.push_back(id);
        if (others.empty()) return true;
        const auto is_verified = [&](std::uint32_t id) { return links_[id].policy.is_verified; };
        if (link.policy.is_verified) {
            for (Heard& h : heard_)
                if (h.system == system && in(others, h.link) && !is_verified(h.link)) h.known = false;
            return true;
        }
        if (std::ranges::any_of(others, is_verified)) return false;
        if (system == 255 || is_alive({ingress}, system) || !is_alive(others, system)) return true;
        const bool is_old = now_ - claim(link, system).since >= std::chrono::seconds{5};
        return (is_old && !link.policy.learns_first) || is_fresh(ingress, system, component);
    }
    // A vehicle whose link goes away keeps its place: for 2 s after it was heard last, or on a verified link until the
    // route would have timed out.
    void note_departure(std::uint32_t id, const ModelPolicy& policy) {
        for (const Heard& h : heard_) {
            if (h.link != id || !h.known || !(policy.is_verified || has_settled(id, h.system))) continue;
            const MonoTime until = h.last() + (policy.is_verified ? options_.route_timeout : std::chrono::seconds{2});
            const auto known = departed_.find(h.system);
            const bool is_kept = known != departed_.end() && known->second.until > now_;
            const bool is_same = is_kept && leads_to(policy, known->second.policy);
            if (until <= now_ || (is_kept && !is_same && !policy.is_verified)) continue;
            departed_[h.system] = {policy, is_same ? std::max(until, known->second.until) : until};
        }
    }
    [[nodiscard]] bool has_settled(std::uint32_t link, std::uint8_t system) const {
        return is_alive({link}, system) && std::ranges::any_of(heard_, [&](const Heard& h) {
                   return h.link == link && h.system == system && h.component == 1 &&
                          now_ - h.since >= std::chrono::seconds{5};
               });
    }
    static bool leads_to(const ModelPolicy& link, const ModelPolicy& departed) {
        return link.address == departed.address || is_same_place({link}, {departed});
    }
    bool may_return(std::uint32_t ingress, std::uint8_t system, std::uint8_t component) {
        const auto known = departed_.find(system);
        if (known == departed_.end() || known->second.until <= now_) return true;
        Link& link = links_[ingress];
        if (link.policy.is_verified || leads_to(link.policy, known->second.policy)) {
            departed_.erase(known);
            return true;
        }
        if (system == 255) return true;
        const bool is_old = now_ - claim(link, system).since >= std::chrono::seconds{5};
        if (known->second.policy.is_verified) return false;
        return (is_old && !link.policy.learns_first) || is_fresh(ingress, system, component);
    }
    // Whether the autopilot was heard on one of the links in the last 2 s. Its echoes count as well, if the link sends
    // back no other system.
    [[nodiscard]] bool is_alive(const std::vector<std::uint32_t>& links, std::uint8_t system) const {
        return std::ranges::any_of(heard_, [&](const Heard& h) {
            return h.known && !h.only_echoes && in(links, h.link) && h.system == system && h.component == 1 &&
                   now_ - (returns_others(h.link, system) ? h.time : h.last()) < std::chrono::seconds{2};
        });
    }
    [[nodiscard]] bool returns_others(std::uint32_t link, std::uint8_t system) const {
        return std::ranges::any_of(links_.at(link).returned, [&](auto other) { return other != system; });
    }
    Claim claim(Link& link, std::uint8_t system) const {
        Claim& claim = link.claims.try_emplace(system, Claim{now_, now_}).first->second;
        if (now_ - claim.last >= std::chrono::seconds{2}) claim.since = now_;
        claim.last = now_;
        return claim;
    }

    // Since when the source is on the link, if it was heard there twice at least half a second apart, and in the last
    // 3 s.
    [[nodiscard]] std::optional<MonoTime> present_since(std::uint32_t link, const wire::FrameView& frame) const {
        for (const Heard& h : heard_)
            if (h.known && !h.only_echoes && h.link == link && h.system == frame.system().value &&
                h.component == frame.component().value && h.time - h.since >= std::chrono::milliseconds{500} &&
                now_ - h.time < std::chrono::seconds{3})
                return h.since;
        return std::nullopt;
    }

    bool is_origin(std::uint32_t link, std::uint32_t ingress, const wire::FrameView& frame, bool is_directed) {
        const auto since = present_since(link, frame), here = present_since(ingress, frame);
        if (!since || !here) return since.has_value();
        if (is_directed) return false;
        if (*here >= *since) return true;
        if (links_[link].policy.learns_first) return false;
        return now_ - *since >= std::chrono::seconds{5};
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
        bool broadcast = system == 0;
        if (!broadcast) {
            if (options_.own == Source{SystemId{system}, ComponentId{component}}) return Verdict::consumed;
            if (options_.unknown_target == UnknownTarget::flood && links_[ingress].policy.is_verified &&
                std::ranges::none_of(links_, [&](const auto& l) {
                    return l.second.policy.is_verified && is_fresh(l.first, system, -1);
                })) {
                broadcast = true;
            } else if (!is_fresh_anywhere(system, -1)) {
                if (options_.unknown_target == UnknownTarget::drop) return Verdict::unknown_target;
                broadcast = true;
            } else if (component != 0 && !exact && options_.unknown_component == UnknownComponent::drop) {
                return Verdict::unknown_target;
            }
        }
        for (auto& [id, link] : links_) {
            const auto& policy = link.policy;
            if (policy.tap) continue;
            const bool has_target = !broadcast && is_fresh(id, system, exact ? component : -1);
            if (policy.is_private && !(exact && has_target)) why[id] = Reason::private_link;
            else if (!broadcast && !has_target) why[id] = Reason::other_target;
            else if (policy.group != 0 && policy.group == links_[ingress].policy.group) why[id] = Reason::same_group;
            else if (is_origin(id, ingress, frame, !broadcast)) why[id] = Reason::source_here;
            else why[id] = Reason::sent;
            if (id == ingress) why[id] = Reason::ingress;
        }
        return narrow(frame, why, have_it, sent_it);
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
        if (std::ranges::any_of(alive, [&](auto id) { return links_[id].policy.is_verified; }))
            std::erase_if(alive, [&](auto id) { return !links_[id].policy.is_verified; });
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
            if (id != chosen && !are_peers(links_[id], links_[chosen])) why[id] = Reason::other_member;
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
            is_verified_};
        const auto due = link.due.find(key);
        // Early by less than half an interval, at least 50 ms and at most 0.5 s, passes (docs/guide/queues.md).
        const Nanoseconds grace = interval ? std::clamp<Nanoseconds>(*interval / 2, std::chrono::milliseconds{50},
                                                                     std::chrono::milliseconds{500})
                                           : Nanoseconds{};
        if (interval && due != link.due.end() && due->second - now_ >= grace) return Reason::rate_limited;
        if (link.policy.bytes_per_s) {
            const auto rate = static_cast<double>(*link.policy.bytes_per_s);
            for (double* tokens : {&link.tokens, &link.verified_tokens})
                if (link.filled)
                    *tokens = std::min(*tokens + std::chrono::duration<double>(now_ - *link.filled).count() * rate,
                                       std::max(rate / 4, 560.0));
            link.filled = now_;
            const auto size = static_cast<double>(frame.size());
            const double left = is_verified_ ? link.verified_tokens : link.tokens;
            if (!is_essential(frame.id().value) && left < size) return Reason::bytes_limited;
            link.tokens = std::max(link.tokens - size, -rate);
            if (is_verified_) link.verified_tokens = std::max(link.verified_tokens - size, -rate);
        }
        if (interval) {
            const bool in_step = due != link.due.end() &&
                                 now_ - due->second < std::max<Nanoseconds>(*interval, std::chrono::milliseconds{100});
            link.due[key] = (in_step ? due->second : now_) + *interval;
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
    bool is_verified_ = false, is_repeated_ = false;  // the frame being routed
    std::map<std::uint32_t, Link> links_;
    std::map<std::uint32_t, GroupMode> group_modes_;  // the first link of a group decides
    std::map<std::uint32_t, std::uint32_t> current_;  // of a `best` group
    std::map<std::uint8_t, Departed> departed_;       // by system
    std::vector<Heard> heard_;
    std::vector<Recent> recent_;
    std::vector<Recent> beats_;  // HEARTBEATs of groups
};

}  // namespace mavloom::route::test
