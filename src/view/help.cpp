// SPDX-License-Identifier: MIT
#include "view/table.hpp"

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

void draw(Grid& grid, int& y, int end, std::span<const Help> lines) {
    const int text = grid.size().width < narrow_help ? 13 : 25;
    for (const auto& line : lines) {
        if (y >= end) return;
        grid.put(1, y, line.keys, Ink::accent, text - 1);
        grid.put(text, y++, line.text);
    }
}

}  // namespace

void draw_help(Grid& grid, int y, int end, bool plays) {
    draw(grid, y, end, plays ? std::span<const Help>(recorded) : heard_now);
    draw(grid, y, end, live);
}

}  // namespace mavloom::view
