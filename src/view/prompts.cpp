// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "mavloom/message/utf8.hpp"
#include "view/table.hpp"
#include "view/words.hpp"

namespace mavloom::view {

namespace {

using Code = Key::Code;

constexpr std::size_t longest_search = 60, longest_rate = 6;
constexpr double highest_rate = 1e4;

void end_prompt(State& state) { state.prompt = Prompt::none; }

void remove_last(std::string& text) {
    while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xc0) == 0x80) text.pop_back();
    if (!text.empty()) text.pop_back();
}

void type_search(State& state, const Key& key) {
    if (key.code == Code::escape) state.search.clear();
    if (key.code == Code::escape || key.code == Code::enter) end_prompt(state);
    if (key.code == Code::backspace) remove_last(state.search);
    if (key.code != Code::character || key.character < U' ' || state.search.size() >= longest_search) return;
    std::array<char, 4> bytes{};
    state.search.append(bytes.data(), message::write_utf8(bytes.data(), key.character));
}

void choose_column(State& state, const Key& key) {
    if (key.code == Code::escape || key.code == Code::enter) return end_prompt(state);
    if (key.code != Code::character || key.character < U'1' || key.character >= U'0' + columns) return;
    state.hidden ^= 1U << (key.character - U'0');
    if (is_hidden(state, state.sort)) state.sort = Column::name;
}

std::optional<double> rate_of(std::string_view text) {
    if (text == "d") return -1;
    double hz = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), hz, std::chars_format::fixed);
    if (error != std::errc() || end != text.data() + text.size() || hz < 0 || hz > highest_rate) return std::nullopt;
    return hz;
}

Effect type_rate(State& state, const Key& key) {
    if (key.code == Code::escape) end_prompt(state);
    if (key.code == Code::backspace) remove_last(state.rate);
    if (key.code == Code::enter) {
        const auto hz = rate_of(state.rate);
        if (!hz) return Effect::none;
        end_prompt(state);
        state.asked = RateRequest{*state.rate_of, *hz};
        return Effect::ask_rate;
    }
    const bool is_of_rate = (key.character >= U'0' && key.character <= U'9') || key.character == U'.' ||
                            key.character == U'd';
    if (key.code == Code::character && is_of_rate && state.rate.size() < longest_rate)
        state.rate += static_cast<char>(key.character);
    return Effect::none;
}

void draw_columns(Grid& grid, int y, const State& state) {
    int x = 0;
    for (std::size_t i = 1; i < columns; ++i) {
        const auto column = static_cast<Column>(i);
        if (column == Column::was && state.frozen == nullptr) continue;
        x = grid.put(x + 1, y, fmt::format("{} {}", i, title_of(column)),
                     has_room(state, column, grid.size().width) ? Ink::accent : Ink::dim);
    }
    grid.put(x + 1, y, "esc", Ink::strong);
}

std::string message_text(const RowKey& key, const Snapshot& shown) {
    const auto* const message = shown.dialect->find(key.id);
    return fmt::format("{} from {}", message == nullptr ? fmt::format("#{}", key.id.value) : std::string(message->name),
                       source_text(key.source));
}

void draw_rate(Grid& grid, int y, const Snapshot& shown, const State& state) {
    const bool is_wrong = !state.rate.empty() && !rate_of(state.rate);
    auto x = grid.put(1, y, fmt::format("rate: {}_ Hz ", state.rate), is_wrong ? Ink::bad : Ink::accent);
    if (is_wrong) x = grid.put(x, y, "is no rate: 0 to 10000, or d ", Ink::bad);
    x = grid.put(x, y, message_text(*state.rate_of, shown), Ink::strong);
    grid.put(x + 2, y, "0 stops it, d: usual rate, enter asks", Ink::dim);
}

}  // namespace

Effect enter(State& state, const Key& key) {
    switch (state.prompt) {
        case Prompt::none: break;
        case Prompt::search: type_search(state, key); break;
        case Prompt::choice: choose_column(state, key); break;
        case Prompt::rate: return type_rate(state, key);
    }
    return Effect::none;
}

void draw_prompt(Grid& grid, int y, const Snapshot& shown, const State& state) {
    if (state.prompt == Prompt::choice) return draw_columns(grid, y, state);
    if (state.prompt == Prompt::rate) return draw_rate(grid, y, shown, state);
    const auto x = grid.put(0, y, "/" + state.search, Ink::strong);
    grid.put(x, y, "_", Ink::accent);
    grid.put_right(grid.size().width - 1, y, "enter keeps, esc ends the search", Ink::dim);
}

std::string answer_text(const Snapshot& shown, const State& state) {
    if (!state.asked) return {};
    const auto& its = state.asked->answer;
    const auto text = its.result       ? entry_text(*shown.dialect, "MAV_RESULT", *its.result)
                      : its.is_untaken ? "not asked: nobody was heard on the sources so far"
                                       : "asked, no answer so far";
    return fmt::format("{}: {}", message_text(state.asked->key, shown), text);
}

}  // namespace mavloom::view
