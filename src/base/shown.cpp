// SPDX-License-Identifier: MIT
#include "mavloom/base/shown.hpp"

namespace mavloom {

std::string shown(std::string_view text) {
    constexpr std::size_t longest = 120;
    std::string result(text.substr(0, longest));
    for (char& c : result)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    if (text.size() > longest) result += "...";
    return result;
}

std::string in_quotes(std::string_view text) { return "'" + shown(text) + "'"; }

}  // namespace mavloom
