// SPDX-License-Identifier: MIT
// The programs of a demo, each a process of its own, in the order in which the vehicle's frames pass them:
//
//   mavloom sim -> mavloom route -> python -m mavloom.hear -> mavloom relay -> ground station
//
// One owner thread.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "child.hpp"
#include "places.hpp"

namespace mavloom::app::demo_parts {

enum class Stage : std::uint8_t { vehicle, router, listener, relay };
inline constexpr std::array stage_names{std::string_view("vehicle"), std::string_view("router"),
                                        std::string_view("listener"), std::string_view("relay")};

struct ChainOptions {
    Places places;
    std::string source;                 // the endpoint of a real vehicle; empty: one is simulated
    std::string python;                 // the interpreter that has the package mavloom; empty: it is searched for
    std::optional<std::uint16_t> copy;  // where the relay sends everything once more
};

class Chain {
public:
    explicit Chain(ChainOptions options) : options_(std::move(options)) {}
    ~Chain();

    // Starts all programs. Returns when the listener listens and the router runs, so that no frame is lost.
    // `gives_up` is asked while it waits.
    [[nodiscard]] SetupResult<void> start(const std::function<bool()>& gives_up);

    // The program of a stage; null if there never was one (a real vehicle).
    [[nodiscard]] const Child* program(Stage stage) const noexcept;
    [[nodiscard]] bool is_up(Stage stage) const noexcept;
    // Why a real vehicle was not heard yet, as far as the router knows.
    [[nodiscard]] std::string why_not_heard() const;
    // Reads what the programs printed, and waits for more until `end` at most. Returns programs that ended by
    // themselves since the last call: "the relay ended with status 1: ...".
    [[nodiscard]] std::vector<std::string> look(MonoTime end);

    // Ends one program, and waits for its end.
    void stop(Stage stage);
    // Ends the vehicle's stream; its counters stay. The router closes its link to a real vehicle, which flies on.
    void stop_vehicle();
    // Ends all programs, in the order of the frames. Removes what killed ones left.
    void stop_all();

private:
    [[nodiscard]] std::vector<std::string> words_of(Stage stage) const;
    [[nodiscard]] SetupResult<void> start(Stage stage);
    [[nodiscard]] SetupResult<void> wait_for_listener(const std::function<bool()>& gives_up);
    [[nodiscard]] SetupError listener_failed() const;
    void remove_left_by(Stage stage, const std::string& name) const;
    [[nodiscard]] std::optional<Child>& at(Stage stage) noexcept { return programs_[static_cast<std::size_t>(stage)]; }

    ChainOptions options_;
    std::array<std::optional<Child>, stage_names.size()> programs_;
    std::array<bool, stage_names.size()> was_up_{};
};

}  // namespace mavloom::app::demo_parts
