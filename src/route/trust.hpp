// SPDX-License-Identifier: MIT
// Who is believed. Everybody is, everywhere at once, with two exceptions: the autopilot of a vehicle, and whatever a
// verified link has. This class keeps who has them, by rank, and judges claims of other links. Rules and reasons:
// docs/design/routing-rules.md, "Trust".
//
//     claim by    while verified has it   while own has it   while another stranger has it
//     verified    believed                believed           believed
//     own         refused                 believed           believed
//     stranger    refused                 refused            contested
//
// A rank has an autopilot for `alive_for` after its last frame there, and a verified link has each of its sources for
// the time-out of routes, also after the link has gone. Links of one place do not compete: see Claimant.
//
// Private to module route; one owner thread; allocates at construction only.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include "mavloom/route/engine.hpp"
#include "route/route_table.hpp"
#include "route/zeroed_array.hpp"

namespace mavloom::route {

// A link, as far as trust goes.
struct Claimant {
    LinkId link{};
    GroupId group{};
    std::uint32_t endpoint = 0;
    Rank rank = Rank::own;

    // Links of a group lead to the same place. The unverified peers of one endpoint may not: anybody may be one.
    [[nodiscard]] bool is_same_place(const Claimant& other) const noexcept {
        if (link == other.link) return true;
        const bool are_peers = endpoint != 0 && endpoint == other.endpoint && rank != Rank::verified &&
                               other.rank != Rank::verified;
        return group.value != 0 && group == other.group && !are_peers;
    }
    friend bool operator==(const Claimant&, const Claimant&) = default;
};

class Trust {
public:
    enum class Answer : std::uint8_t { believed, refused, contested };

    Trust() : verified_(RouteTable::pairs) {}

    void set_route_timeout(Nanoseconds timeout) noexcept { route_timeout_ = timeout; }

    // The autopilot of a vehicle: component 1 of any system but 255, which is a ground station by convention.
    [[nodiscard]] static bool is_autopilot(Pair pair) noexcept { return (pair & 0xff) == 1 && pair >> 8 != 255; }

    // `holder`: the link that has the source, unless the answer is `believed`. It may have
    // gone. Valid until the next change of this object.
    [[nodiscard]] Answer judge(Pair source, const Claimant& by, MonoTime now, const Claimant*& holder) const noexcept {
        const auto is_held = [&](const Holder& other, Nanoseconds time) {
            if (!has(other, time, by, now)) [[likely]]
                return false;
            holder = &other.by;
            return true;
        };
        if (by.rank < Rank::verified && has_verified_ && is_held(verified_[source], route_timeout_))
            return Answer::refused;
        if (by.rank > Rank::stranger || !is_autopilot(source)) return Answer::believed;
        if (is_held(own_[source >> 8], Engine::alive_for)) return Answer::refused;
        return is_held(strangers_[source >> 8], Engine::alive_for) ? Answer::contested : Answer::believed;
    }
    // Whether an own link has this autopilot.
    [[nodiscard]] bool own_has(Pair autopilot, MonoTime now) const noexcept {
        assert(is_autopilot(autopilot));
        return own_[autopilot >> 8].is_alive(Engine::alive_for, now);
    }
    // Call for each frame that is believed, unless it came second-hand.
    void note(Pair source, const Claimant& by, MonoTime now) noexcept {
        assert(by.link.value != 0);
        if (by.rank == Rank::verified) {
            has_verified_ = true;
            verified_[source].note(by, now);
        } else if (is_autopilot(source)) {
            (by.rank == Rank::own ? own_ : strangers_)[source >> 8].note(by, now);
        }
    }
    // For links that were closed on purpose: those for which `is_closed` returns true have no source any more. Looks at
    // all sources.
    template <class IsClosed>
    void release(IsClosed&& is_closed) noexcept {
        const auto clear = [&](Holder& holder) {
            if (is_closed(std::as_const(holder.by))) holder = {};
        };
        std::ranges::for_each(own_, clear);
        std::ranges::for_each(strangers_, clear);
        for (std::size_t i = 0; has_verified_ && i < verified_.size(); ++i) clear(verified_[i]);
    }

private:
    struct Holder {
        Claimant by{};
        MonoTime last{};  // of the last frame
        void note(const Claimant& from, MonoTime now) noexcept {
            if (by.link != from.link) by = from;
            assert(by == from && "a link keeps its rank and its place");
            last = now;
        }
        [[nodiscard]] bool is_alive(Nanoseconds time, MonoTime now) const noexcept {
            return by.link.value != 0 && now - last < time;
        }
    };
    [[nodiscard]] static bool has(const Holder& holder, Nanoseconds time, const Claimant& by, MonoTime now) noexcept {
        return holder.is_alive(time, now) && !holder.by.is_same_place(by);
    }

    std::array<Holder, 256> own_{}, strangers_{};  // by system
    ZeroedArray<Holder> verified_;                 // by pair
    bool has_verified_ = false;
    Nanoseconds route_timeout_{};
};

}  // namespace mavloom::route
