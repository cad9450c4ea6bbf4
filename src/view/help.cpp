// SPDX-License-Identifier: MIT
#include <algorithm>

#include "view/table.hpp"
#include "view/words.hpp"

namespace mavloom::view {

namespace {

struct Help {
    std::string_view keys, text;
};

constexpr int narrow_help = 70;  // columns

constexpr std::array live{Help{"\u2191 \u2193 PgUp PgDn Home End", "select a message; j and k, too"},
                          Help{"Enter, Esc", "open the message, and go back"},
                          Help{"Tab, 1 to 5", "the next view; Messages, Vehicles, Links, Routes, Alarms"},
                          Help{"/", "search as you type: a name, #30, 1/1, a link"},
                          Help{"s, S, r", "sort by the next column, the one before; reverse"},
                          Help{"c", "choose the columns"},
                          Help{"space", "pause: the picture stands still, everything is counted on"},
                          Help{"f", "freeze: compare with this moment; again: end that"},
                          Help{"mouse", "click a view, a column or a message; the wheel scrolls"},
                          Help{"q", "quit"},
                          Help{"", ""},
                          Help{"+ green", "the message is new"},
                          Help{"! grey", "the message does not come any more"}};
constexpr std::array heard_now{Help{"i", "ask the sender to send this message at another rate"}};
constexpr std::array recorded{Help{"\u2190 \u2192", "10 seconds back and forward"},
                              Help{"space", "halt the recording, and go on"}, Help{"- +", "half and double speed"},
                              Help{"0 $", "to the begin and to the end"}, Help{"", ""}};

void add_lines(std::vector<Help>& lines, Help help, int keys_width, int text_width) {
    do {
        const auto keys = take_words(help.keys, keys_width);
        lines.push_back({keys, take_words(help.text, text_width)});
    } while (!help.keys.empty() || !help.text.empty());
}

}  // namespace

void draw_help(Grid& grid, int y, int end, bool plays, int& first) {
    const int width = grid.size().width, text = width < narrow_help ? 13 : 25;
    std::vector<Help> lines;
    for (const auto& help : plays ? std::span<const Help>(recorded) : heard_now)
        add_lines(lines, help, text - 2, width - text);
    for (const auto& help : live)
        if (!plays || help.keys != "space") add_lines(lines, help, text - 2, width - text);  // it halts a recording
    first = std::clamp(first, 0, std::max(0, static_cast<int>(lines.size()) - (end - y)));
    for (auto at = static_cast<std::size_t>(first); at < lines.size() && y < end; ++at, ++y) {
        grid.put(1, y, lines[at].keys, Ink::accent);
        grid.put(text, y, lines[at].text);
    }
}

}  // namespace mavloom::view
