// SPDX-License-Identifier: MIT
// Ids as types: a system id cannot be passed where a component id is expected. Values as MAVLink defines them; 0 addresses everybody.
// Immutable values; nothing allocates.
#pragma once

#include <compare>
#include <cstdint>
#include <functional>

namespace mavloom {

template <class Tag, class Rep>
struct Id {
    using rep = Rep;
    Rep value{};

    constexpr Id() = default;
    constexpr explicit Id(Rep v) noexcept : value(v) {}
    friend constexpr auto operator<=>(Id, Id) = default;
};

using SystemId = Id<struct SystemTag, std::uint8_t>;
using ComponentId = Id<struct ComponentTag, std::uint8_t>;
using MessageId = Id<struct MessageTag, std::uint32_t>;  // 24 bits on the wire
using LinkId = Id<struct LinkTag, std::uint32_t>;        // given by the process, never reused within a run

// Who sent a frame: the pair that MAVLink addresses.
struct Source {
    SystemId system;
    ComponentId component;
    friend constexpr auto operator<=>(Source, Source) = default;
};

}  // namespace mavloom

template <class Tag, class Rep>
struct std::hash<mavloom::Id<Tag, Rep>> {
    std::size_t operator()(mavloom::Id<Tag, Rep> id) const noexcept { return std::hash<Rep>{}(id.value); }
};
