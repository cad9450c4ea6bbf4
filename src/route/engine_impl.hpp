// SPDX-License-Identifier: MIT
// The state of an Engine and the steps by which a frame passes it. Private to module route.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "mavloom/route/engine.hpp"
#include "route/egress_limiter.hpp"
#include "route/link_set.hpp"
#include "route/recent_frames.hpp"
#include "route/route_table.hpp"
#include "route/zeroed_array.hpp"

namespace mavloom::route {

class Engine::Impl {
public:
    Impl(const wire::MessageTable& table, const Options& options);

    bool add_link(LinkId id, const LinkPolicy& policy);
    void remove_link(LinkId id);
    void set_options(const Options& given);
    void set_group_orders(std::span<const GroupOrder> orders);
    [[nodiscard]] std::uint64_t mark_of(const wire::FrameView& frame) const noexcept;
    [[nodiscard]] Decision route(const wire::FrameView& frame, std::uint64_t hash, const wire::MessageInfo* info,
                                 LinkId ingress, MonoTime now) noexcept;
    Decision explain(const wire::FrameView& frame, const wire::MessageInfo* info, LinkId ingress, MonoTime now,
                     std::vector<Explanation>& why);
    void note_reboot(LinkId link, Source source, MonoTime now) noexcept;
    void note_sent(const wire::FrameView& frame, LinkId link, MonoTime now) noexcept;
    [[nodiscard]] std::vector<RouteInfo> routes(MonoTime now) const;
    [[nodiscard]] std::vector<UnknownTargetInfo> unknown_targets() const;

    [[nodiscard]] Slot slot_of(LinkId id) const noexcept;

    struct Link {
        LinkId id;
        LinkPolicy policy;
        EgressLimiter limiter;
        std::uint32_t group = no_group;  // index into groups
        bool filters_in = false;
        bool heard = false;
        MonoTime last_heard{};
        std::uint32_t beats = 0;  // HEARTBEATs heard, as `best` counts them
        LinkCounters counters{};
        // The last long list of where its frames went.
        std::size_t listed = 0;  // 0: none
        std::vector<std::uint64_t> listed_set{};
        std::vector<LinkId> list{};
    };

    const wire::MessageTable& table;
    Options options;
    EngineCounters counters{};
    std::vector<std::unique_ptr<Link>> links;  // by slot; null: free
    std::size_t link_count = 0;
    std::vector<DuplicateId> duplicates;

private:
    static constexpr std::uint32_t no_group = ~std::uint32_t{0};
    static constexpr std::size_t worth_a_list = 8;
    static constexpr std::size_t most_listed = 1024;  // links: with more of them the lists would take too much memory
    static constexpr std::chrono::seconds one_reboot{
        10};  // links of one vehicle that lag behind report its restart within
    static constexpr std::uint8_t turns_of_duplicates = 4;  // A, B, A, B: nobody who moves does that within the timeout

    struct Group {
        GroupId id;
        GroupMode mode = GroupMode::all;
        std::vector<std::uint64_t> members;
        std::vector<Slot> order;  // as `primary` prefers them
        Slot current = no_slot;   // of `best`
    };
    struct OutFilter {
        Filter filter;
        std::vector<std::uint64_t> links;  // that have it
    };
    struct Turns {
        LinkId last;  // 0: none
        std::uint8_t count;
        bool told;
    };
    // A frame on its way through.
    struct Passage {
        const wire::FrameView& frame;
        std::uint64_t hash;  // of its bytes; 0 where no frames are remembered
        const wire::MessageInfo* info;
        MessageId id;
        Pair source;
        Slot slot;
        Link& link;
        MonoTime now;
        bool is_remembered = false;
        bool is_copy = false;    // of a frame that another link brought
        std::size_t recent = 0;  // its place among the recent frames
    };

    [[nodiscard]] std::span<const LinkId> list_candidates(Link& from) noexcept;
    [[nodiscard]] Verdict judge(Passage& p) noexcept;
    [[nodiscard]] bool is_heard_before(Passage& p, Verdict& verdict) noexcept;
    void remember(Passage& p, bool found) noexcept;
    void learn(Passage& p) noexcept;
    void count_beats(const Passage& p) noexcept;
    // The link brought this HEARTBEAT a moment ago.
    [[nodiscard]] bool is_doubled(const Passage& p) noexcept;
    // Its source was heard on two links of the group or more.
    [[nodiscard]] bool is_on_two_members(const Passage& p) const noexcept;
    void watch_for_duplicate_ids(const Passage& p) noexcept;
    [[nodiscard]] Verdict choose_by_target(const Passage& p) noexcept;
    [[nodiscard]] Verdict to_everybody() noexcept;
    void leave_out_origin(const Passage& p) noexcept;
    void apply_filters(const Passage& p) noexcept;
    void apply_groups(const Passage& p) noexcept;
    [[nodiscard]] Slot choose_member(Group& group, Words candidates, MonoTime now) noexcept;
    [[nodiscard]] bool is_alive(const Link& link, MonoTime now) const noexcept;
    void apply_limits(const Passage& p) noexcept;
    [[nodiscard]] EgressLimiter::Answer limit(Link& link, const Passage& p) noexcept;
    void add_taps(const Passage& p) noexcept;
    void count(LinkCounters& of, Verdict verdict) noexcept;
    void count_routes(const RouteTable::Change& change) noexcept;
    // Takes the links of `set` out of the candidates.
    void leave_out(ConstWords set, Reason reason) noexcept;
    void note(Slot slot, Reason reason) noexcept {
        if (reasons_ != nullptr) [[unlikely]]
            (*reasons_)[slot] = reason;
    }

    [[nodiscard]] Nanoseconds timeout_of(const LinkPolicy& policy) const noexcept;
    void index_links();
    void rebuild();
    void grow(std::size_t slots);
    [[nodiscard]] std::uint32_t group_index(const Link& link);

    Nanoseconds window_;  // how long a frame is remembered
    std::size_t words_ = 1;
    std::vector<Slot> index_;  // open addressing by link id
    std::vector<LinkId> ids_;  // by slot
    RouteTable routes_;
    RecentFrames recent_;
    std::vector<std::uint64_t> ordinary_, taps_, private_, limited_;  // sets of links
    std::vector<Group> groups_;
    bool has_taps_ = false, has_limits_ = false;
    bool chooses_members_ = false;  // a group is `best` or `primary`
    std::vector<OutFilter> filters_;
    ZeroedArray<Turns> turns_;            // by pair
    ZeroedArray<std::uint32_t> unknown_;  // frames dropped, by pair
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
