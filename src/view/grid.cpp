// SPDX-License-Identifier: MIT
#include "mavloom/view/grid.hpp"

#include <algorithm>
#include <array>

#include "mavloom/message/utf8.hpp"

namespace mavloom::view {

namespace {

struct Range {
    char32_t first, last;
};

// Printable and one cell wide in every terminal: Latin, Greek, Cyrillic, punctuation, currencies, arrows and
// mathematics, boxes and blocks, and Braille. Combining marks and wide scripts are not here.
constexpr std::array one_cell{Range{0x20, 0x7e},     Range{0xa1, 0xac},     Range{0xae, 0x2ff},
                              Range{0x370, 0x482},   Range{0x48a, 0x52f},   Range{0x2010, 0x2027},
                              Range{0x2030, 0x205e}, Range{0x20a0, 0x20bf}, Range{0x2100, 0x22ff},
                              Range{0x2500, 0x25ff}, Range{0x2800, 0x28ff}};

char32_t safe(char32_t c) noexcept {
    return std::ranges::any_of(one_cell, [c](Range r) { return c >= r.first && c <= r.last; }) ? c : U'?';
}

// By the height of its dots, of which a character has four. Those of a steep curve fill most of it.
char32_t ascii_of_dots(std::uint32_t dots) noexcept {
    constexpr std::uint32_t top = 0x09, upper = 0x12, lower = 0x24, bottom = 0xc0;
    const bool is_steep = (dots & (top | upper)) != 0 && (dots & (lower | bottom)) != 0 && (dots & (top | bottom)) != 0;
    if (is_steep) return U'|';
    return (dots & top) != 0 ? U'\'' : (dots & bottom) != 0 ? U'_' : (dots & lower) != 0 ? U'.' : U'-';
}

char32_t ascii(char32_t c) noexcept {
    if (c < 0x80) return c;
    if (c > first_braille && c <= last_braille) return ascii_of_dots(c - first_braille);
    switch (c) {
        case 0x2500: return U'-';
        case 0x2502: return U'|';
        case 0x2026: return U'~';
        case 0x2191:
        case 0x25b2: return U'^';
        case 0x2193:
        case 0x25bc: return U'v';
        case 0x2190: return U'<';
        case 0x25b6:
        case 0x2192: return U'>';
        case 0xb7: return U'-';
        default: return U'?';
    }
}

template <class Take>
void each_glyph(std::string_view text, Take take) {
    while (!text.empty()) {
        const auto point = message::decode_utf8(text);
        text.remove_prefix(point.length);
        if (!take(safe(point.value))) return;
    }
}

}  // namespace

Grid::Grid(Size size, Glyphs glyphs)
    : size_{std::max(size.width, 0), std::max(size.height, 0)},
      glyphs_(glyphs),
      cells_(static_cast<std::size_t>(size_.width) * static_cast<std::size_t>(size_.height)) {}

void Grid::put_glyph(int x, int y, char32_t glyph, Ink ink) {
    if (x < 0 || y < 0 || x >= size_.width || y >= size_.height) return;
    auto& cell = cells_[index_of(x, y)];
    cell.glyph = glyphs_ == Glyphs::ascii ? ascii(glyph) : glyph;
    cell.ink = ink;
}

int Grid::put(int x, int y, std::string_view text, Ink ink, int end) {
    const auto limit = std::min(end, size_.width);
    each_glyph(text, [&](char32_t glyph) {
        if (x >= limit) return false;
        put_glyph(x++, y, glyph, ink);
        return true;
    });
    return x;
}

void Grid::put_right(int end, int y, std::string_view text, Ink ink) { put(end - width_of(text), y, text, ink, end); }

void Grid::reverse(int y) {
    if (y < 0 || y >= size_.height) return;
    for (int x = 0; x < size_.width; ++x) cells_[index_of(x, y)].is_reversed = true;
}

std::string Grid::text() const {
    std::string all;
    for (int y = 0; y < size_.height; ++y) {
        int used = size_.width;
        while (used > 0 && at(used - 1, y).glyph == U' ') --used;
        for (int x = 0; x < used; ++x) {
            std::array<char, 4> bytes{};
            all.append(bytes.data(), message::write_utf8(bytes.data(), at(x, y).glyph));
        }
        all += '\n';
    }
    return all;
}

int width_of(std::string_view text) {
    int width = 0;
    each_glyph(text, [&](char32_t) {
        ++width;
        return true;
    });
    return width;
}

}  // namespace mavloom::view
