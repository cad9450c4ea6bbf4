// SPDX-License-Identifier: MIT
// A table as texts of a bounded size, its pages, so that a large one fits into the queue of a client. All clients share
// a text. Private to module web; the caller serializes all calls.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace mavloom::web {

class Pages {
public:
    // Makes the text of a page: all its rows, or those that changed since the last turn. Empty if there is none.
    using Make = std::function<std::string(std::size_t page, bool all)>;

    explicit Pages(Make make) : make_(std::move(make)) {}

    // From now on there are so many pages with new texts.
    void begin_turn(std::size_t pages);
    [[nodiscard]] std::size_t size() const noexcept { return texts_.size(); }
    // Null if there is none.
    [[nodiscard]] std::shared_ptr<const std::string> text(std::size_t page, bool all);

private:
    struct Texts {
        std::shared_ptr<const std::string> all{}, changed{};
    };
    Make make_;
    std::vector<Texts> texts_;
};

// How far one client has read. A new one reads all rows. Later it reads what changed. One that is so slow that a turn
// passes meanwhile reads all again.
class PageReader {
public:
    void begin_turn() noexcept;
    // Null if this turn has no further text.
    [[nodiscard]] std::shared_ptr<const std::string> next(Pages& pages);

private:
    std::size_t next_ = 0;
    bool is_reading_ = false, missed_a_turn_ = true, wants_all_ = true;
};

}  // namespace mavloom::web
