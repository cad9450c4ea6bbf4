// SPDX-License-Identifier: MIT
#include "ctl/text_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "mavloom/base/shown.hpp"
#include "wrapped.hpp"

namespace mavloom::app {

namespace {

constexpr int between_columns = 2, narrowest_text = 12, note_indent = 4;
constexpr int left_out = -1;  // the width of a column without room

// Where the character of this number begins.
std::size_t character_place(std::string_view text, int character) {
    std::size_t at = 0;
    for (; at < text.size(); ++at)
        if (begins_character(text[at]) && character-- == 0) break;
    return at;
}

// Leaves both ends: those of a link's name are its endpoint and its peer.
std::string shortened(const std::string& text, int width) {
    constexpr std::string_view gap = "..";
    const int length = characters_in(text), kept = width - static_cast<int>(gap.size());
    if (length <= width || kept < 2) return text;
    const int tail = kept - kept / 3;
    return text.substr(0, character_place(text, kept / 3)).append(gap) +
           text.substr(character_place(text, length - tail));
}

int needed(const std::vector<int>& widths) {
    int sum = -between_columns;
    for (const int width : widths)
        if (width != left_out) sum += width + between_columns;
    return sum;
}

}  // namespace

void TextTable::add_row(std::vector<std::string> cells) {
    for (auto& cell : cells) cell = printable(cell);
    rows_.push_back({std::move(cells)});
}

void TextTable::add_note(std::string text) { rows_.back().note = printable(text); }

std::vector<int> TextTable::natural_widths() const {
    std::vector<int> widths;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
        widths.push_back(characters_in(columns_[i].title));
        for (const auto& row : rows_) widths[i] = std::max(widths[i], characters_in(row.cells[i]));
    }
    return widths;
}

std::string TextTable::line_of(const std::vector<std::string>& cells, const std::vector<int>& widths) const {
    std::string line;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
        if (widths[i] == left_out) continue;
        const auto cell = columns_[i].is_right ? cells[i] : shortened(cells[i], widths[i]);
        const std::string blanks(static_cast<std::size_t>(std::max(0, widths[i] - characters_in(cell))), ' ');
        if (!line.empty()) line.append(between_columns, ' ');
        line += columns_[i].is_right ? blanks + cell : cell + blanks;
    }
    line.erase(line.find_last_not_of(' ') + 1);
    return line + "\n";
}

TextTable::Fitted TextTable::fitted(int width) const {
    auto widths = natural_widths();
    Fitted out;
    int highest = std::ranges::max(columns_, {}, &Column::rank).rank;
    for (; needed(widths) > width && highest > 0; --highest)
        for (std::size_t i = 0; i < columns_.size(); ++i)
            if (columns_[i].rank == highest) {
                widths[i] = left_out;
                out.is_cut = true;
            }
    std::size_t longest = 0;
    for (std::size_t i = 0; i < columns_.size(); ++i)
        if (!columns_[i].is_right && (columns_[longest].is_right || widths[i] > widths[longest])) longest = i;
    if (const int over = needed(widths) - width; over > 0 && !columns_[longest].is_right) {
        widths[longest] = std::min(widths[longest], std::max(narrowest_text, widths[longest] - over));
        out.is_cut = true;
    }
    std::vector<std::string> titles;
    titles.reserve(columns_.size());
    for (const auto& column : columns_) titles.emplace_back(column.title);
    out.text = line_of(titles, widths);
    for (const auto& row : rows_) {
        out.text += line_of(row.cells, widths);
        if (!row.note.empty()) out.text += wrapped("  " + row.note, width, note_indent);
    }
    return out;
}

}  // namespace mavloom::app
