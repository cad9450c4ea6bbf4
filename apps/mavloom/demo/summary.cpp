// SPDX-License-Identifier: MIT
#include "summary.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>

#include "mavloom/base/counted.hpp"
#include "mavloom/base/durations.hpp"
#include "mavloom/base/shown.hpp"
#include "mavloom/base/source_text.hpp"

namespace mavloom::app::demo_parts {

namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds print_interval = 1s, rate_window = 3s;

std::string text_of(const std::optional<LatencyFigures>& latency) {
    if (!latency) return "not measured yet";
    return fmt::format("median {:.2f} ms, 99 % {:.2f} ms, longest {:.2f} ms", milliseconds(latency->median),
                       milliseconds(latency->p99), milliseconds(latency->most));
}

// "stopped: 312 (sent to this hop while it was stopped)"
std::string losses_text(const Tally& tally) {
    std::string text;
    for (const auto& loss : tally.losses)
        text += fmt::format("{}{}: {} ({})", text.empty() ? "" : "; ", loss.name, loss.count, loss.help);
    return text;
}

// Of the terminal.
std::size_t columns() {
    winsize size{};
    return ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col != 0 ? size.ws_col : 80;
}

// Longer lines would take two rows, and the next table would not begin where this one did.
std::string cut(std::string_view text, std::size_t most) {
    std::string result;
    while (!text.empty()) {
        const auto line = text.substr(0, text.find('\n'));
        text.remove_prefix(line.size() + 1);
        result.append(line.substr(0, most)).push_back('\n');
    }
    return result;
}

bool is_station(const Tally& tally) { return tally.name == station_name; }

std::string remark(const Tally& tally) {
    const auto losses = losses_text(tally);
    std::string text = tally.is_up || is_station(tally) ? "" : tally.waits ? "waiting" : "STOPPED";
    for (const auto& more : {losses, tally.hint})
        if (!more.empty()) text += (text.empty() ? "" : "; ") + more;
    return text;
}

std::uint64_t count_open(const std::vector<observe::Alarm>& alarms) {
    return static_cast<std::uint64_t>(
        std::ranges::count_if(alarms, [](const observe::Alarm& alarm) { return !alarm.ended; }));
}

// "warning 1/1: battery at 15 %", for the newest ones.
std::vector<std::string> open_alarms(const std::vector<observe::Alarm>& alarms, std::size_t most) {
    std::vector<std::string> texts;
    for (const auto& alarm : alarms) {
        if (alarm.ended || texts.size() == most) continue;
        const bool is_error = alarm.severity == observe::Alarm::Severity::error;
        const auto source = alarm.source == Source{} ? std::string() : fmt::format(" {}", source_text(alarm.source));
        texts.push_back(fmt::format("{}{}: {}", is_error ? "error" : "warning", source, printable(alarm.text)));
    }
    return texts;
}

}  // namespace

void Summary::show(const State& state) {
    sample(state);
    if (state.now < due_) return;
    due_ = state.now + print_interval;
    if (!output_.full()) print(on_terminal_ ? table(state) : line(state));
}

void Summary::finish(const State& state) {
    sample(state);
    print(table(state));
    (void)output_.flush();
}

void Summary::sample(const State& state) {
    Sample sample{state.now, {}, {}};
    std::ranges::transform(state.tallies.all(), sample.in.begin(), &Tally::in);
    std::ranges::transform(state.tallies.all(), sample.out.begin(), &Tally::out);
    samples_.push_back(sample);
    while (samples_.size() > 2 && state.now - samples_[1].time >= rate_window) samples_.pop_front();
}

double Summary::rate(std::uint64_t now, std::uint64_t before, MonoTime time) const {
    const double span = seconds(time - samples_.front().time);
    return span > 0 ? static_cast<double>(now - before) / span : 0;
}

void Summary::print(std::string text) {
    if (on_terminal_) text = cut(text, columns());
    const auto lines = static_cast<std::size_t>(std::ranges::count(text, '\n'));
    // The terminal may have echoed ^C behind the table.
    const auto back = lines_ == 0 ? std::string() : fmt::format("\x1b[{}A", lines_);
    if (on_terminal_) {
        text = fmt::format("\r{}\x1b[J{}", back, text);
        lines_ = lines;
    }
    output_.buffer().append(text.data(), text.data() + text.size());
    (void)output_.flush_what_fits();
}

std::string Summary::table(const State& state) const {
    const auto& [tallies, latency, alarms, now] = state;
    std::string text = fmt::format("{:<16}{:>8}{:>8}{:>10}{:>10}{:>8}\n", "hop", "in/s", "out/s", "in", "out", "lost");
    std::string remarks;
    for (std::size_t i = 0; i < hop_count; ++i) {
        const Tally& tally = tallies.all()[i];
        const Sample& then = samples_.front();
        const auto rate_of = [&](std::uint64_t count, std::uint64_t before, bool is_there) {
            return is_there ? fmt::format("{:.1f}", rate(count, before, now)) : std::string("-");
        };
        const bool has_in = i != 0, has_out = i + 1 != hop_count;
        text += fmt::format("{:<16}{:>8}{:>8}{:>10}{:>10}{:>8}\n", tally.name, rate_of(tally.in, then.in[i], has_in),
                            rate_of(tally.out, then.out[i], has_out), has_in ? fmt::format("{}", tally.in) : "-",
                            has_out ? fmt::format("{}", tally.out) : "-", tally.lost);
        if (const auto what = remark(tally); !what.empty()) remarks += fmt::format("{}: {}\n", tally.name, what);
    }
    for (const auto& alarm : open_alarms(alarms, 2)) remarks += alarm + "\n";
    return fmt::format("{}vehicle to ground station: {}\n{:.0f} s; {} from ground stations; {} now\n{}", text,
                       text_of(latency), seconds(now - began_), counted(tallies.answers(), "frame"),
                       counted(count_open(alarms), "alarm"), remarks);
}

std::string Summary::line(const State& state) const {
    const auto& [tallies, latency, alarms, now] = state;
    const Tally& last = tallies.all().back();
    std::string text = fmt::format("{:.0f} s: ", seconds(now - began_));
    if (samples_.size() > 1) text += fmt::format("{:.1f} frames/s, ", rate(last.in, samples_.front().in.back(), now));
    text += fmt::format("{} at the end of the chain", counted(last.in, "frame"));
    std::uint64_t lost = 0;
    for (const Tally& tally : tallies.all()) {
        lost += tally.lost;
        const auto what = is_station(tally) ? std::string() : remark(tally);
        if (!what.empty()) text += fmt::format("; {}: {}", tally.name, what);
    }
    text += fmt::format("; {} lost; latency {}", lost, text_of(latency));
    for (const auto& alarm : open_alarms(alarms, 1))
        text += fmt::format("; {}, the newest: {}", counted(count_open(alarms), "alarm"), alarm);
    return text + "\n";
}

}  // namespace mavloom::app::demo_parts
