// SPDX-License-Identifier: MIT
// QR codes for terminals. Pure functions, except `usual_glyphs`.
#pragma once

#include <string>

#include "mavloom/base/result.hpp"

namespace mavloom::app {

enum class Glyphs : std::uint8_t {
    half_blocks,  // a character for two modules, one above the other
    ascii,        // two characters for a module
};

// Half blocks if the environment's locale is UTF-8.
[[nodiscard]] Glyphs usual_glyphs();

// Lines that show `text` as a QR code, with the light margin that readers need. `colored`: dark on light in ANSI
// colors, whatever those of the terminal are.
[[nodiscard]] SetupResult<std::string> qr_code(const std::string& text, Glyphs glyphs, bool colored);

}  // namespace mavloom::app
