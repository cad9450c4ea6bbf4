// SPDX-License-Identifier: MIT
// What a user may choose about routing, by the names that options and files use. docs/guide/routing.md says what each means.
#pragma once

#include <cstdint>

namespace mavloom::route {

// A frame for a component that was not heard, of a system that was: to the links of the system, or nowhere.
enum class UnknownComponent : std::uint8_t { system, drop };
// A frame for a system that was not heard: nowhere, or to all.
enum class UnknownTarget : std::uint8_t { drop, flood };
// Which links of a group get a frame: all; the one that loses least; the first that is up.
enum class GroupMode : std::uint8_t { all, best, primary };

}  // namespace mavloom::route
