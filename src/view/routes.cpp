// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "view/table.hpp"
#include "view/words.hpp"

namespace mavloom::view {

namespace {

enum RouteColumn : std::uint8_t { route_sender, route_router, route_link, route_age, route_frames };

using RouteSpecs = std::array<Spec, 5>;
constexpr RouteSpecs route_specs{
    {{"SENDER", 9, 0, false}, {"ROUTER", 16, 3, false}, {"REACHED BY", 20, 1, false}, {"AGE", 9, 2}, {"FRAMES", 10, 4}}};

// The link gets the room that is left.
RouteSpecs route_specs_for(int width) {
    auto specs = route_specs;
    specs[route_link].width += std::max(0, width - 1 - std::ranges::max(fit(specs, 1, width - 1)));
    return specs;
}

class RouteTable : public Table {
public:
    RouteTable(const Snapshot& shown, int width)
        : shown_(shown), specs_(route_specs_for(width)), ends_(fit(specs_, 1, width - 1)) {}

    [[nodiscard]] int size() const override { return std::max(1, static_cast<int>(shown_.routes.size())); }
    void draw_head(Grid& grid, int y) const override {
        for (std::size_t i = 0; i < ends_.size(); ++i)
            put(grid, y, static_cast<RouteColumn>(i), specs_[i].title, Ink::strong);
    }
    void draw_line(Grid& grid, int y, int line) const override {
        if (shown_.routes.empty()) return void(grid.put(1, y, "no source is a router with routes", Ink::dim));
        const auto& its = shown_.routes[static_cast<std::size_t>(line)];
        put(grid, y, route_router, its.router, Ink::dim);
        if (!its.error.empty()) return draw_error(grid, y, its);
        put(grid, y, route_sender, source_text(its.source), Ink::accent);
        put(grid, y, route_link, its.link, Ink::plain);
        put(grid, y, route_age, age_text(its.age), Ink::plain);
        put(grid, y, route_frames, count_text(its.frames), Ink::plain);
    }

private:
    void draw_error(Grid& grid, int y, const Route& its) const {
        if (ends_[route_router] != 0) grid.put(ends_[route_router], y, its.error, Ink::warning);
        else grid.put(1, y, fmt::format("{}: {}", its.router, its.error), Ink::warning);
    }
    void put(Grid& grid, int y, RouteColumn column, std::string_view text, Ink ink) const {
        put_in(grid, y, specs_[column], ends_[column], text, ink);
    }

    const Snapshot& shown_;
    const RouteSpecs specs_;
    const std::vector<int> ends_;
};

}  // namespace

std::unique_ptr<Table> route_table(const Snapshot& shown, int width) {
    return std::make_unique<RouteTable>(shown, width);
}

}  // namespace mavloom::view
