// SPDX-License-Identifier: MIT
// The implementation of Engine: its state, and the steps that decide where a frame goes. Private to module route.
#pragma once

#include <array>
#include <deque>
#include <memory>
#include <vector>

#include "mavloom/route/engine.hpp"
#include "route/egress_limiter.hpp"
#include "route/link_set.hpp"
#include "route/recent_frames.hpp"
#include "route/route_table.hpp"
#include "route/trust.hpp"
#include "route/zeroed_array.hpp"

namespace mavloom::route {

class Engine::Impl {
public:
    Impl(const wire::MessageTable& table, const Options& options);

    bool add_link(LinkId id, const LinkPolicy& policy, const LinkCounters& counts);
    void remove_link(LinkId id);
    void close_link(LinkId id);
    void close_endpoint(std::uint32_t endpoint);
    void set_options(const Options& given);
    void set_group_orders(std::span<const GroupOrder> orders);
    [[nodiscard]] std::uint64_t mark_of(const wire::FrameView& frame) const noexcept;
    [[nodiscard]] Decision route(const wire::FrameView& frame, std::uint64_t hash, const wire::MessageInfo* info,
                                 LinkId ingress, MonoTime now, bool is_repeated) noexcept;
    Decision explain(const wire::FrameView& frame, const wire::MessageInfo* info, LinkId ingress, MonoTime now,
                     std::vector<Explanation>& why, bool is_repeated);
    void note_reboot(LinkId link, Source source, MonoTime now) noexcept;
    void note_sent(const wire::FrameView& frame, LinkId link, MonoTime now) noexcept;
    [[nodiscard]] std::vector<RouteInfo> routes(MonoTime now) const;
    [[nodiscard]] std::vector<RouteInfo> routes(LinkId link, MonoTime now) const;
    [[nodiscard]] std::vector<UnknownTargetInfo> unknown_targets(std::size_t first, std::size_t last) const;

    [[nodiscard]] Slot slot_of(LinkId id) const noexcept;

    struct Link {
        LinkId id;
        LinkPolicy policy;
        Claimant claimant;
        EgressLimiter limiter;
        std::uint32_t group = no_group;  // index into groups_
        std::uint32_t peers = no_peers;  // index into peers_
        bool filters_in = false;
        bool heard = false;
        MonoTime last_heard{};
        std::uint32_t beats = 0;  // HEARTBEATs received, for `best`; see count_beats
        LinkCounters counters{};
        // A cache of the last long list of links to which frames from this link were sent.
        std::uint64_t listed_at = 0;  // links_version_ at that time; 0 if there is no list
        std::size_t listed = 0;       // length
        std::vector<std::uint64_t> listed_set{};
        std::vector<LinkId> list{};
    };

    const wire::MessageTable& table;
    Options options;
    EngineCounters counters{};
    std::vector<std::unique_ptr<Link>> links;  // by slot; null if the slot is free
    std::size_t link_count = 0;
    std::vector<DuplicateId> duplicates;
    std::vector<RouteConflict> conflicts;

private:
    static constexpr std::uint32_t no_group = ~std::uint32_t{0}, no_peers = ~std::uint32_t{0};
    // At most this many free slots rest; see left_at_.
    static constexpr std::size_t max_resting = 64;
    static constexpr std::size_t worth_a_list = 8;
    static constexpr std::size_t max_listed = 1024;  // with more links, the lists would take too much memory
    // Within this time, a restart reported by another link of the vehicle counts as the same restart.
    static constexpr std::chrono::seconds one_reboot{10};
    // A source heard on A, B, A, B counts as two senders. A sender that merely moves between links does not alternate
    // like that within the timeout.
    static constexpr std::uint8_t duplicate_alternations = 4;

    struct Group {
        GroupId id;
        GroupMode mode = GroupMode::all;
        std::vector<std::uint64_t> members;
        std::vector<Slot> order;  // in the order that `primary` prefers
        Slot current = no_slot;   // the link that `best` uses
    };
    // The links of one endpoint in a group.
    struct Peers {
        GroupId group;
        std::uint32_t endpoint;
        std::vector<std::uint64_t> links;
    };
    struct OutFilter {
        dialect::Filter filter;
        std::vector<std::uint64_t> links;  // the set of links with this filter
    };
    struct Alternation {
        LinkId last;  // 0 if there is none
        std::uint8_t count;
        bool is_reported;
    };
    // A frame on its way through the engine.
    struct Passage {
        const wire::FrameView& frame;
        std::uint64_t hash;  // of the frame's bytes; 0 if the engine remembers no frames
        const wire::MessageInfo* info;
        MessageId id;
        Pair source;
        Slot slot;
        Link& link;
        MonoTime now;
        bool is_repeated = false;  // a signed frame that another endpoint has heard before
        bool is_remembered = false;
        bool is_directed = false;  // goes to the links of its target
        bool is_copy = false;      // copy of a frame that arrived earlier on another link
        std::size_t recent = 0;    // index in recent_
    };

    [[nodiscard]] std::span<const LinkId> list_candidates(Link& from) noexcept;
    [[nodiscard]] Verdict judge(Passage& p) noexcept;
    [[nodiscard]] bool is_heard_before(Passage& p, Verdict& verdict) noexcept;
    // Whether a link of this link's group delivered the frame.
    [[nodiscard]] bool came_by_group(const Passage& p) noexcept;
    void remember(Passage& p, bool found) noexcept;
    void learn(Passage& p) noexcept;
    [[nodiscard]] bool is_second_hand(const Passage& p) noexcept;
    // Whether the frame's route may be learned.
    [[nodiscard]] bool is_believed(const Passage& p) noexcept;
    void report_conflict(const RouteConflict& conflict) noexcept;
    void end_lower_routes(const Passage& p) noexcept;
    [[nodiscard]] bool is_origin(Slot slot, const Passage& p) const noexcept;
    // Whether an earlier copy of the frame may make this one a duplicate.
    [[nodiscard]] bool counts_as_heard(const Passage& p) noexcept;
    void count_beats(const Passage& p) noexcept;
    // Whether the link already delivered this HEARTBEAT within doubled_within.
    [[nodiscard]] bool is_doubled(const Passage& p) noexcept;
    // Whether the frame's source was heard on at least two links of the group.
    [[nodiscard]] bool is_on_two_members(const Passage& p) const noexcept;
    void watch_for_duplicate_ids(const Passage& p) noexcept;
    [[nodiscard]] Verdict choose_by_target(Passage& p) noexcept;
    [[nodiscard]] Verdict to_everybody() noexcept;
    [[nodiscard]] bool choose_links_of(Source target) noexcept;
    void add_higher_ranks(ConstWords of_system) noexcept;
    void add_equals(Rank rank, bool is_reached) noexcept;
    [[nodiscard]] bool is_known_to_equals(SystemId system, Rank rank) const noexcept;
    // The links of this rank, which is not `stranger`, and above.
    [[nodiscard]] ConstWords at_least(Rank rank) const noexcept {
        return (rank == Rank::verified ? verified_ : trusted_).data();
    }
    void explain_target() noexcept;
    void leave_out_origin(const Passage& p) noexcept;
    void apply_filters(const Passage& p) noexcept;
    void apply_groups(const Passage& p) noexcept;
    [[nodiscard]] Slot choose_member(Group& group, Words candidates, MonoTime now) noexcept;
    // Whether `choose_member` takes `a` rather than `b`, which comes first in the group's order.
    [[nodiscard]] static bool is_better(const Link& a, const Link& b, GroupMode mode) noexcept;
    // One word of the set of links that the engine trusts to lead to the same place as this link; see Claimant.
    [[nodiscard]] std::uint64_t same_place(const Link& link, std::size_t w) const noexcept {
        if (link.group == no_group) return 0;
        const std::uint64_t members = groups_[link.group].members[w];
        if (link.peers == no_peers || link.policy.rank == Rank::verified) return members;
        return members & ~(peers_[link.peers].links[w] & ~verified_[w]);
    }
    [[nodiscard]] bool is_alive(const Link& link, MonoTime now) const noexcept;
    void apply_limits(const Passage& p) noexcept;
    [[nodiscard]] EgressLimiter::Answer limit(Link& link, const Passage& p) noexcept;
    void add_taps(const Passage& p) noexcept;
    void count(LinkCounters& of, Verdict verdict) noexcept;
    void count_routes(const RouteTable::Change& change) noexcept;
    // Removes the links of `set` from the candidates.
    void leave_out(ConstWords set, Reason reason) noexcept;
    void note(Slot slot, Reason reason) noexcept {
        if (reasons_ != nullptr) [[unlikely]]
            (*reasons_)[slot] = reason;
    }

    [[nodiscard]] Slot free_slot();
    void index_links();
    [[nodiscard]] std::size_t home(Slot slot) const noexcept { return ids_[slot].value & (index_.size() - 1); }
    void add_to_index(Slot slot);
    void remove_from_index(Slot slot) noexcept;
    void rebuild();
    void note_links_changed();
    void empty_groups();
    void enlist(Slot slot);
    void delist(Slot slot);
    [[nodiscard]] bool has_empty_group() const noexcept;
    void grow(std::size_t slots);
    [[nodiscard]] std::uint32_t group_index(const Link& link);
    [[nodiscard]] std::uint32_t peers_index(const Link& link);

    Nanoseconds window_;  // how long a frame is remembered
    std::size_t words_ = 1;
    std::vector<Slot> index_;  // open addressing by link id
    std::vector<LinkId> ids_;  // by slot
    // When a link left the slot. Until `window_` later, remembered frames may hold the slot's bit, so the slot rests:
    // no new link gets it.
    std::vector<MonoTime> left_at_;  // by slot
    std::deque<Slot> resting_;       // the slots without a link, in the order in which they were left
    std::uint64_t links_version_ = 1;
    RouteTable routes_;
    Trust trust_;
    RecentFrames recent_;
    // Sets of links. `trusted_`: own and verified.
    std::vector<std::uint64_t> ordinary_, taps_, private_, limited_, verified_, trusted_;
    std::vector<Group> groups_;
    std::vector<Peers> peers_;  // those without links are used again
    bool has_taps_ = false, has_private_ = false, has_limits_ = false;
    bool chooses_members_ = false;  // some group of at least two links is `best` or `primary`
    std::vector<OutFilter> filters_;
    ZeroedArray<Alternation> alternations_;  // by pair
    ZeroedArray<std::uint32_t> unknown_;     // frames dropped, by pair
    std::vector<std::uint64_t> candidates_, scratch_;
    std::vector<LinkId> out_;
    MonoTime now_{};
    struct Reboot {
        LinkId link{};
        MonoTime when{};
    };
    std::array<Reboot, 256> last_reboots_{};  // by system
    std::vector<Reason>* reasons_ = nullptr;  // by slot, while explaining
};

}  // namespace mavloom::route
