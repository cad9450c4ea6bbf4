// SPDX-License-Identifier: MIT
// TextTable: rows of text in columns, fitted to the width of a terminal. Pure; one owner thread.
//
// Widths count characters. If the columns need more room than there is, those of the highest rank are left out. Then
// the longest text column is shortened. Control characters become "?".
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mavloom::app {

class TextTable {
public:
    struct Column {
        std::string_view title;
        int rank = 0;  // 0: the column is never left out
        bool is_right = true;
    };
    struct Fitted {
        std::string text;     // lines, each with a newline
        bool is_cut = false;  // columns were left out, or texts were shortened
    };

    explicit TextTable(std::vector<Column> columns) : columns_(std::move(columns)) {}

    // One text for each column.
    void add_row(std::vector<std::string> cells);
    // Text below the last row. It is broken at blanks.
    void add_note(std::string text);
    [[nodiscard]] bool is_empty() const noexcept { return rows_.empty(); }
    [[nodiscard]] Fitted fitted(int width) const;

private:
    struct Row {
        std::vector<std::string> cells;
        std::string note{};
    };
    [[nodiscard]] std::vector<int> natural_widths() const;
    [[nodiscard]] std::string line_of(const std::vector<std::string>& cells, const std::vector<int>& widths) const;

    std::vector<Column> columns_;
    std::vector<Row> rows_;
};

}  // namespace mavloom::app
