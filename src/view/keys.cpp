// SPDX-License-Identifier: MIT
#include <algorithm>

#include "mavloom/view/state.hpp"
#include "view/table.hpp"

namespace mavloom::view {

namespace {

using Code = Key::Code;
using Shown = std::shared_ptr<const Snapshot>;

constexpr int wheel_lines = 3, all_lines = 1'000'000;

int count_of(const std::vector<Line>& lines) { return static_cast<int>(lines.size()); }

// The message nearest to a line, in the direction of the move.
void select_near(State& state, const std::vector<Line>& lines, int line, int step) {
    line = std::clamp(line, 0, std::max(0, count_of(lines) - 1));
    for (int at = line; at >= 0 && at < count_of(lines); at += step)
        if (const auto* const row = lines[static_cast<std::size_t>(at)].row) return void(state.selected = row->key());
    for (int at = line; at >= 0 && at < count_of(lines); at -= step)
        if (const auto* const row = lines[static_cast<std::size_t>(at)].row) return void(state.selected = row->key());
}

void move_selection(State& state, const Snapshot& shown, int by) {
    const auto lines = lines_of(shown, state);
    const auto now = std::ranges::find_if(
        lines, [&](const Line& line) { return line.row != nullptr && line.row->key() == state.selected; });
    const int from = now == lines.end() ? (by > 0 ? -1 : 0) : static_cast<int>(now - lines.begin());
    select_near(state, lines, from + by, by > 0 ? 1 : -1);
}

bool is_listed(const State& state, const Snapshot& shown) {
    return std::ranges::any_of(lines_of(shown, state), [&](const Line& line) {
        return line.row != nullptr && line.row->key() == state.selected;
    });
}

void move(State& state, const Snapshot& shown, int by) {
    if (state.is_open) {
        state.field = std::max(0, state.field + by);
    } else if (state.tab == Tab::messages) {
        move_selection(state, shown, by);
    } else {
        auto& first = state.first[static_cast<std::size_t>(state.tab)];
        first = std::max(0, first + by);
    }
}

// `by` 0: a key that does not scroll closes the help.
Effect scroll_help(State& state, int by) {
    state.first_help = std::max(0, state.first_help + by);
    if (by == 0) state.shows_help = false;
    return Effect::none;
}

void show_tab(State& state, int tab) {
    constexpr int tabs = tab_names.size();
    state.tab = static_cast<Tab>((tab + tabs) % tabs);
    state.is_open = false;
}

void sort_by_next(State& state, int step) {
    constexpr int all = columns;
    int next = static_cast<int>(state.sort);
    do next = (next + step + all) % all;
    while (is_hidden(state, static_cast<Column>(next)));
    state.sort = static_cast<Column>(next);
    state.is_backwards = false;
}

void open(State& state, const Snapshot& shown) {
    if (state.tab != Tab::messages || state.is_open) return;
    if (!is_listed(state, shown)) move_selection(state, shown, 1);
    if (!is_listed(state, shown)) return;
    state.is_open = true;
    state.field = state.first_field = 0;
}

void back(State& state) {
    if (state.is_open) state.is_open = false;
    else if (!state.search.empty()) state.search.clear();
    else state.frozen = nullptr;
}

bool can_ask(const State& state, const Snapshot& shown) {
    const auto* const row = shown.find(state.selected);
    const bool is_seen = state.is_open || is_listed(state, shown);
    return state.tab == Tab::messages && is_seen && !shown.playing && row != nullptr && row->its.message != nullptr;
}

void begin(State& state, Prompt prompt) {
    if (!state.is_open || prompt != Prompt::rate) show_tab(state, static_cast<int>(Tab::messages));
    state.prompt = prompt;
}

void click_tab(State& state, int x, int width) {
    const auto places = tab_places(state.tab, width);
    for (std::size_t i = 0; i < tab_names.size(); ++i)
        if (x >= places[i] && x < places[i + 1]) show_tab(state, static_cast<int>(i));
}

void click_head(State& state, int x, int width) {
    const auto column = column_at(state, x, width);
    if (!column || state.tab != Tab::messages || state.is_open) return;
    state.is_backwards = state.sort == *column && !state.is_backwards;
    state.sort = *column;
}

void click_line(State& state, const Snapshot& shown, int line) {
    if (state.is_open) return void(state.field = state.first_field + line);
    if (state.tab != Tab::messages) return;
    const auto lines = lines_of(shown, state);
    const int at = state.first.front() + line;
    if (at >= count_of(lines)) return;
    const auto* const row = lines[static_cast<std::size_t>(at)].row;
    if (row == nullptr) return;
    if (state.selected == row->key()) open(state, shown);
    else state.selected = row->key();
}

void click(State& state, const Snapshot& shown, const Key& key, Size size) {
    const auto its = layout_of(size);
    if (key.y == its.tabs) click_tab(state, key.x, size.width);
    else if (key.y == its.head) click_head(state, key.x, size.width);
    else if (key.y >= its.body && key.y < its.end) click_line(state, shown, key.y - its.body);
}

Effect take_space(State& state, const Shown& shown) {
    if (shown->playing) return Effect::halt;
    state.paused = state.paused ? nullptr : shown;
    return Effect::none;
}

Effect take_character(State& state, const Shown& shown, char32_t c) {
    if (c >= U'1' && c < U'1' + tab_names.size()) show_tab(state, static_cast<int>(c - U'1'));
    switch (c) {
        case U'q': return Effect::quit;
        case U' ': return take_space(state, shown);
        case U'-': return Effect::slower;
        case U'+':
        case U'=': return Effect::faster;
        case U'0': return Effect::to_begin;
        case U'$': return Effect::to_end;
        case U'?':
        case U'h':
            state.shows_help = true;
            state.first_help = 0;
            break;
        case U'/': begin(state, Prompt::search); break;
        case U'c': begin(state, Prompt::choice); break;
        case U'i':
            if (!can_ask(state, *shown)) break;
            state.rate.clear();
            state.rate_of = state.selected;
            begin(state, Prompt::rate);
            break;
        case U's': sort_by_next(state, 1); break;
        case U'S': sort_by_next(state, -1); break;
        case U'r': state.is_backwards = !state.is_backwards; break;
        case U'f': state.frozen = state.frozen ? nullptr : shown; break;
        default: break;
    }
    if (state.sort == Column::was && state.frozen == nullptr) state.sort = Column::name;
    return Effect::none;
}

// 0: the key does not scroll. `page` is how far PgDn does.
int lines_of_scroll(const Key& key, int page) {
    switch (key.code) {
        case Code::up: return -1;
        case Code::down: return 1;
        case Code::page_up: return -page;
        case Code::page_down: return page;
        case Code::home: return -all_lines;
        case Code::end: return all_lines;
        case Code::scroll_up: return -wheel_lines;
        case Code::scroll_down: return wheel_lines;
        case Code::character: return key.character == U'j' ? 1 : key.character == U'k' ? -1 : 0;
        default: return 0;
    }
}

}  // namespace

Effect press(State& state, const Shown& shown, const Key& key, Size size) {
    const auto its = layout_of(size);
    const int page = std::max(1, (state.is_open ? field_lines(its.body, its.end) : its.end - its.body) - 1);
    const int by = lines_of_scroll(key, page);
    if (state.shows_help) return scroll_help(state, by);
    const bool is_move = key.code == Code::up || key.code == Code::down || key.code == Code::click;
    if (state.prompt == Prompt::rate && key.code == Code::click) state.prompt = Prompt::none;
    if (state.prompt == Prompt::rate || (state.prompt != Prompt::none && !is_move)) return enter(state, key);
    if (by != 0) {
        move(state, *shown, by);
        return Effect::none;
    }
    switch (key.code) {
        case Code::character: return take_character(state, shown, key.character);
        case Code::left: return Effect::back;
        case Code::right: return Effect::forward;
        case Code::enter: open(state, *shown); break;
        case Code::escape:
        case Code::backspace: back(state); break;
        case Code::tab: show_tab(state, static_cast<int>(state.tab) + 1); break;
        case Code::back_tab: show_tab(state, static_cast<int>(state.tab) - 1); break;
        case Code::click: click(state, *shown, key, size); break;
        default: break;
    }
    return Effect::none;
}

}  // namespace mavloom::view
