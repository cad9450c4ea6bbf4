// SPDX-License-Identifier: MIT
#include "view/table.hpp"

#include <algorithm>

namespace mavloom::view {

std::vector<int> fit(std::span<const Spec> specs, int first, int width) {
    int most = -1, used = first;
    for (int rank = 0; most < rank; ++rank) {
        const auto spec = std::ranges::find(specs, rank, &Spec::rank);
        if (spec == specs.end() || (rank != 0 && used + spec->width > width)) break;
        used += spec->width;
        most = rank;
    }
    std::vector<int> ends(specs.size());
    int at = first;
    for (std::size_t i = 0; i < specs.size(); ++i)
        if (specs[i].rank <= most) ends[i] = at += specs[i].width;
    return ends;
}

// Text may fill its column but for a blank.
void put_in(Grid& grid, int y, const Spec& spec, int end, std::string_view text, Ink ink) {
    if (end == 0) return;
    if (spec.is_right) grid.put_right(end, y, text, ink);
    else grid.put(end - spec.width, y, text, ink, end - 1);
}

std::unique_ptr<Table> make_table(Tab tab, const Snapshot& shown, const State& state, int width) {
    switch (tab) {
        case Tab::messages: return message_table(shown, state, width);
        case Tab::vehicles: return vehicle_table(shown, width);
        case Tab::links: return link_table(shown, width);
        case Tab::routes: return route_table(shown, width);
        case Tab::alarms: break;
    }
    return alarm_table(shown, width);
}

Layout layout_of(Size size) noexcept {
    Layout its;
    int y = 0;
    const auto line_from = [&](int height) { return size.height >= height ? y++ : -1; };
    its.title = line_from(3);
    its.vehicles = line_from(14);
    its.alarm = line_from(9);
    its.tabs = line_from(6);
    its.head = line_from(4);
    its.body = y;
    its.footer = size.height >= 5 ? size.height - 1 : -1;
    its.end = std::max(y, size.height - (its.footer < 0 ? 0 : 1));
    return its;
}

}  // namespace mavloom::view
