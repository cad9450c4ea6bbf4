// SPDX-License-Identifier: MIT
#include "mavloom/base/shown.hpp"

#include <fmt/format.h>

namespace mavloom {

std::string printable(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(text[at]); };
        const bool is_c1 = byte(i) == 0xC2 && i + 1 < text.size() && byte(i + 1) >= 0x80 && byte(i + 1) < 0xA0;
        const bool is_control = is_c1 || byte(i) < 0x20 || byte(i) == 0x7F;
        result += is_control ? '?' : text[i];
        if (is_c1) ++i;
    }
    return result;
}

std::string shown(std::string_view text) {
    constexpr std::size_t longest = 120;
    std::string result = printable(text.substr(0, longest));
    if (text.size() > longest) result += "...";
    return result;
}

std::string in_quotes(std::string_view text) { return fmt::format("'{}'", shown(text)); }

}  // namespace mavloom
