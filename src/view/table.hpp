// SPDX-License-Identifier: MIT
// Table: the lines of one view, formatted one at a time. Private to module view.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "mavloom/view/grid.hpp"
#include "mavloom/view/state.hpp"

namespace mavloom::view {

class Table {
public:
    virtual ~Table() = default;
    [[nodiscard]] virtual int size() const = 0;
    virtual void draw_head(Grid& grid, int y) const = 0;
    virtual void draw_line(Grid& grid, int y, int line) const = 0;
};

// The table refers to its arguments.
[[nodiscard]] std::unique_ptr<Table> make_table(Tab tab, const Snapshot& shown, const State& state, int width);
[[nodiscard]] std::unique_ptr<Table> message_table(const Snapshot& shown, const State& state, int width);
[[nodiscard]] std::unique_ptr<Table> vehicle_table(const Snapshot& shown, int width);
[[nodiscard]] std::unique_ptr<Table> link_table(const Snapshot& shown, int width);
[[nodiscard]] std::unique_ptr<Table> route_table(const Snapshot& shown, int width);
[[nodiscard]] std::unique_ptr<Table> alarm_table(const Snapshot& shown, int width);

// A column of numbers ends at its right end; the blank before it is part of it. One of rank 0 is always there.
struct Spec {
    std::string_view title;
    int width, rank;
    bool is_right = true;
};
// Where each column of `specs` ends; 0: there is no room for it. Those of lower ranks come first.
[[nodiscard]] std::vector<int> fit(std::span<const Spec> specs, int first, int width);
// Writes into a column that ends at `end`, if there is room for it.
void put_in(Grid& grid, int y, const Spec& spec, int end, std::string_view text, Ink ink);

// ---- the messages

// A line of the view: a message, or the heading of a sender's messages.
struct Line {
    const Row* row = nullptr;  // null: a heading
    LinkId link{};
    Source source{};
};
[[nodiscard]] std::vector<Line> lines_of(const Snapshot& shown, const State& state);
// The column whose title is at `x`.
[[nodiscard]] std::optional<Column> column_at(const State& state, int x, int width);

// ---- the selected message

struct FieldLine {
    const dialect::Field* field = nullptr;
    std::optional<std::size_t> element{};
};
[[nodiscard]] std::vector<FieldLine> fields_of(const Row& row);
void draw_message(Grid& grid, int y, int end, const Snapshot& shown, const State& state, const Row& row);
void draw_message_head(Grid& grid, int y, const Snapshot& shown, const Row& row);
// The lines of fields between y and `end`; the others are for the plot.
[[nodiscard]] int field_lines(int y, int end) noexcept;
void draw_plot(Grid& grid, int y, int end, const std::vector<Point>& points, WallTime now, std::string_view label);
// A plot of one line.
void draw_spark(Grid& grid, int x, int y, int width, const std::vector<Point>& points, WallTime now);
[[nodiscard]] std::string name_of(const observe::LatestRow& row);

// ---- entries in the last line

[[nodiscard]] Effect enter(State& state, const Key& key);
void draw_prompt(Grid& grid, int y, const Snapshot& shown, const State& state);
// The rate that was asked for, and the vehicle's answer; empty if none was.
[[nodiscard]] std::string answer_text(const Snapshot& shown, const State& state);
[[nodiscard]] std::string_view title_of(Column column) noexcept;
[[nodiscard]] bool has_room(const State& state, Column column, int width);
[[nodiscard]] inline bool is_hidden(const State& state, Column column) noexcept {
    return (state.hidden >> static_cast<unsigned>(column) & 1U) != 0 ||
           (column == Column::was && state.frozen == nullptr);
}

// Draws the help from its line `first` on. If that is too far, `first` becomes the last one that fills the screen.
void draw_help(Grid& grid, int y, int end, bool plays, int& first);

// Which line is for what, in a terminal of this size. -1: there is no room for it.
struct Layout {
    int title = -1, vehicles = -1, alarm = -1, tabs = -1, head = -1, body = 0, end = 0, footer = -1;
};
[[nodiscard]] Layout layout_of(Size size) noexcept;
// Where the name of each view begins in the line of tabs.
// In a narrow terminal, only the shown view has its name there.
[[nodiscard]] std::array<int, tab_names.size() + 1> tab_places(Tab shown, int width);

}  // namespace mavloom::view
