// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "mavloom/message/format.hpp"
#include "view/table.hpp"
#include "view/words.hpp"

namespace mavloom::view {

namespace {

constexpr int least_height_with_plot = 12, least_plot = 6, most_plot = 14;
constexpr int least_width_with_counts = 70;
constexpr int names_end = 30, then_width = 24;

using message::MessageView;
using message::TextBuffer;

MessageView view_of(const Row& row) { return {*row.its.message, row.its.payload()}; }

std::string label_of(const FieldLine& line, const Row& row, const dialect::Dialect& dialect) {
    TextBuffer text;
    message::append_field_label(text, view_of(row), *line.field, dialect);
    return line.element ? fmt::format("{}[{}]", std::string_view(text.data(), text.size()), *line.element)
                        : fmt::to_string(text);
}

std::string value_of(const FieldLine& line, const Row& row, const dialect::Dialect& dialect) {
    TextBuffer text;
    if (line.element) message::append_element(text, view_of(row), *line.field, *line.element);
    else message::append_field_value(text, view_of(row), *line.field, dialect);
    return fmt::to_string(text);
}

void draw_field(Grid& grid, int y, const FieldLine& line, const Snapshot& shown, const Row& row, const Row* then) {
    const int names = std::min(names_end, grid.size().width * 2 / 5);
    grid.put(1, y, label_of(line, row, *shown.dialect), Ink::dim, names - 1);
    const auto value = value_of(line, row, *shown.dialect);
    if (then == nullptr) return void(grid.put(names, y, value));
    const auto before = value_of(line, *then, *shown.dialect);
    const int end = std::max(names, grid.size().width - then_width);
    grid.put(names, y, value, value == before ? Ink::plain : Ink::accent, end - 1);
    grid.put(end, y, "then " + before, Ink::dim);
}

// Of a message without definition.
void draw_bytes(Grid& grid, int y, int end, const Row& row) {
    grid.put(1, y++, "no definition of this message: type --dialect FILE.xml", Ink::warning);
    constexpr std::size_t a_line = 16;
    const auto bytes = row.its.payload();
    for (std::size_t i = 0; i < bytes.size() && y < end; i += a_line, ++y) {
        std::string text = fmt::format("{:3}  ", i);
        for (const auto byte : bytes.subspan(i, std::min(a_line, bytes.size() - i)))
            text += fmt::format("{:02x} ", byte);
        grid.put(1, y, text);
    }
}

}  // namespace

std::vector<FieldLine> fields_of(const Row& row) {
    std::vector<FieldLine> lines;
    if (row.its.message == nullptr) return lines;
    for (const auto& field : row.its.message->fields) {
        if (!message::has_elements(field)) lines.push_back({&field});
        else
            for (std::size_t i = 0; i < field.count(); ++i) lines.push_back({&field, i});
    }
    return lines;
}

int field_lines(int y, int end) noexcept {
    const int height = end - y;
    return height < least_height_with_plot ? height : height - std::clamp(height * 2 / 5, least_plot, most_plot);
}

void draw_message_head(Grid& grid, int y, const Snapshot& shown, const Row& row) {
    const auto& its = row.its.traffic;
    auto rate = hz_text(row.hz) + " Hz";
    if (grid.size().width >= least_width_with_counts)
        rate += fmt::format(", {} frames, {} ago", count_text(its.count), time_text(shown.now.mono - row.its.heard));
    const int end = grid.size().width - 1 - width_of(rate) - 1;
    const auto x = grid.put(1, y, name_of(row.its), Ink::accent, end);
    grid.put(x + 1, y, fmt::format("#{} of {}", its.id.value, source_text(its.source)), Ink::dim, end);
    grid.put_right(grid.size().width - 1, y, rate, Ink::strong);
}

void draw_message(Grid& grid, int y, int end, const Snapshot& shown, const State& state, const Row& row) {
    if (row.its.message == nullptr) return draw_bytes(grid, y, end, row);
    const auto lines = fields_of(row);
    const int rows = field_lines(y, end);
    const auto* const then = state.frozen ? state.frozen->find(row.key()) : nullptr;
    for (int i = 0; i < rows && state.first_field + i < static_cast<int>(lines.size()); ++i) {
        const int at = state.first_field + i;
        draw_field(grid, y + i, lines[static_cast<std::size_t>(at)], shown, row, then);
        if (at == state.field) grid.reverse(y + i);
    }
    const auto at = static_cast<std::size_t>(state.field);
    if (y + rows < end && at < lines.size())
        draw_plot(grid, y + rows, end, shown, label_of(lines[at], row, *shown.dialect));
}

std::optional<Number> plotted(const State& state, const Snapshot& shown) {
    const auto* const row = state.is_open ? shown.find(state.selected) : nullptr;
    if (row == nullptr) return std::nullopt;
    const auto lines = fields_of(*row);
    const auto at = static_cast<std::size_t>(state.field);
    if (at >= lines.size() || (lines[at].field->is_array() && !lines[at].element)) return std::nullopt;
    return Number{lines[at].field, lines[at].element.value_or(0)};
}

}  // namespace mavloom::view
