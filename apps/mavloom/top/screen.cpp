// SPDX-License-Identifier: MIT
#include "top/screen.hpp"

#define NCURSES_NOMACROS 1  // NOLINT(readability-identifier-naming): ncurses' name
#define NCURSES_WIDECHAR 1  // NOLINT(readability-identifier-naming): ncurses' name
#include <langinfo.h>
#include <ncurses.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <clocale>
#include <cstring>

#include "output.hpp"

namespace mavloom::app {

namespace {

using view::Ink;
using Code = view::Key::Code;

constexpr int escape_ms = 25;  // the keys of a terminal come as sequences that begin with Esc

struct Color {
    Ink ink;
    short number;
};
constexpr std::array colors{Color{Ink::accent, COLOR_CYAN}, Color{Ink::good, COLOR_GREEN},
                            Color{Ink::warning, COLOR_YELLOW}, Color{Ink::bad, COLOR_RED}};

attr_t style_of(Ink ink) {
    switch (ink) {
        case Ink::plain:
        case Ink::good: return A_NORMAL;
        case Ink::dim: return A_DIM;
        case Ink::strong:
        case Ink::accent:
        case Ink::warning:
        case Ink::bad: break;
    }
    return A_BOLD;
}

struct NamedKey {
    int key;
    Code code;
};
constexpr std::array named_keys{NamedKey{KEY_UP, Code::up},         NamedKey{KEY_DOWN, Code::down},
                                NamedKey{KEY_LEFT, Code::left},     NamedKey{KEY_RIGHT, Code::right},
                                NamedKey{KEY_PPAGE, Code::page_up}, NamedKey{KEY_NPAGE, Code::page_down},
                                NamedKey{KEY_HOME, Code::home},     NamedKey{KEY_END, Code::end},
                                NamedKey{KEY_ENTER, Code::enter},   NamedKey{KEY_BACKSPACE, Code::backspace},
                                NamedKey{KEY_BTAB, Code::back_tab}};

std::optional<view::Key> mouse_key() {
    MEVENT event{};
    if (::getmouse(&event) != OK) return std::nullopt;
    view::Key key{.x = event.x, .y = event.y};
    if ((event.bstate & BUTTON4_PRESSED) != 0) key.code = Code::scroll_up;
    else if ((event.bstate & BUTTON5_PRESSED) != 0) key.code = Code::scroll_down;
    else if ((event.bstate & (BUTTON1_PRESSED | BUTTON1_CLICKED)) != 0) key.code = Code::click;
    else return std::nullopt;
    return key;
}

std::optional<view::Key> special_key(int key) {
    if (key == KEY_MOUSE) return mouse_key();
    for (const auto& named : named_keys)
        if (named.key == key) return view::Key{.code = named.code};
    return std::nullopt;  // among them KEY_RESIZE: the next grid has the new size
}

view::Key typed_key(wint_t typed) {
    switch (typed) {
        case '\r':
        case '\n': return {.code = Code::enter};
        case '\t': return {.code = Code::tab};
        case 0x1b: return {.code = Code::escape};
        case 0x08:
        case 0x7f: return {.code = Code::backspace};
        default: return {.code = Code::character, .character = static_cast<char32_t>(typed)};
    }
}

}  // namespace

struct Screen::Terminal {
    SCREEN* screen = nullptr;
    std::optional<view::Grid> last;
    bool has_color = false;
};

view::Glyphs Screen::glyphs() {
    std::setlocale(LC_CTYPE, "");
    return std::strcmp(::nl_langinfo(CODESET), "UTF-8") == 0 ? view::Glyphs::unicode : view::Glyphs::ascii;
}

std::unique_ptr<Screen> Screen::open() {
    auto terminal = std::make_unique<Terminal>();
    terminal->screen = ::newterm(nullptr, stdout, stdin);
    if (terminal->screen == nullptr) return nullptr;
    return std::unique_ptr<Screen>(new Screen(std::move(terminal)));
}

Screen::Screen(std::unique_ptr<Terminal> terminal) : terminal_(std::move(terminal)) {
    ::set_escdelay(escape_ms);
    ::cbreak();
    ::noecho();
    ::curs_set(0);
    ::keypad(stdscr, TRUE);
    ::nodelay(stdscr, TRUE);
    ::mousemask(BUTTON1_PRESSED | BUTTON1_CLICKED | BUTTON4_PRESSED | BUTTON5_PRESSED, nullptr);
    ::mouseinterval(0);
    if (!wants_color() || !::has_colors() || ::start_color() != OK) return;
    terminal_->has_color = ::use_default_colors() == OK;
    for (const auto& color : colors) ::init_pair(static_cast<short>(color.ink), color.number, -1);
}

Screen::~Screen() {
    ::endwin();
    ::delscreen(terminal_->screen);
}

// ncurses takes the size from LINES and COLUMNS if they are set, which may be those of another terminal.
view::Size Screen::size() const {
    winsize now{};
    if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &now) == 0 && now.ws_row != 0 && now.ws_col != 0 &&
        ::is_term_resized(now.ws_row, now.ws_col))
        ::resizeterm(now.ws_row, now.ws_col);
    return {::getmaxx(stdscr), ::getmaxy(stdscr)};
}

void Screen::show(const view::Grid& grid) {
    auto& last = terminal_->last;
    const bool is_same_size = last && last->size() == grid.size();
    if (!is_same_size) ::clear();  // paints all: a terminal that changes its size moves what it shows
    for (int y = 0; y < grid.size().height; ++y) {
        for (int x = 0; x < grid.size().width; ++x) {
            const auto& cell = grid.at(x, y);
            if (is_same_size && last->at(x, y) == cell) continue;
            const std::array<wchar_t, 2> text{static_cast<wchar_t>(cell.glyph), 0};
            const auto style = style_of(cell.ink) | (cell.is_reversed ? A_REVERSE : A_NORMAL);
            const bool is_colored = terminal_->has_color && cell.ink >= Ink::accent;
            cchar_t character{};
            ::setcchar(&character, text.data(), style, is_colored ? static_cast<short>(cell.ink) : short{0}, nullptr);
            ::mvadd_wch(y, x, &character);
        }
    }
    ::refresh();
    last = grid;
}

std::optional<view::Key> Screen::key() {
    for (;;) {
        wint_t typed = 0;
        const int kind = ::get_wch(&typed);
        if (kind == ERR) return std::nullopt;
        if (kind != KEY_CODE_YES) return typed_key(typed);
        if (const auto key = special_key(static_cast<int>(typed))) return key;
    }
}

bool Screen::wait(std::chrono::milliseconds time) {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    return ::poll(&input, 1, static_cast<int>(time.count())) <= 0 || (input.revents & (POLLHUP | POLLERR)) == 0;
}

}  // namespace mavloom::app
