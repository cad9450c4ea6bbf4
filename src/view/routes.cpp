// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>

#include "view/table.hpp"
#include "view/words.hpp"

namespace mavloom::view {

namespace {

constexpr int sender_at = 1, router_at = 10, route_link_at = 26, frames_width = 10, route_age_width = 9;

class RouteTable : public Table {
public:
    explicit RouteTable(const Snapshot& shown) : shown_(shown) {}

    [[nodiscard]] int size() const override { return std::max(1, static_cast<int>(shown_.routes.size())); }
    void draw_head(Grid& grid, int y) const override {
        const int end = grid.size().width - 1;
        grid.put(sender_at, y, "SENDER", Ink::strong);
        grid.put(router_at, y, "ROUTER", Ink::strong);
        grid.put(route_link_at, y, "REACHED BY", Ink::strong);
        grid.put_right(end - frames_width, y, "AGE", Ink::strong);
        grid.put_right(end, y, "FRAMES", Ink::strong);
    }
    void draw_line(Grid& grid, int y, int line) const override {
        if (shown_.routes.empty())
            return void(
                grid.put(1, y, "none of the sources is a router of this machine, or it has no route so far", Ink::dim));
        const auto& its = shown_.routes[static_cast<std::size_t>(line)];
        const int end = grid.size().width - 1;
        grid.put(router_at, y, its.router, Ink::dim, route_link_at - 1);
        if (!its.error.empty()) return void(grid.put(route_link_at, y, its.error, Ink::warning));
        grid.put(sender_at, y, source_text(its.source), Ink::accent, router_at - 1);
        grid.put(route_link_at, y, its.link, Ink::plain, end - frames_width - route_age_width);
        grid.put_right(end - frames_width, y, age_text(its.age));
        grid.put_right(end, y, count_text(its.frames));
    }

private:
    const Snapshot& shown_;
};

}  // namespace

std::unique_ptr<Table> route_table(const Snapshot& shown) { return std::make_unique<RouteTable>(shown); }

}  // namespace mavloom::view
