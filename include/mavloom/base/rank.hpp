// SPDX-License-Identifier: MIT
// How far the router trusts the far side of a link. docs/guide/routing.md, "Trust", explains it to users.
#pragma once

#include <cstdint>

namespace mavloom {

enum class Rank : std::uint8_t {
    stranger,  // anybody may be there
    own,       // the user named the far side, or it is on this machine
    verified,  // every frame from there has a verified signature
};

}  // namespace mavloom
