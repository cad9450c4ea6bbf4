// SPDX-License-Identifier: MIT
#include "mavloom/base/progress_meter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "mavloom/base/counted.hpp"
#include "mavloom/base/durations.hpp"

namespace mavloom {

namespace {

constexpr Nanoseconds rate_window = std::chrono::seconds(2);

std::string span_text(Nanoseconds time) {
    const auto s = static_cast<std::uint64_t>(std::max(0.0, seconds(time)));
    if (s >= 3600) return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
    return fmt::format("{:02}:{:02}", s / 60, s % 60);
}

std::string bar_of(double part) {
    constexpr std::size_t width = 20;
    const auto full = static_cast<std::size_t>(part * width);
    return fmt::format("[{:#<{}}{:.<{}}]", "", full, "", width - full);
}

// Meaningless until some of the work is done.
std::optional<Nanoseconds> time_left(double part, Nanoseconds elapsed) {
    constexpr double least = 0.001, longest_s = 360'000;
    const double left = part < least ? longest_s : seconds(elapsed) * (1 - part) / part;
    if (left >= longest_s) return std::nullopt;
    return std::chrono::duration_cast<Nanoseconds>(std::chrono::duration<double>(left));
}

// Of rank 0 is what stays even in the narrowest terminal.
struct Piece {
    std::string text;
    int rank;
};

std::string joined(const std::array<Piece, 7>& pieces, int highest) {
    std::string line;
    for (const auto& piece : pieces)
        if (piece.rank <= highest && !piece.text.empty()) line += (line.empty() ? "" : "  ") + piece.text;
    return line;
}

}  // namespace

std::string ProgressMeter::rate_text(const ProgressMade& made, MonoTime now) const {
    const double time = seconds(now - earlier_.time);
    if (time <= 0) return {};
    const auto rate = [&](std::uint64_t after, std::uint64_t before) {
        return static_cast<double>(after - std::min(before, after)) / time;
    };
    if (!made.frames) return amount_text(rate(made.bytes, earlier_.made.bytes)) + "/s";
    return fmt::format("{:.0f} frames/s", rate(*made.frames, earlier_.made.frames.value_or(0)));
}

std::string ProgressMeter::line(const ProgressMade& made, MonoTime now, int width) {
    if (now - later_.time >= rate_window) earlier_ = std::exchange(later_, Moment{now, made});
    const auto elapsed = now - begin_;
    const auto part = made.part ? std::optional(std::clamp(*made.part, 0.0, 1.0)) : std::nullopt;
    const auto left = part ? time_left(*part, elapsed) : std::nullopt;
    const std::array<Piece, 7> pieces{{{part ? bar_of(*part) : "", 6},
                                       {part ? fmt::format("{:3.0f} %", 100 * *part) : "", 0},
                                       {made.frames ? counted(*made.frames, "frame") : "", 1},
                                       {amount_text(static_cast<double>(made.bytes)), made.frames ? 5 : 1},
                                       {span_text(elapsed), 3},
                                       {rate_text(made, now), 4},
                                       {left ? span_text(*left) + " left" : "", 2}}};
    int highest = 6;
    while (highest > 0 && static_cast<int>(joined(pieces, highest).size()) >= width) --highest;
    return joined(pieces, highest);
}

}  // namespace mavloom
