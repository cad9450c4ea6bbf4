// SPDX-License-Identifier: MIT
#include "wrapped.hpp"

#include <algorithm>

namespace mavloom::app {

int characters_in(std::string_view text) { return static_cast<int>(std::ranges::count_if(text, begins_character)); }

std::string wrapped(std::string_view text, int width, int indent) {
    std::string all, line(text.substr(0, std::min(text.find_first_not_of(' '), text.size())));
    bool is_fresh = true;  // the line has no word yet
    for (auto at = line.size(); at < text.size();) {
        auto end = std::min(text.find(' ', at), text.size());
        if (text.substr(end).starts_with(" %")) end = std::min(text.find(' ', end + 1), text.size());
        const auto word = text.substr(at, end - at);
        at = end + 1;
        if (!is_fresh && characters_in(line) + 1 + characters_in(word) > width) {
            all += line + "\n";
            line.assign(static_cast<std::size_t>(indent), ' ');
            is_fresh = true;
        }
        if (!is_fresh) line += ' ';
        line += word;
        is_fresh = false;
    }
    return all + line + "\n";
}

}  // namespace mavloom::app
