// SPDX-License-Identifier: MIT
#include "web/report/pages.hpp"

#include <utility>

namespace mavloom::web {

void Pages::begin_turn(std::size_t pages) { texts_.assign(pages, {}); }

std::shared_ptr<const std::string> Pages::text(std::size_t page, bool all) {
    auto& text = all ? texts_[page].all : texts_[page].changed;
    if (text == nullptr) text = std::make_shared<const std::string>(make_(page, all));
    return text->empty() ? nullptr : text;
}

void PageReader::begin_turn() noexcept {
    if (is_reading_) {
        missed_a_turn_ = true;
        return;
    }
    wants_all_ = std::exchange(missed_a_turn_, false);
    is_reading_ = true;
    next_ = 0;
}

std::shared_ptr<const std::string> PageReader::next(Pages& pages) {
    while (is_reading_ && next_ < pages.size())
        if (auto text = pages.text(next_++, wants_all_)) return text;
    is_reading_ = false;
    return nullptr;
}

}  // namespace mavloom::web
