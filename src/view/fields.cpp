// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "mavloom/message/format.hpp"
#include "view/table.hpp"
#include "view/words.hpp"

namespace mavloom::view {

namespace {

constexpr int min_height_with_plot = 12, min_plot = 6, max_plot = 14;
constexpr int min_width_with_counts = 70;
constexpr int names_end = 30, then_width = 24;
constexpr int min_spark = 6, max_spark = 16;
constexpr std::size_t spark_points = 256;

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

std::vector<Point> points_of(const FieldLine& line, const Snapshot& shown, const Row& row,
                             std::size_t most = History::max_payloads) {
    const bool is_text = line.field->is_array() && !line.element;
    if (is_text || !shown.history.is_of(row.key())) return {};
    return shown.history.points({line.field, line.element.value_or(0)}, shown.now.wall, most);
}

// The newest part of a plot is at its right end, so the value covers the oldest part if it needs the room.
void draw_field(Grid& grid, int y, const FieldLine& line, const Snapshot& shown, const Row& row, const Row* then) {
    const int width = grid.size().width, names = std::min(names_end, width * 2 / 5);
    const int spark_width = std::clamp(width / 6, min_spark, max_spark), spark = width - 1 - spark_width;
    draw_spark(grid, spark, y, spark_width, points_of(line, shown, row, spark_points), shown.now.wall);
    grid.put(1, y, label_of(line, row, *shown.dialect), Ink::dim, names - 1);
    const auto value = value_of(line, row, *shown.dialect);
    const auto before = then == nullptr ? value : value_of(line, *then, *shown.dialect);
    int end = grid.put(names, y, value, value == before ? Ink::plain : Ink::accent);
    end = grid.put(end, y, " ");
    if (then != nullptr) grid.put(std::max(end, spark - then_width), y, fmt::format("then {} ", before), Ink::dim);
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
    return height < min_height_with_plot ? height : height - std::clamp(height * 2 / 5, min_plot, max_plot);
}

void draw_message_head(Grid& grid, int y, const Snapshot& shown, const Row& row) {
    const auto& its = row.its.traffic;
    auto rate = row.is_silent ? "silent" : hz_text(row.hz) + " Hz";
    if (grid.size().width >= min_width_with_counts)
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
        draw_plot(grid, y + rows, end, points_of(lines[at], shown, row), shown.now.wall,
                  label_of(lines[at], row, *shown.dialect));
}

}  // namespace mavloom::view
