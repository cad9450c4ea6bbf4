// SPDX-License-Identifier: MIT
// Plots by Braille characters, which have 2 by 4 dots each (Unicode, "Braille Patterns").
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mavloom/view/history.hpp"
#include "view/table.hpp"
#include "view/words.hpp"

namespace mavloom::view {

namespace {

constexpr int labels = 11, dots_x = 2, dots_y = 4;

// The bit of the dot in column x and row y of a character.
constexpr std::uint8_t dot_bits[dots_x][dots_y] = {{0x01, 0x02, 0x04, 0x40}, {0x08, 0x10, 0x20, 0x80}};

struct Limits {
    double low = 0, high = 0;
};

Limits limits_of(const std::vector<Point>& points) {
    const auto [low, high] = std::ranges::minmax(points, {}, &Point::value);
    return {low.value, high.value};
}

class Dots {
public:
    Dots(int width, int height)
        : width_(width), height_(height), bits_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

    [[nodiscard]] int width() const noexcept { return width_ * dots_x; }
    [[nodiscard]] int height() const noexcept { return height_ * dots_y; }
    // From the lower left corner.
    void set(int x, int y) {
        if (x < 0 || x >= width() || y < 0 || y >= height()) return;
        const int from_top = height() - 1 - y;
        bits_[index(x / dots_x, from_top / dots_y)] |= dot_bits[x % dots_x][from_top % dots_y];
    }
    void draw(Grid& grid, int left, int top) const {
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x)
                if (const auto bits = bits_[index(x, y)]; bits != 0)
                    grid.put_glyph(left + x, top + y, first_braille + bits, Ink::accent);
    }

private:
    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }
    int width_, height_;
    std::vector<std::uint8_t> bits_;
};

// Vertical lines join neighbours, so that a steep curve has no holes.
void set_points(Dots& dots, const std::vector<Point>& points, Limits limits, WallTime now) {
    const auto span = limits.high - limits.low;
    int last_x = -1, last_y = 0;
    for (const auto& point : points) {
        const auto age = std::chrono::duration<double>(now - point.time) / History::window;
        const auto x = dots.width() - 1 - static_cast<int>(age * dots.width());
        const auto up = span > 0 ? (point.value - limits.low) / span : 0.5;
        const auto y = static_cast<int>(std::lround(up * (dots.height() - 1)));
        dots.set(x, y);
        if (last_x >= 0 && x - last_x <= 1)
            for (int between = std::min(y, last_y); between < std::max(y, last_y); ++between) dots.set(x, between);
        last_x = x;
        last_y = y;
    }
}

}  // namespace

void draw_spark(Grid& grid, int x, int y, int width, const std::vector<Point>& points, WallTime now) {
    if (points.empty()) return;
    Dots dots(width, 1);
    set_points(dots, points, limits_of(points), now);
    dots.draw(grid, x, y);
}

void draw_plot(Grid& grid, int y, int end, const std::vector<Point>& points, WallTime now, std::string_view label) {
    const int width = grid.size().width - labels - 1;
    grid.put(1, y, label, Ink::strong);
    grid.put_right(grid.size().width - 1, y, fmt::format("last {}", time_text(History::window)), Ink::dim);
    ++y;
    if (points.empty()) return void(grid.put(1, y, "no number to plot so far", Ink::dim));
    if (width < 4 || y >= end) return;
    const auto limits = limits_of(points);
    Dots dots(width, end - y);
    set_points(dots, points, limits, now);
    dots.draw(grid, labels, y);
    grid.put_right(labels - 1, y, fmt::format("{:.5g}", limits.high), Ink::dim);
    if (limits.high > limits.low) grid.put_right(labels - 1, end - 1, fmt::format("{:.5g}", limits.low), Ink::dim);
}

}  // namespace mavloom::view
