// SPDX-License-Identifier: MIT
// Routing choices that a user can configure. The enumerators have the names that options and files use; see
// docs/guide/routing.md.
#pragma once

#include <cstdint>

namespace mavloom::route {

// Where to send a frame for an unknown component of a known system: to all links of that system, or nowhere.
enum class UnknownComponent : std::uint8_t { system, drop };
// Where to send a frame for an unknown system: nowhere, or to all links.
enum class UnknownTarget : std::uint8_t { drop, flood };
// Which links of a group get a frame: all of them, the one that loses least, or the first that is not silent.
enum class GroupMode : std::uint8_t { all, best, primary };

}  // namespace mavloom::route
