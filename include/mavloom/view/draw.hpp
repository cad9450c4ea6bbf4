// SPDX-License-Identifier: MIT
// Draws a snapshot as a grid of cells. Pure functions. Only the lines that fit are formatted.
#pragma once

#include "mavloom/view/grid.hpp"
#include "mavloom/view/snapshot.hpp"
#include "mavloom/view/state.hpp"

namespace mavloom::view {

// Keeps the selected line in sight: changes the scroll places of `state`, and nothing else.
[[nodiscard]] Grid draw(const Snapshot& shown, State& state, Size size, Glyphs glyphs);

// All views one below the other, with all of their lines.
[[nodiscard]] std::string whole_text(const Snapshot& shown, int width, Glyphs glyphs);

}  // namespace mavloom::view
