// SPDX-License-Identifier: MIT
// State: what the user chose to see. `press` changes it by keys and the mouse. Pure; knows no terminal.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "mavloom/view/grid.hpp"
#include "mavloom/view/snapshot.hpp"

namespace mavloom::view {

enum class Tab : std::uint8_t { messages, vehicles, links, routes, alarms };
inline constexpr std::array tab_names{"Messages", "Vehicles", "Links", "Routes", "Alarms"};

// `name`, the first one, sorts by source: the tree of senders with their messages.
enum class Column : std::uint8_t { name, hz, was, age, gap_max, jitter, share, bytes, count, gap_min };
inline constexpr std::size_t columns = 10;

struct Key {
    enum class Code : std::uint8_t {
        character,
        up,
        down,
        left,
        right,
        page_up,
        page_down,
        home,
        end,
        enter,
        escape,
        backspace,
        tab,
        back_tab,
        click,
        scroll_up,
        scroll_down
    };
    Code code = Code::character;
    char32_t character = 0;
    int x = 0, y = 0;  // of the mouse
};

// The last line asks for a search, the columns or a rate, or for nothing.
enum class Prompt : std::uint8_t { none, search, choice, rate };

// The user wants a vehicle to send a message so often.
struct RateRequest {
    RowKey key{};
    double hz = 0;  // 0: not at all; negative: the vehicle's usual rate
    struct Answer {
        std::optional<std::uint8_t> result{};  // MAV_RESULT
        bool is_untaken = false;               // no source took the question
    };
    Answer answer{};
    // MAV_CMD_SET_MESSAGE_INTERVAL, param2.
    [[nodiscard]] float interval_us() const noexcept {
        return hz == 0 ? -1.F : hz < 0 ? 0.F : static_cast<float>(1e6 / hz);
    }
};

struct State {
    Tab tab = Tab::messages;
    std::optional<RowKey> selected{};
    std::array<int, tab_names.size()> first{};  // the first line that each view shows
    Column sort = Column::name;
    bool is_backwards = false;
    std::string search{};
    Prompt prompt = Prompt::none;
    std::uint32_t hidden = 0;  // columns, as bits
    std::string rate{};        // as typed so far
    std::optional<RowKey> rate_of{};
    std::optional<RateRequest> asked{};  // until the program removes it
    bool is_open = false;                // the selected message
    int field = 0, first_field = 0;
    bool shows_help = false;
    int first_help = 0;  // the first line of it that is shown
    std::shared_ptr<const Snapshot> paused{}, frozen{};
};

// The program must do this after a key.
enum class Effect : std::uint8_t { none, quit, halt, back, forward, slower, faster, to_begin, to_end, ask_rate };

// `shown` is the latest snapshot.
[[nodiscard]] Effect press(State& state, const std::shared_ptr<const Snapshot>& shown, const Key& key, Size size);

}  // namespace mavloom::view
