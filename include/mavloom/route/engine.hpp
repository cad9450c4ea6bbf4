// SPDX-License-Identifier: MIT
// The routing engine decides which links a frame is sent to, given the frame and the link on which it arrived.
// It learns which systems and components are behind each link. It handles groups of redundant links, filters, rate
// limits, copies and echoes. It opens nothing, sends nothing and reads no clock. Rules: docs/guide/routing.md.
//
// One thread owns an engine; any thread may read the counters. The engine allocates at construction and when links or
// options change, never for a frame. Its memory is bounded, no matter what arrives: see the constants of Engine.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/counter.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/base/rank.hpp"
#include "mavloom/dialect/filter.hpp"
#include "mavloom/dialect/rates.hpp"
#include "mavloom/route/choices.hpp"
#include "mavloom/wire/frame.hpp"
#include "mavloom/wire/message_table.hpp"

namespace mavloom::route {

using GroupId = Id<struct GroupTag, std::uint32_t>;  // 0 means no group

struct Options {
    Nanoseconds dedup{};  // drops a frame that arrives again on any link within this time; 0 turns this off
    UnknownComponent unknown_component = UnknownComponent::system;
    UnknownTarget unknown_target = UnknownTarget::drop;
    Nanoseconds route_timeout = std::chrono::seconds{60};
    std::optional<Source> own{};  // the program's own id; frames targeted at exactly this id are not forwarded
    // How many frames to remember, to detect copies and echoes. The number is rounded up to a power of two. Their table
    // takes at most 8 MiB.
    std::size_t recent_frames = 1u << 16;
    // Seeds the frame hash. With a random seed, a hostile sender cannot forge frames that the engine would take for
    // copies of other frames.
    std::uint64_t seed = 0;
};

struct LinkPolicy {
    dialect::Filter in{}, out{};
    GroupId group{};
    GroupMode group_mode = GroupMode::all;  // the first link of a group sets the mode of the group
    std::uint32_t group_order = 0;          // `primary` prefers the lowest; ties go to the lowest link id
    // Links with the same number are peers of one endpoint. Any sender may become such a peer, so the engine does not
    // assume that unverified ones lead to the same place, even within a group. 0: the only link of its endpoint.
    std::uint32_t endpoint = 0;
    // A tap gets every good frame from the other links, whatever its verdict. Frames from a tap go nowhere.
    bool tap = false;
    // Frames from a private link go to taps only. A private link gets only frames whose target system and component
    // were both heard on it.
    bool is_private = false;
    Rank rank = Rank::own;
    // For a stranger: a vehicle that another stranger has is not learned here until it falls silent there.
    bool learns_first = false;
    dialect::Rates max_rate{};
    std::optional<std::uint64_t> max_bytes_per_s{};
};

struct GroupOrder {
    LinkId link;
    std::uint32_t order = 0;  // see LinkPolicy::group_order
};

enum class Verdict : std::uint8_t {
    forwarded,
    nowhere,         // no other link qualifies, for example if the target is on the link where the frame arrived
    filtered,        // dropped by the input filter, or by the output filter of every candidate link
    rate_limited,    // dropped by max_rate or max_bytes of every candidate link
    duplicate,       // already received in the group or within `dedup`, or a copy that no further link should get
    echo,            // returned on a link that it had been sent to
    unknown_target,  // targeted at an unknown system or component
    consumed,        // targeted at the program's own id
    tap,             // arrived on a tap
    private_link,    // arrived on a private link
    unknown_link,    // arrived on a link that the engine does not have
};
[[nodiscard]] std::string_view verdict_name(Verdict verdict) noexcept;

struct Decision {
    Verdict verdict = Verdict::nowhere;
    // The links to send the frame to; valid until the next call. Includes the taps, unless the frame arrived on a tap
    // or on an unknown link.
    std::span<const LinkId> links{};
};

// Why one link did or did not get a frame.
enum class Reason : std::uint8_t {
    sent,
    tap,            // sent: a tap gets every frame
    dropped,        // the frame went to no link; the verdict is the reason
    ingress,        // the frame arrived on this link
    same_group,     // the frame arrived on another link of the same group
    source_here,    // the frame's sender was heard on this link
    other_target,   // the frame's target was not heard on this link
    private_link,   // a private link on which the exact target (system and component) was not heard
    filtered,       // by the link's output filter
    other_member,   // another link of the group carries the frame
    already_sent,   // the frame arrived earlier on another link and was already sent to this one
    rate_limited,   // by the link's max_rate
    bytes_limited,  // by the link's max_bytes
};
// A phrase for people, for example "its own sender was heard on this link".
[[nodiscard]] std::string_view reason_text(Reason reason) noexcept;

struct Explanation {
    LinkId link;
    Reason reason = Reason::sent;
};

// Counts of one link. `frames` counts the frames that arrived on the link; it is the sum of the verdict counters. The
// three `out_` counters count frames that were not sent to the link because of its output filter or limits.
struct LinkCounters {
    Counter frames;
    Counter forwarded, nowhere, filtered, rate_limited, duplicate, echo, unknown_target, consumed, tap, private_link;
    Counter out_filtered, out_rate_limited, out_bytes_limited;
};

inline constexpr std::array<CounterRow<LinkCounters>, 13> link_verdicts{{
    {"forwarded", "frames that were sent to at least one other link", &LinkCounters::forwarded},
    {"nowhere", "frames that no other link was to get", &LinkCounters::nowhere},
    {"filtered", "frames that in_ filters dropped", &LinkCounters::filtered},
    {"rate_limited", "frames over a rate limit", &LinkCounters::rate_limited},
    {"duplicate", "frames that had arrived before", &LinkCounters::duplicate},
    {"echo", "frames that came back on a link they were sent to", &LinkCounters::echo},
    {"unknown_target", "frames for a target that was not heard on any link", &LinkCounters::unknown_target},
    {"consumed", "frames that were for the program itself", &LinkCounters::consumed},
    {"tap", "frames that a tap sent", &LinkCounters::tap},
    {"private_link", "frames that a private link sent", &LinkCounters::private_link},
    {"out_filtered", "frames that out_ filters kept from this link", &LinkCounters::out_filtered},
    {"out_rate_limited", "frames that max_rate kept from this link", &LinkCounters::out_rate_limited},
    {"out_bytes_limited", "frames that max_bytes kept from this link", &LinkCounters::out_bytes_limited},
}};
static_assert(sizeof(LinkCounters) == (link_verdicts.size() + 1) * sizeof(Counter), "each counter needs a row");

struct EngineCounters {
    Counter unknown_link;
    Counter routes_learned;  // new, or learned again after they were forgotten
    Counter routes_expired;
    Counter routes_evicted;   // the stalest route of a full link; if the table is full, of the link with most routes
    Counter recent_evicted;   // remembered frames evicted too early, so that their echoes go undetected
    Counter reboots;          // restarts of a system, see note_reboot
    Counter route_conflicts;  // vehicles that a stranger's link claimed for 5 s while another link had them
    Counter duplicate_ids;    // sources heard alternately on links that do not share a group
};

inline constexpr std::array<CounterRow<EngineCounters>, 8> engine_counters{{
    {"unknown_link", "frames that arrived on links beyond the limit", &EngineCounters::unknown_link},
    {"routes_learned", "routes that are new, or new again", &EngineCounters::routes_learned},
    {"routes_expired", "routes that were silent for route_timeout", &EngineCounters::routes_expired},
    {"routes_evicted", "routes that were evicted because a table was full", &EngineCounters::routes_evicted},
    {"recent_evicted", "remembered frames that were evicted early", &EngineCounters::recent_evicted},
    {"reboots", "systems whose clock went back", &EngineCounters::reboots},
    {"duplicate_ids", "sources heard alternately on links that do not share a group", &EngineCounters::duplicate_ids},
    {"route_conflicts", "vehicles that a stranger's link claimed for 5 s while another link had them",
     &EngineCounters::route_conflicts},
}};
static_assert(sizeof(EngineCounters) == engine_counters.size() * sizeof(Counter), "each counter needs a row");

struct RouteInfo {
    LinkId link;
    Source source;
    Nanoseconds age{};         // since the last frame
    std::uint64_t frames = 0;  // received from the source on this link; a reboot does not reset it
};

// One system and component that is heard alternately on two links that do not share a group. Either two senders use
// one id, or the links are redundant and lack `group`.
struct DuplicateId {
    Source source;
    LinkId first, second;
};

// A vehicle that a stranger's link, the second, claimed for 5 s while the first had it: redundant links without
// `group`, a sender that claims to be the vehicle, or a link that the user has not declared as trusted.
struct RouteConflict {
    SystemId system;
    LinkId first, second;
    bool is_believed = false;  // the vehicle was learned on the second link
    friend bool operator==(const RouteConflict&, const RouteConflict&) = default;
};

struct UnknownTargetInfo {
    Source target;
    std::uint64_t frames = 0;
};

class Engine {
public:
    static constexpr std::size_t max_links = 4096;
    static constexpr std::size_t max_routes = 1u << 16;
    static constexpr std::size_t max_routes_per_link = 2048;  // enough for 250 systems of 5 components: 1,250
    static constexpr std::size_t max_duplicate_ids = 256;
    static constexpr std::size_t max_route_conflicts = 256;
    // A link has a vehicle for this long after its autopilot was heard there.
    static constexpr Nanoseconds alive_for = std::chrono::seconds{2};
    // A vehicle that one stranger has is learned on the link of another only after it was heard there for this long,
    // without a gap of `alive_for`.
    static constexpr Nanoseconds consistent_for = std::chrono::seconds{5};
    // A source is present on a link for this long after it was heard there.
    static constexpr Nanoseconds present_for = std::chrono::seconds{3};
    // A source is present on a second link only after it was heard there twice, this far apart.
    static constexpr Nanoseconds repeated_after = std::chrono::milliseconds{500};
    // How long the engine detects echoes and copies of a frame. It remembers frames longer if `dedup` is longer.
    static constexpr Nanoseconds echo_window = std::chrono::seconds{2};
    // A group's link is silent after this long without a frame. `best` and `primary` then choose another link.
    static constexpr Nanoseconds member_silence = std::chrono::seconds{3};
    // `best` leaves a live link only for one that received this many more of the last 128 to 256 HEARTBEATs: 2 to 4 %.
    // The margin covers HEARTBEATs still in flight on the slower link. With few vehicles it suffices. A fleet can
    // exceed it: at 20 HEARTBEATs a second, and links whose delays differ by 0.7 s, 14 HEARTBEATs are in flight. `best`
    // may count those as lost.
    static constexpr std::uint32_t best_switch_margin = 5;
    static constexpr std::uint32_t max_heartbeats = 256;  // at this count, all links of the group halve their counts
    // A HEARTBEAT that arrives again on the same link within this time is a duplicated datagram and counts once.
    static constexpr Nanoseconds doubled_within = std::chrono::milliseconds{500};

    // `table` must outlive the engine.
    Engine(const wire::MessageTable& table, const Options& options);
    Engine(Engine&&) noexcept;
    Engine& operator=(Engine&&) noexcept;
    ~Engine();

    // Returns false if there are max_links links already, or if the id is 0 or in use. `counts`: the counters of an
    // earlier link with this id, which continue.
    bool add_link(LinkId link, const LinkPolicy& policy, const LinkCounters& counts = {});
    // Forgets the link and its routes. Ignores an unknown id. The link still has its vehicles for a moment.
    void remove_link(LinkId link);
    // Like `remove_link`, for a link that was closed on purpose: any other link may learn its vehicles at once. A link
    // that was removed before may be closed, too.
    void close_link(LinkId link);
    // For an endpoint that was closed on purpose (LinkPolicy::endpoint): the same for all links that it ever had.
    // Removes none of them.
    void close_endpoint(std::uint32_t endpoint);
    [[nodiscard]] std::size_t links() const noexcept;
    // Changes the rules. Links, routes, counters and remembered frames stay. `seed` and `recent_frames` are ignored:
    // they keep the values given to the constructor.
    void set_options(const Options& options);
    // Replaces the group_order of the policies of these links. Ignores unknown ids.
    void set_group_orders(std::span<const GroupOrder> orders);

    // Returns the hash of the frame, for `route`. Call it early: it prefetches the entry that `route` needs. The hash
    // is valid until links or options change.
    [[nodiscard]] std::uint64_t mark_of(const wire::FrameView& frame) const noexcept;
    // Decides where the frame goes and learns its route. `info` is null for a message id without definition. `now`
    // should not go backwards: an earlier time counts as the latest one seen. Takes at most a few tens of nanoseconds.
    // `is_repeated`: another link delivered this signed frame earlier, so a sender without the key may have replayed
    // it. Such a frame refreshes an existing route, but adds none.
    [[nodiscard]] Decision route(const wire::FrameView& frame, std::uint64_t mark, const wire::MessageInfo* info,
                                 LinkId ingress, MonoTime now, bool is_repeated = false) noexcept;
    [[nodiscard]] Decision route(const wire::FrameView& frame, const wire::MessageInfo* info, LinkId ingress,
                                 MonoTime now) noexcept {
        return route(frame, mark_of(frame), info, ingress, now);
    }
    // Like `route` above, but looks up `info` in the table.
    [[nodiscard]] Decision route(const wire::FrameView& frame, LinkId ingress, MonoTime now) noexcept;
    // Like `route`, but also fills `why` with the reason for every link, sorted by link id. Allocates.
    Decision explain(const wire::FrameView& frame, const wire::MessageInfo* info, LinkId ingress, MonoTime now,
                     std::vector<Explanation>& why, bool is_repeated = false);

    // Call this when the program itself sent the frame to the link. If the frame comes back, it is an echo.
    void note_sent(const wire::FrameView& frame, LinkId link, MonoTime now) noexcept;

    // Call this after `route` when a frame of `source` shows that its system restarted (see wire::SequenceTracker).
    // Forgets the system's routes on this link, except the one from `source`. Routes on other links stay, because
    // any sender can forge a restart. A restart that another link reported in the last 10 s counts once.
    void note_reboot(LinkId link, Source source, MonoTime now) noexcept;

    // The routes that have not timed out, sorted by system, component and link. Allocates.
    [[nodiscard]] std::vector<RouteInfo> routes(MonoTime now) const;
    // The same for one link, unsorted. Empty for an unknown link.
    [[nodiscard]] std::vector<RouteInfo> routes(LinkId link, MonoTime now) const;
    // The first max_duplicate_ids duplicate ids, in order of detection. `counters().duplicate_ids` counts all.
    [[nodiscard]] std::span<const DuplicateId> duplicate_ids() const noexcept;
    // The first max_route_conflicts conflicts, in order of detection. `counters().route_conflicts` counts all, also
    // those that are listed already.
    [[nodiscard]] std::span<const RouteConflict> route_conflicts() const noexcept;
    // The targets of frames dropped as unknown_target, sorted by system and component. Allocates.
    [[nodiscard]] std::vector<UnknownTargetInfo> unknown_targets() const;
    // The same for one target system.
    [[nodiscard]] std::vector<UnknownTargetInfo> unknown_targets(SystemId system) const;

    [[nodiscard]] const EngineCounters& counters() const noexcept;
    // Null for an unknown link. The pointer is valid until the link is removed.
    [[nodiscard]] const LinkCounters* counters(LinkId link) const noexcept;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mavloom::route
