// SPDX-License-Identifier: MIT
// Screen: shows grids of cells in the terminal and reads its keys and mouse. A thin layer over ncurses, which only
// screen.cpp includes. One thread; one Screen at a time. The destructor restores the terminal.
#pragma once

#include <chrono>
#include <memory>
#include <optional>

#include "mavloom/view/grid.hpp"
#include "mavloom/view/state.hpp"

namespace mavloom::app {

class Screen {
public:
    // Whether the terminal can place its cursor. One that is called "dumb", or whose description is missing, cannot.
    [[nodiscard]] static bool is_possible();
    // Unicode if the locale of the environment is UTF-8.
    [[nodiscard]] static view::Glyphs glyphs();

    // Null if the terminal cannot be used.
    [[nodiscard]] static std::unique_ptr<Screen> open();
    ~Screen();
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;

    [[nodiscard]] view::Size size() const;
    void show(const view::Grid& grid);
    // Empty if no key was pressed. Never waits.
    [[nodiscard]] std::optional<view::Key> key();
    // Waits for a key, a signal or the time. Returns false if the terminal is gone.
    [[nodiscard]] static bool wait(std::chrono::milliseconds time);

private:
    struct Terminal;
    explicit Screen(std::unique_ptr<Terminal> terminal);
    std::unique_ptr<Terminal> terminal_;
};

}  // namespace mavloom::app
