// SPDX-License-Identifier: MIT
// The live summary of a demo on stdout: a table in place on a terminal, else one line a second. One owner thread.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "latency.hpp"
#include "mavloom/observe/alarm.hpp"
#include "output.hpp"
#include "tallies.hpp"

namespace mavloom::app::demo_parts {

struct State {
    const Tallies& tallies;
    std::optional<LatencyFigures> latency;
    std::vector<observe::Alarm> alarms;  // newest first
    MonoTime now;
};

class Summary {
public:
    explicit Summary(bool on_terminal) : on_terminal_(on_terminal) {}

    // Prints the state if it is time. Never waits for the reader.
    void show(const State& state);
    // Prints the table, on a terminal or not.
    void finish(const State& state);
    // The next table is printed below what another writer prints on the terminal.
    void release() noexcept { lines_ = 0; }

private:
    struct Sample {
        MonoTime time;
        std::array<std::uint64_t, hop_count> in, out;
    };
    void sample(const State& state);
    [[nodiscard]] double rate(std::uint64_t now, std::uint64_t before, MonoTime time) const;
    void print(std::string text);
    [[nodiscard]] std::string table(const State& state) const;
    [[nodiscard]] std::string line(const State& state) const;

    bool on_terminal_;
    Output output_;
    std::deque<Sample> samples_;  // of the last seconds
    std::size_t lines_ = 0;       // of the table on the terminal
    MonoTime began_ = mono_now(), due_{};
};

}  // namespace mavloom::app::demo_parts
