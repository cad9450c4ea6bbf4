// SPDX-License-Identifier: MIT
// Breaks text for people into lines. Pure functions.
#pragma once

#include <string>
#include <string_view>

namespace mavloom::app {

// Whether the byte is the first one of a character in UTF-8.
[[nodiscard]] constexpr bool begins_character(char byte) noexcept {
    return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
}
[[nodiscard]] int characters_in(std::string_view text);

// Breaks text at blanks into lines of at most `width` characters, each with a newline. The first line starts with as
// many blanks as the text, the others with `indent` blanks. A word that is too long stays whole, and so does "5 %".
[[nodiscard]] std::string wrapped(std::string_view text, int width, int indent);

}  // namespace mavloom::app
