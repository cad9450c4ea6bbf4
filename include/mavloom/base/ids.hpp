// SPDX-License-Identifier: MIT
// MAVLink ids as distinct types, so that a system id cannot be passed where a component id is expected.
// The values are those of the protocol; system or component id 0 means broadcast. Plain values, no allocation.
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
using LinkId = Id<struct LinkTag, std::uint32_t>;        // assigned by this process, never reused while it runs

// The sender of a frame.
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
