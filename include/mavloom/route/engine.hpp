// SPDX-License-Identifier: MIT
// Decides where a frame goes: a frame and the link it came on in, a set of links out. Learns which system and component is behind which link,
// knows groups of redundant links, filters, rate limits, copies and echoes. It opens nothing, sends nothing and reads no clock.
//
// One owner thread; the counters' values may be read from any. Allocates when it is made and when links or options change, never for a
// frame; memory is bounded whatever is sent (the constants of Engine). routing.md section 5, DESIGN.md section 4, docs/guide/routing.md.
#pragma once

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
#include "mavloom/dialect/rates.hpp"
#include "mavloom/route/choices.hpp"
#include "mavloom/route/filter.hpp"
#include "mavloom/wire/frame.hpp"
#include "mavloom/wire/message_table.hpp"

namespace mavloom::route {

using GroupId = Id<struct GroupTag, std::uint32_t>;  // 0: no group

struct Options {
    Nanoseconds dedup{};  // a frame heard again within this time, on whatever link, is dropped; 0: off
    UnknownComponent unknown_component =
        UnknownComponent::system;  // the system is known, the component is not: to the system's links
    UnknownTarget unknown_target = UnknownTarget::drop;
    Nanoseconds route_timeout = std::chrono::seconds{60};
    std::optional<Source> own{};           // the program's own id: what is targeted at exactly it is for the program
    std::size_t recent_frames = 1u << 16;  // remembered for copies and echoes; rounded up to a power of two
    std::uint64_t seed = 0;  // a random number keeps a hostile sender from making frames that look like another's copies
};

struct LinkPolicy {
    Filter in{}, out{};
    GroupId group{};
    GroupMode group_mode = GroupMode::all;  // the group's first link decides
    std::uint32_t group_order = 0;          // `primary`: the lowest first; equal ones in the order of adding
    bool tap = false;                       // gets every good frame, whatever its verdict; contributes nothing
    bool is_private = false;  // nothing from it is forwarded; gets only what is targeted at exactly a pair heard on it
    dialect::Rates max_rate{};
    std::optional<std::uint64_t> max_bytes_per_s{};
    std::optional<Nanoseconds> route_timeout{};  // instead of the router's: for links of high latency
};

struct GroupOrder {
    LinkId link;
    std::uint32_t order = 0;  // as LinkPolicy::group_order
};

enum class Verdict : std::uint8_t {
    forwarded,
    nowhere,         // there is no other link for it: alone, or its target is where it came from
    filtered,        // by the input filter, or by the output filters of all links it could go to
    rate_limited,    // max_rate or max_bytes of all links it could go to
    duplicate,       // heard before on another link of the group or within `dedup`, or already sent to all
    echo,            // came back on a link that it was sent to
    unknown_target,  // targeted at a system or component that is not known
    consumed,        // targeted at the program's own id
    tap,             // came from a tap
    private_link,    // came from a private link
    unknown_link,    // the engine does not have the link that it came on
};
[[nodiscard]] std::string_view verdict_name(Verdict verdict) noexcept;

struct Decision {
    Verdict verdict = Verdict::nowhere;
    // Where to send the frame; valid until the next call. Taps are among them whatever the verdict is.
    std::span<const LinkId> links{};
};

// Why one link gets a frame or not.
enum class Reason : std::uint8_t {
    sent,
    tap,            // gets everything
    dropped,        // the frame went to nobody, see the verdict
    ingress,        // it came from there
    same_group,     // it came from another link of the same group
    source_here,    // its own sender was heard on this link
    other_target,   // its target was not heard on this link
    private_link,   // private, and the frame not for exactly a pair that was heard there
    filtered,       // by the link's output filter
    other_member,   // another link of the group carries it
    already_sent,   // another link brought the same bytes a moment ago, and they were sent there then
    rate_limited,   // max_rate
    bytes_limited,  // max_bytes
};
// A sentence part for people: "its own sender was heard on this link".
[[nodiscard]] std::string_view reason_text(Reason reason) noexcept;

struct Explanation {
    LinkId link;
    Reason reason = Reason::sent;
};

// Of frames that came in on one link: frames = the sum of the verdicts. The last three are of frames that did not go out on it.
struct LinkCounters {
    Counter frames;
    Counter forwarded, nowhere, filtered, rate_limited, duplicate, echo, unknown_target, consumed, tap, private_link;
    Counter out_filtered, out_rate_limited, out_bytes_limited;
};

struct EngineCounters {
    Counter unknown_link;
    Counter routes_learned;  // new or learned again
    Counter routes_expired;
    Counter routes_evicted;  // the stalest of a link, or of the busiest link, for a new one: a table was full
    Counter recent_evicted;  // remembered frames that gave way before their time: an echo of them is not known
    Counter reboots;         // of a system: note_reboot
    Counter duplicate_ids;   // sources heard in turn on links that are not of one group
};

struct RouteInfo {
    LinkId link;
    Source source;
    Nanoseconds age{};         // since it was last heard
    std::uint64_t frames = 0;  // that taught it; a reboot does not reset it
};

// One system and component heard in turn on two links that are not of one group: two senders of one id, or redundant links without `group`.
struct DuplicateId {
    Source source;
    LinkId first, second;
};

struct UnknownTargetInfo {
    Source target;
    std::uint64_t frames = 0;
};

class Engine {
public:
    static constexpr std::size_t max_links = 4096;
    static constexpr std::size_t max_routes = 1u << 16;
    static constexpr std::size_t max_routes_per_link = 2048;  // 250 systems of 5 components are 1,250
    static constexpr std::size_t max_duplicate_ids = 256;
    // How long a frame is remembered where it was sent to, for echoes and for copies within a group (longer if `dedup` is).
    static constexpr Nanoseconds echo_window = std::chrono::seconds{2};
    // A link of a group that was not heard for this long is silent: `best` and `primary` choose another.
    static constexpr Nanoseconds member_silence = std::chrono::seconds{3};
    // `best` leaves its link for another only if that heard so many more HEARTBEATs of the last 128 to 256: 2 % to 4 %.
    // With few vehicles that is more than are under way at one time on links of unequal delay. With a fleet it need not be: of 20 a second, over
    // links 0.7 s apart, 14 are, and those may count as lost.
    static constexpr std::uint32_t better_by_beats = 5;
    static constexpr std::uint32_t most_beats = 256;  // then all links of the group go on with half of theirs
    // A HEARTBEAT that its link brings twice within this time of its first copy is a datagram that was doubled, and counts once.
    static constexpr Nanoseconds doubled_within = std::chrono::milliseconds{500};

    // `table` must outlive the engine.
    Engine(const wire::MessageTable& table, const Options& options);
    Engine(Engine&&) noexcept;
    Engine& operator=(Engine&&) noexcept;
    ~Engine();

    // False when there are max_links, or the id is there already or 0.
    bool add_link(LinkId link, const LinkPolicy& policy);
    // Forgets the link and its routes. Nothing happens for an id that is not there.
    void remove_link(LinkId link);
    [[nodiscard]] std::size_t links() const noexcept;
    // Other rules for the same links: routes, counters and what was heard lately stay. `seed` and `recent_frames` are those of the beginning.
    void set_options(const Options& options);
    // Instead of the group_order that their policies gave. Nothing happens for an id that is not there.
    void set_group_orders(std::span<const GroupOrder> orders);

    // What `route` knows the frame's bytes by. Who calls this first, and something else before `route`, has their place among the frames of the
    // last moments fetched from memory meanwhile. The mark holds until links or options change.
    [[nodiscard]] std::uint64_t mark_of(const wire::FrameView& frame) const noexcept;
    // Where the frame goes. `info` is null for an id without definition. `now` never goes back. At most a few tens of nanoseconds.
    [[nodiscard]] Decision route(const wire::FrameView& frame, std::uint64_t mark, const wire::MessageInfo* info,
                                 LinkId ingress, MonoTime now) noexcept;
    [[nodiscard]] Decision route(const wire::FrameView& frame, const wire::MessageInfo* info, LinkId ingress,
                                 MonoTime now) noexcept {
        return route(frame, mark_of(frame), info, ingress, now);
    }
    // The same with the table's own look-up.
    [[nodiscard]] Decision route(const wire::FrameView& frame, LinkId ingress, MonoTime now) noexcept;
    // The same, and writes into `why` the reason for every link, by rising id. Allocates.
    Decision explain(const wire::FrameView& frame, const wire::MessageInfo* info, LinkId ingress, MonoTime now,
                     std::vector<Explanation>& why);

    // The program itself sent this frame to the link: if it comes back, it is an echo.
    void note_sent(const wire::FrameView& frame, LinkId link, MonoTime now) noexcept;

    // A frame of this source, which was routed already, showed that its system has started again (wire::SequenceTracker finds that out): forgets
    // the system's routes, but for this one. Nothing happens where another link reported a restart of the system in the last 10 s: it is the same one.
    void note_reboot(LinkId link, Source source, MonoTime now) noexcept;

    // Learned routes that are not too old, by system, component and link. Allocates.
    [[nodiscard]] std::vector<RouteInfo> routes(MonoTime now) const;
    // In the order in which they were noticed; `counters().duplicate_ids` tells when there is a new one.
    [[nodiscard]] std::span<const DuplicateId> duplicate_ids() const noexcept;
    // Targets of which frames were dropped as unknown_target, by system and component. Allocates.
    [[nodiscard]] std::vector<UnknownTargetInfo> unknown_targets() const;

    [[nodiscard]] const EngineCounters& counters() const noexcept;
    // Null for a link that is not there; stays where it is until the link is removed.
    [[nodiscard]] const LinkCounters* counters(LinkId link) const noexcept;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mavloom::route
