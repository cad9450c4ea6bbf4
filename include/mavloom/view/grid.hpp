// SPDX-License-Identifier: MIT
// A grid of character cells: what a terminal shows, without a terminal. Plain data with one owner.
//
// Text may come from outside: control characters and characters that are not one cell wide become '?'.
#pragma once

#include <climits>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace mavloom::view {

// The meaning of a text. The screen chooses the colour.
enum class Ink : std::uint8_t { plain, dim, strong, accent, good, warning, bad };

struct Cell {
    char32_t glyph = U' ';
    Ink ink = Ink::plain;
    bool is_reversed = false;
    friend bool operator==(const Cell&, const Cell&) = default;
};

struct Size {
    int width = 0, height = 0;
    friend bool operator==(const Size&, const Size&) = default;
};

// Characters of 2 by 4 dots (Unicode, "Braille Patterns").
inline constexpr char32_t first_braille = 0x2800, last_braille = 0x28ff;

enum class Glyphs : std::uint8_t { unicode, ascii };

class Grid {
public:
    Grid(Size size, Glyphs glyphs);

    [[nodiscard]] Size size() const noexcept { return size_; }
    [[nodiscard]] const Cell& at(int x, int y) const { return cells_[index_of(x, y)]; }

    // Writes UTF-8 from `x` up to `end`, and cuts the rest. Returns the place after it.
    int put(int x, int y, std::string_view text, Ink ink = Ink::plain, int end = INT_MAX);
    // Writes text that ends before `end`.
    void put_right(int end, int y, std::string_view text, Ink ink = Ink::plain);
    void put_glyph(int x, int y, char32_t glyph, Ink ink = Ink::plain);
    // Reverses a line, for bars and for the selected line.
    void reverse(int y);

    // Lines without blanks at their ends, each with a newline.
    [[nodiscard]] std::string text() const;

private:
    [[nodiscard]] std::size_t index_of(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width) + static_cast<std::size_t>(x);
    }

    Size size_;
    Glyphs glyphs_;
    std::vector<Cell> cells_;
};

// The cells that a text needs.
[[nodiscard]] int width_of(std::string_view text);

}  // namespace mavloom::view
