// SPDX-License-Identifier: MIT
// Reserves the places of vehicles whose links went away. A vehicle that reconnects gets a new link. Until it is back,
// or has been silent for long enough, the engine does not learn it on a link that leads to another place;
// Engine::Impl::may_return has the exceptions.
//
// Private to module route; one owner thread; never allocates.
#pragma once

#include <algorithm>
#include <array>

#include "mavloom/route/engine.hpp"

namespace mavloom::route {

// Where a link leads, as far as the engine knows: see LinkPolicy and Engine::add_link.
struct Place {
    GroupId group{};
    std::uint32_t endpoint = 0;
    std::uint64_t address = 0;
    bool is_verified = false;

    // The unverified peers of one endpoint may be different senders, even in a group.
    [[nodiscard]] bool is_same(const Place& other) const noexcept {
        if (address != 0 && address == other.address) return true;
        const bool are_peers = endpoint != 0 && endpoint == other.endpoint && !is_verified && !other.is_verified;
        return group.value != 0 && group == other.group && !are_peers;
    }
};

class Departed {
public:
    // Call when the link at this place is gone. Reserves the place for the system until the time `until`.
    void note(SystemId system, const Place& place, MonoTime until, MonoTime now) noexcept {
        Vehicle& known = vehicles_[system.value];
        const bool is_same = known.until > now && known.place.is_same(place);
        const bool is_taken = known.until > now && !is_same && !place.is_verified;
        if (is_taken || until <= now) return;
        known = {place, is_same ? std::max(known.until, until) : until};
        last_until_ = std::max(last_until_, until);
    }
    // Whether a place is reserved for any vehicle.
    [[nodiscard]] bool any(MonoTime now) const noexcept { return last_until_ > now; }
    // Returns the place that is reserved for the system; null if there is none.
    [[nodiscard]] const Place* find(SystemId system, MonoTime now) const noexcept {
        const Vehicle& known = vehicles_[system.value];
        return known.until > now ? &known.place : nullptr;
    }
    void forget(SystemId system) noexcept { vehicles_[system.value] = {}; }

private:
    struct Vehicle {
        Place place{};
        MonoTime until{};
    };
    std::array<Vehicle, 256> vehicles_{};  // by system
    MonoTime last_until_{};
};

}  // namespace mavloom::route
