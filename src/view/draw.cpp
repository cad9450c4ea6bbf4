// SPDX-License-Identifier: MIT
#include "mavloom/view/draw.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ranges>

#include "view/table.hpp"
#include "view/vehicle_text.hpp"
#include "view/words.hpp"

namespace mavloom::view {

namespace {

constexpr std::uint8_t no_autopilot = 8;  // MAV_AUTOPILOT_INVALID

constexpr int least_title = 8;

std::string playing_text(const Snapshot& shown) {
    const auto& its = *shown.playing;
    const auto text = fmt::format("{} / {}", clock_text(shown.now.wall - its.begin), clock_text(its.end - its.begin));
    if (its.is_over) return text + " end";
    return its.is_halted ? text + " halted" : its.speed == 1 ? text : fmt::format("{} x{:g}", text, its.speed);
}

// Narrow terminals have no room for the rates.
std::string title_figures(const Snapshot& shown, const State& state, int width) {
    std::string text;
    for (const auto& part :
         {state.paused ? "PAUSED" : std::string(), shown.playing ? playing_text(shown) : std::string(),
          hz_text(shown.hz) + " Hz", bytes_text(shown.bytes_per_s) + "/s"}) {
        if (part.empty()) continue;
        if (!text.empty() && width_of(text) + width_of(part) + 2 > width) break;
        text += (text.empty() ? "" : "  ") + part;
    }
    return text;
}

void draw_title(Grid& grid, int y, const Snapshot& shown, const State& state) {
    constexpr std::string_view name = "mavloom top";
    const int width = grid.size().width, for_title = std::min(width_of(shown.title), least_title);
    const auto right = title_figures(shown, state, width - width_of(name) - for_title - 5);
    const int end = width - 1 - width_of(right);
    const auto x = grid.put(1, y, name, Ink::strong, end - 1);
    grid.put(x + 2, y, shown.title, Ink::plain, end - 2);
    if (width_of(right) < width) grid.put_right(width - 1, y, right, Ink::strong);
    else grid.put(0, y, right, Ink::strong);  // the first digits, not the last ones
    grid.reverse(y);
}

struct Piece {
    std::string text;
    Ink ink = Ink::plain;
};

// "1/1 quadrotor Hold armed 87 % 15.9 V"
std::vector<Piece> pieces_of(const observe::Vehicle& its, const Snapshot& shown) {
    const auto kind = entry_text(*shown.dialect, "MAV_TYPE", its.type);
    std::vector<Piece> pieces{{fmt::format("{} {} ", source_text(its.source), kind), Ink::accent}};
    if (its.is_silent(shown.now.mono)) pieces.push_back({"silent ", Ink::bad});
    if (!its.mode.empty()) pieces.push_back({fmt::format("{} ", its.mode), Ink::strong});
    pieces.push_back(its.is_armed ? Piece{"armed ", Ink::warning} : Piece{"disarmed ", Ink::dim});
    if (its.battery) pieces.push_back({battery_text(its)});
    return pieces;
}

// Returns the place for the next one. The first one stands there even if it is cut.
int put_vehicle(Grid& grid, int x, int y, const std::vector<Piece>& pieces) {
    constexpr int between = 3, for_more = 9;
    int end = x;
    for (const auto& piece : pieces) end += width_of(piece.text);
    if (x > 1 && end > grid.size().width - for_more) return x;
    for (const auto& piece : pieces) x = grid.put(x, y, piece.text, piece.ink);
    return x + between;
}

void draw_vehicles(Grid& grid, int y, const Snapshot& shown) {
    if (y < 0) return;
    int x = 1, left = 0;
    for (const auto& vehicle : shown.vehicles) {
        if (vehicle.autopilot == no_autopilot) continue;
        const int next = left == 0 ? put_vehicle(grid, x, y, pieces_of(vehicle, shown)) : x;
        if (next == x) ++left;
        x = next;
    }
    if (left != 0) grid.put_right(grid.size().width - 1, y, fmt::format(" +{} more", left), Ink::dim);
    if (x == 1) grid.put(1, y, shown.frames == 0 ? "nothing was heard so far" : "no vehicle", Ink::dim);
}

void draw_alarm_line(Grid& grid, int y, const Snapshot& shown) {
    if (y < 0) return;
    const observe::Alarm* worst = nullptr;
    int count = 0;
    for (const auto& alarm : shown.alarms) {
        if (alarm.ended) continue;
        ++count;
        if (worst == nullptr || alarm.severity < worst->severity) worst = &alarm;
    }
    if (worst == nullptr) return void(grid.put(1, y, "no alarm", Ink::dim));
    const auto from = worst->source == Source{} ? worst->link : source_text(worst->source);
    const auto ink = worst->severity == observe::Alarm::Severity::error     ? Ink::bad
                     : worst->severity == observe::Alarm::Severity::warning ? Ink::warning
                                                                            : Ink::plain;
    const auto more = count == 1 ? std::string() : fmt::format(" (and {} more)", count - 1);
    const auto text = from.empty() ? worst->text : fmt::format("{}: {}", from, worst->text);  // of programs: empty
    const auto x = grid.put(1, y, "! " + text, ink, grid.size().width - width_of(more) - 1);
    grid.put(x, y, more, Ink::dim);
}

void draw_tabs(Grid& grid, int y, const State& state) {
    const auto places = tab_places(state.tab, grid.size().width);
    for (std::size_t i = 0; i < tab_names.size(); ++i) {
        const bool is_shown = state.tab == static_cast<Tab>(i);
        grid.put(places[i], y, fmt::format("{} {}", i + 1, tab_names[i]), is_shown ? Ink::accent : Ink::dim,
                 places[i + 1] - 1);
    }
    if (!state.search.empty() && state.prompt != Prompt::search)
        grid.put_right(grid.size().width - 1, y, "/" + state.search, Ink::warning);
    else if (state.frozen) grid.put_right(grid.size().width - 1, y, "frozen", Ink::warning);
}

std::string hints_of(const Snapshot& shown, const State& state) {
    if (state.shows_help) return "\u2191 \u2193 scroll  esc back";
    const auto* const space = shown.playing  ? shown.playing->is_halted ? "space play  \u2190 \u2192 seek"
                                                                        : "space halt  \u2190 \u2192 seek"
                              : state.paused ? "space go on"
                                             : "space pause";
    if (state.is_open)
        return fmt::format("esc back  \u2191 \u2193 field  f freeze  {}{}  ? help  q quit",
                           shown.playing ? "" : "i rate  ", space);
    if (state.tab != Tab::messages) return fmt::format("tab next view  {}  ? help  q quit", space);
    return fmt::format("? help  / search  s sort  enter open  f freeze  {}  q quit", space);
}

void draw_footer(Grid& grid, int y, const Snapshot& shown, const State& state) {
    if (state.prompt != Prompt::none) return draw_prompt(grid, y, shown, state);
    if (const auto answer = answer_text(shown, state); !answer.empty())
        return void(grid.put(1, y, answer, Ink::warning));
    grid.put(1, y, hints_of(shown, state), Ink::dim);
}

// Scrolls as little as possible.
void keep_in_sight(int& first, int at, int height, int size) {
    first = std::clamp(first, std::max(0, at - height + 1), std::max(0, at));
    first = std::clamp(first, 0, std::max(0, size - height));
}

int selected_line(const std::vector<Line>& lines, const State& state) {
    for (std::size_t i = 0; i < lines.size(); ++i)
        if (lines[i].row != nullptr && lines[i].row->key() == state.selected) return static_cast<int>(i);
    return -1;
}

// Breaks the text at blanks. Returns the line below it.
int put_wrapped(Grid& grid, int y, int end, std::string_view text, Ink ink) {
    for (int x = 1; !text.empty() && y < end; x = 3) grid.put(x, y++, take_words(text, grid.size().width - x), ink);
    return y;
}

// While nothing is heard: hints; or, of sources that the user named, what they reported last.
void draw_empty(Grid& grid, const Layout& its, const Snapshot& shown) {
    int y = put_wrapped(grid, its.body, its.end, "nothing to show", Ink::dim);
    if (shown.frames != 0) return;
    for (const auto& hint : shown.hints) y = put_wrapped(grid, y, its.end, hint, Ink::plain);
    if (!shown.hints.empty()) return;
    for (const auto& notice : shown.notices | std::views::reverse)
        y = put_wrapped(grid, y, its.end, notice, Ink::plain);
}

void draw_table(Grid& grid, const Layout& its, const Snapshot& shown, State& state) {
    const auto table = make_table(state.tab, shown, state, grid.size().width);
    auto& first = state.first[static_cast<std::size_t>(state.tab)];
    const int height = its.end - its.body;
    const int selected = state.tab == Tab::messages ? selected_line(lines_of(shown, state), state) : -1;
    if (selected >= 0) keep_in_sight(first, selected == 1 ? 0 : selected, height, table->size());
    first = std::clamp(first, 0, std::max(0, table->size() - height));
    if (selected == 1 && height > 1) first = 0;  // with its heading
    if (its.head >= 0) table->draw_head(grid, its.head);
    for (int i = 0; i < height && first + i < table->size(); ++i) table->draw_line(grid, its.body + i, first + i);
    if (selected >= first && selected - first < height) grid.reverse(its.body + selected - first);
    if (table->size() == 0) draw_empty(grid, its, shown);
}

void draw_open(Grid& grid, const Layout& its, const Snapshot& shown, State& state, const Row& row) {
    const int fields = static_cast<int>(fields_of(row).size());
    state.field = std::clamp(state.field, 0, std::max(0, fields - 1));
    keep_in_sight(state.first_field, state.field, field_lines(its.body, its.end), fields);
    if (its.head >= 0) draw_message_head(grid, its.head, shown, row);
    draw_message(grid, its.body, its.end, shown, state, row);
}

}  // namespace

std::array<int, tab_names.size() + 1> tab_places(Tab shown, int width) {
    constexpr int narrow = 70;
    std::array<int, tab_names.size() + 1> places{1};
    for (std::size_t i = 0; i < tab_names.size(); ++i) {
        const bool has_name = width >= narrow || static_cast<Tab>(i) == shown;
        places[i + 1] = places[i] + (has_name ? width_of(tab_names[i]) + 4 : 2);
    }
    return places;
}

Grid draw(const Snapshot& shown, State& state, Size size, Glyphs glyphs) {
    Grid grid(size, glyphs);
    const auto its = layout_of(grid.size());
    if (its.title >= 0) draw_title(grid, its.title, shown, state);
    draw_vehicles(grid, its.vehicles, shown);
    draw_alarm_line(grid, its.alarm, shown);
    if (its.tabs >= 0) draw_tabs(grid, its.tabs, state);
    const auto* const open = state.is_open ? shown.find(state.selected) : nullptr;
    if (state.shows_help) draw_help(grid, its.body, its.end, shown.playing.has_value(), state.first_help);
    else if (open != nullptr) draw_open(grid, its, shown, state, *open);
    else draw_table(grid, its, shown, state);
    if (its.footer >= 0) draw_footer(grid, its.footer, shown, state);
    return grid;
}

std::string whole_text(const Snapshot& shown, int width, Glyphs glyphs) {
    std::string text;
    const State state;
    for (const auto tab : {Tab::vehicles, Tab::messages, Tab::links, Tab::routes, Tab::alarms}) {
        if (tab == Tab::routes && shown.routes.empty()) continue;
        const auto table = make_table(tab, shown, state, width);
        if (table->size() == 0) continue;
        Grid grid({width, table->size() + 2}, glyphs);
        table->draw_head(grid, 1);
        for (int i = 0; i < table->size(); ++i) table->draw_line(grid, i + 2, i);
        text += grid.text();
    }
    Grid title({width, 1}, glyphs);
    draw_title(title, 0, shown, state);
    return title.text() + text;
}

}  // namespace mavloom::view
