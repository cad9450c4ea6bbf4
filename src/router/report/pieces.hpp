// SPDX-License-Identifier: MIT
// A text in pieces: lists of rows, one after the other, each row formatted when its piece is due.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace mavloom::router {

// Appends the text of row `index` of a list. Returns false if the list has no such row.
using AppendRow = std::function<bool(std::string& text, std::size_t index)>;

// `rows` must exist as long as the result. It may still be empty now.
template <class Rows, class Append>
[[nodiscard]] AppendRow each_of(const Rows& rows, Append append) {
    return [&rows, append = std::move(append)](std::string& text, std::size_t index) {
        if (index >= rows.size()) return false;
        append(text, rows[index]);
        return true;
    };
}

// Appends one row.
template <class Append>
[[nodiscard]] AppendRow once(Append append) {
    return [append = std::move(append)](std::string& text, std::size_t index) {
        if (index == 0) append(text);
        return index == 0;
    };
}

class Pieces {
public:
    static constexpr std::size_t piece_bytes = 65536;

    explicit Pieces(std::vector<AppendRow> lists) : lists_(std::move(lists)) {}
    // Returns the next piece; empty after the last.
    [[nodiscard]] std::string operator()() {
        std::string text;
        while (list_ < lists_.size() && text.size() < piece_bytes) {
            if (lists_[list_](text, row_)) ++row_;
            else ++list_, row_ = 0;
        }
        return text;
    }

private:
    std::vector<AppendRow> lists_;
    std::size_t list_ = 0, row_ = 0;
};

}  // namespace mavloom::router
