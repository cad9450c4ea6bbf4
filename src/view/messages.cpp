// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "mavloom/base/shown.hpp"
#include "mavloom/base/text.hpp"
#include "view/table.hpp"
#include "view/words.hpp"

namespace mavloom::view {

namespace {

using namespace std::chrono_literals;

constexpr int shortest_name = 26, usual_name = 34, longest_name = 46;
constexpr int narrow = 60;  // columns of a terminal that has no room for usual names
constexpr auto new_for = 5s;

// By Column. The first one gets the room that is left.
constexpr std::array<Spec, columns> message_specs{{{"MESSAGE", shortest_name, 0, false},
                                                   {"HZ", 9, 1},
                                                   {"HZ THEN", 9, 2},
                                                   {"AGE", 8, 3},
                                                   {"GAP MAX", 9, 4},
                                                   {"JITTER", 9, 5},
                                                   {"SHARE", 8, 6},
                                                   {"BYTES", 9, 7},
                                                   {"COUNT", 9, 8},
                                                   {"GAP MIN", 9, 9}}};

struct Places {
    int name_end = 0;
    std::vector<int> ends;  // by Column; 0: not shown
};

Places places_of(const State& state, int width) {
    auto chosen = message_specs;
    if (width >= narrow) chosen.front().width = usual_name;
    for (std::size_t i = 1; i < chosen.size(); ++i)
        if (is_hidden(state, static_cast<Column>(i))) chosen[i].width = 0;
    auto ends = fit(chosen, 0, width - 1);
    for (std::size_t i = 1; i < chosen.size(); ++i)
        if (chosen[i].width == 0) ends[i] = 0;
    const int spare = std::clamp(width - 1 - *std::ranges::max_element(ends), 0, longest_name - chosen.front().width);
    for (auto& end : ends)
        if (end != 0) end += spare;
    const auto name_end = ends.front();
    return {name_end, std::move(ends)};
}

Nanoseconds age_of(const observe::LatestRow& row, Now now) { return now.mono - row.heard; }

bool is_new(const Row& row, const Snapshot& shown) {
    const auto since = shown.now.wall - row.its.traffic.first;
    return since < new_for && shown.now.mono - shown.began > new_for;
}

std::string rate_text(const Row& row) { return row.hz == 0 ? "-" : hz_text(row.hz); }

Ink ink_of(const Row& row, const Snapshot& shown) {
    if (row.is_silent) return Ink::dim;
    return is_new(row, shown) ? Ink::good : Ink::plain;
}

std::string text_of(Column column, const Row& row, const Snapshot& shown, const State& state) {
    const auto& its = row.its.traffic;
    switch (column) {
        case Column::name: return {};
        case Column::hz: return rate_text(row);
        case Column::was: {
            const auto* const then = state.frozen ? state.frozen->find(row.key()) : nullptr;
            return then == nullptr ? "-" : rate_text(*then);
        }
        case Column::age: return age_text(age_of(row.its, shown.now));
        case Column::gap_max: return its.count < 2 ? "-" : time_text(its.longest_gap);
        case Column::jitter: return its.count < 3 ? "-" : time_text(row.its.jitter);
        case Column::share: return percent_text(row.share);
        case Column::bytes: return bytes_text(static_cast<double>(its.bytes));
        case Column::count: return count_text(its.count);
        case Column::gap_min: break;
    }
    return its.count < 2 ? "-" : time_text(its.shortest_gap);
}

// Rates that look the same stand in the order of their names, not of their last digits, which change all the time.
double steady(double hz) { return hz < 0.95 ? std::round(hz * 100) / 100 : std::round(hz * 10) / 10; }

double value_of(Column column, const Row& row, const Snapshot& shown, const State& state) {
    const auto& its = row.its.traffic;
    switch (column) {
        case Column::name: return 0;
        case Column::hz: return steady(row.hz);
        case Column::was: {
            const auto* const then = state.frozen ? state.frozen->find(row.key()) : nullptr;
            return then == nullptr ? -1 : steady(then->hz);
        }
        case Column::age: return -static_cast<double>(age_of(row.its, shown.now).count());
        case Column::gap_max: return static_cast<double>(its.longest_gap.count());
        case Column::jitter: return static_cast<double>(row.its.jitter.count());
        case Column::share: return row.share;
        case Column::bytes: return static_cast<double>(its.bytes);
        case Column::count: return static_cast<double>(its.count);
        case Column::gap_min: break;
    }
    return static_cast<double>(its.shortest_gap.count());
}

bool contains(std::string_view text, std::string_view part) {
    const auto same = [](char a, char b) { return lower(a) == lower(b); };
    return std::ranges::search(text, part, same).begin() != text.end() || part.empty();
}

// By its name or id, its sender, or its link.
bool matches(const Row& row, const Snapshot& shown, std::string_view search) {
    if (search.empty()) return true;
    const auto& its = row.its.traffic;
    const auto* const message = row.its.message;
    if (message != nullptr && contains(message->name, search)) return true;
    if (source_text(its.source) == search || fmt::format("#{}", its.id.value) == search) return true;
    const auto link = shown.links.find(its.link);
    return link != shown.links.end() && contains(link->second, search);
}

void sort(std::vector<const Row*>& rows, const Snapshot& shown, const State& state) {
    if (state.sort == Column::name) {
        if (state.is_backwards) std::ranges::reverse(rows);
        return;
    }
    const auto value = [&](const Row* row) { return value_of(state.sort, *row, shown, state); };
    if (state.is_backwards) std::ranges::stable_sort(rows, std::ranges::less{}, value);
    else std::ranges::stable_sort(rows, std::ranges::greater{}, value);
}

class MessageTable : public Table {
public:
    MessageTable(const Snapshot& shown, const State& state, int width)
        : shown_(shown), state_(state), lines_(lines_of(shown, state)), places_(places_of(state, width)) {}

    [[nodiscard]] int size() const override { return static_cast<int>(lines_.size()); }

    void draw_head(Grid& grid, int y) const override {
        for (std::size_t i = 0; i < message_specs.size(); ++i) {
            if (places_.ends[i] == 0) continue;
            const bool sorts = state_.sort == static_cast<Column>(i);
            const auto title = fmt::format("{}{}", message_specs[i].title,
                                           !sorts                ? ""
                                           : state_.is_backwards ? "▲"
                                                                 : "▼");
            const auto ink = sorts ? Ink::accent : Ink::strong;
            if (message_specs[i].is_right) grid.put_right(places_.ends[i], y, title, ink);
            else grid.put(1, y, title, ink, places_.name_end);
        }
    }

    void draw_line(Grid& grid, int y, int line) const override {
        const auto& its = lines_[static_cast<std::size_t>(line)];
        if (its.row == nullptr) draw_heading(grid, y, its);
        else draw_row(grid, y, *its.row);
    }

private:
    void draw_row(Grid& grid, int y, const Row& row) const {
        const auto ink = ink_of(row, shown_);
        if (is_new(row, shown_)) grid.put(0, y, "+", Ink::good);
        if (row.is_silent) grid.put(0, y, "!", Ink::warning);
        const bool is_tree = state_.sort == Column::name;
        const auto name = is_tree ? name_of(row.its)
                                  : fmt::format("{} {}", source_text(row.its.traffic.source), name_of(row.its));
        grid.put(is_tree ? 3 : 1, y, name, ink, places_.name_end);
        for (std::size_t i = 1; i < message_specs.size(); ++i)
            if (places_.ends[i] != 0)
                grid.put_right(places_.ends[i], y, text_of(static_cast<Column>(i), row, shown_, state_), ink);
    }

    // "1/1 quadrotor px4 on udpin://0.0.0.0:14550 127.0.0.1:4711" and what of it was lost.
    void draw_heading(Grid& grid, int y, const Line& line) const {
        const auto vehicle = std::ranges::find(shown_.vehicles, line.source, &observe::Vehicle::source);
        auto text = source_text(line.source);
        if (vehicle != shown_.vehicles.end())
            text.append(" ").append(entry_text(*shown_.dialect, "MAV_TYPE", vehicle->type));
        const auto x = grid.put(1, y, text, Ink::accent);
        const auto link = shown_.links.find(line.link);
        const auto end = *std::ranges::max_element(places_.ends);
        const auto loss = loss_text(line);
        grid.put(x + 1, y, link == shown_.links.end() ? "" : link->second, Ink::dim, end - width_of(loss.text) - 1);
        grid.put_right(end, y, loss.text, loss.ink);
    }

    struct Loss {
        std::string text;
        Ink ink;
    };
    [[nodiscard]] Loss loss_text(const Line& line) const {
        const auto* const loss = shown_.loss_of(line.link, line.source);
        if (loss == nullptr) return {};
        if (loss->lost == 0) return {"0 lost", Ink::dim};
        const auto ratio = observe::loss_ratio(*loss);
        return {fmt::format("{} lost, {}", count_text(loss->lost), percent_text(ratio)),
                ratio < 0.01 ? Ink::warning : Ink::bad};
    }

    const Snapshot& shown_;
    const State& state_;
    const std::vector<Line> lines_;
    const Places places_;
};

}  // namespace

std::string_view title_of(Column column) noexcept { return message_specs[static_cast<std::size_t>(column)].title; }

bool has_room(const State& state, Column column, int width) {
    return places_of(state, width).ends[static_cast<std::size_t>(column)] != 0;
}

std::string name_of(const observe::LatestRow& row) {
    auto name = row.message == nullptr ? fmt::format("#{}", row.traffic.id.value) : std::string(row.message->name);
    if (const auto instance = row.instance()) name.append("/").append(printable(message::text_of(*instance)));
    return name;
}

std::vector<Line> lines_of(const Snapshot& shown, const State& state) {
    std::vector<const Row*> rows;
    rows.reserve(shown.rows.size());
    for (const auto& row : shown.rows)
        if (matches(row, shown, state.search)) rows.push_back(&row);
    sort(rows, shown, state);
    std::vector<Line> lines;
    lines.reserve(rows.size() + 1);
    for (const auto* const row : rows) {
        const auto& its = row->its.traffic;
        const bool is_first = lines.empty() || lines.back().link != its.link || lines.back().source != its.source;
        if (state.sort == Column::name && is_first) lines.push_back({nullptr, its.link, its.source});
        lines.push_back({row, its.link, its.source});
    }
    return lines;
}

std::optional<Column> column_at(const State& state, int x, int width) {
    const auto places = places_of(state, width);
    for (std::size_t i = 0; i < message_specs.size(); ++i)
        if (x < places.ends[i] && (i == 0 || x >= places.ends[i] - message_specs[i].width))
            return static_cast<Column>(i);
    return std::nullopt;
}

std::unique_ptr<Table> message_table(const Snapshot& shown, const State& state, int width) {
    return std::make_unique<MessageTable>(shown, state, width);
}

}  // namespace mavloom::view
