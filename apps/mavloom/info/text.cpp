// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "entry_text.hpp"
#include "info/reports.hpp"
#include "mavloom/base/counted.hpp"
#include "mavloom/base/durations.hpp"
#include "mavloom/base/shown.hpp"
#include "mavloom/base/source_text.hpp"
#include "mavloom/observe/loss.hpp"
#include "mavloom/observe/summarizer.hpp"

namespace mavloom::app {

namespace {

using observe::SenderSummary;
using Out = std::back_insert_iterator<std::string>;

// "0:01:12.3"
std::string clock_text(Nanoseconds time) {
    const auto tenths = time.count() / 100'000'000;
    return fmt::format("{}:{:02}:{:02}.{}", tenths / 36'000, tenths / 600 % 60, tenths / 10 % 60, tenths % 10);
}

// "48.3 s", "1 min 48 s", "2 h 05 min"
std::string duration_text(Nanoseconds time) {
    const auto whole = std::llround(seconds(time));
    if (whole < 60) return fmt::format("{:.1f} s", seconds(time));
    if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

// Lines of "  label     value". A label is printed once.
class Labelled {
public:
    explicit Labelled(Out out) : out_(out) {}
    void add(std::string_view label, std::string_view value) {
        fmt::format_to(out_, "  {:<10}{}\n", label == last_ ? "" : label, value);
        last_ = label;
    }

private:
    Out out_;
    std::string_view last_;
};

// Longer lists are for --json.
constexpr std::size_t max_rows = 30, max_jumps = 5;

template <class Row>
std::span<const Row> shown_of(const std::vector<Row>& rows, std::size_t most = max_rows) {
    return std::span(rows).first(std::min(rows.size(), most));
}
template <class Row>
std::string more_text(const std::vector<Row>& rows, std::size_t most = max_rows) {
    return rows.size() <= most ? "" : fmt::format("... and {} more (--json has all)", rows.size() - most);
}

std::string damage_text(const RecordingInfo& info) {
    std::string text;
    if (info.damaged_places != 0)
        text = fmt::format("{} lost in {}", counted(info.lost_bytes, "byte"),
                           counted(info.damaged_places, "damaged place"));
    if (info.unknown_flags != 0)
        text += fmt::format("{}{} with an unknown incompatibility flag", text.empty() ? "" : ", ",
                            counted(info.unknown_flags, "frame"));
    return text.empty() ? "none" : text;
}

void append_head(Out out, const RecordingInfo& info) {
    const auto& all = info.summary;
    fmt::format_to(out, "{}\n", printable(info.file));
    Labelled lines(out);
    lines.add("size", fmt::format("{}, {}", amount_text(static_cast<double>(info.size)), counted(all.frames, "frame")));
    if (all.begin) {
        lines.add("begin", utc_text(*all.begin) + " UTC");
        lines.add("end", utc_text(*all.end) + " UTC");
        lines.add("duration", duration_text(all.duration));
    }
    const auto jumps = shown_of(all.clock_jumps, max_jumps);
    for (const auto& jump : jumps)
        lines.add("jumps", fmt::format("{}  the time goes {} by {}", clock_text(jump.when.at),
                                       jump.step < Nanoseconds{} ? "back" : "forward",
                                       duration_text(std::chrono::abs(jump.step))));
    if (const auto more = more_text(all.clock_jumps, max_jumps); !more.empty()) lines.add("jumps", more);
    lines.add("damage", damage_text(info));
}

std::string mode_text(const observe::ModePeriod& period) {
    return period.name.empty() ? fmt::format("mode {}", period.custom_mode) : std::string(period.name);
}

void append_periods(Labelled& lines, const SenderSummary& vehicle) {
    std::size_t width = 0;
    for (const auto& mode : vehicle.modes) width = std::max(width, mode_text(mode).size());
    for (const auto& mode : shown_of(vehicle.modes))
        lines.add("modes", fmt::format("{}  {:<{}}  for {}", clock_text(mode.begin.at), mode_text(mode), width,
                                       duration_text(mode.duration)));
    if (const auto more = more_text(vehicle.modes); !more.empty()) lines.add("modes", more);
    for (const auto& armed : shown_of(vehicle.armed))
        lines.add("armed", fmt::format("{}  for {}", clock_text(armed.begin.at), duration_text(armed.duration)));
    if (const auto more = more_text(vehicle.armed); !more.empty()) lines.add("armed", more);
    if (vehicle.armed.empty() && vehicle.has_heartbeat) lines.add("armed", "never");
}

void append_journey(Labelled& lines, const observe::Journey& journey) {
    if (!journey.first) return;
    const auto home = journey.highest_relative_alt_m
                          ? fmt::format("{:.1f} m above home, ", *journey.highest_relative_alt_m)
                          : "";
    lines.add("altitude", fmt::format("highest {}{:.1f} m above sea level", home, *journey.highest_alt_m));
    if (journey.highest_speed_m_s) lines.add("speed", fmt::format("highest {:.1f} m/s", *journey.highest_speed_m_s));
    lines.add("distance", journey.distance_m < 10'000 ? fmt::format("{:.0f} m", journey.distance_m)
                                                      : fmt::format("{:.1f} km", journey.distance_m / 1e3));
    for (const auto& [name, fix] : {std::pair{"first", *journey.first}, std::pair{"last", *journey.last}})
        lines.add("position", fmt::format("{:<5}  {:.7f} {:.7f}, {:.1f} m", name, fix.lat_deg, fix.lon_deg, fix.alt_m));
}

void append_battery(Labelled& lines, const observe::BatteryUse& use) {
    const auto add = [&](auto first, auto last, auto lowest, std::string_view format) {
        if (!first || !last || !lowest) return;
        const auto text = [&](double value) { return fmt::format(fmt::runtime(format), value); };
        lines.add("battery", fmt::format("{} to {}, lowest {}", text(*first), text(*last), text(*lowest)));
    };
    add(use.first.percent, use.last.percent, use.lowest_percent, "{:.0f} %");
    add(use.first.voltage_v, use.last.voltage_v, use.lowest_voltage_v, "{:.2f} V");
}

void append_vehicle(Out out, const SenderSummary& vehicle, const dialect::Dialect& dialect) {
    fmt::format_to(out, "\nvehicle {}\n", source_text(vehicle.source));
    Labelled lines(out);
    lines.add("kind", kind_text(vehicle, dialect));
    if (vehicle.firmware) {
        const auto& git = vehicle.firmware->git;
        lines.add("firmware", vehicle.firmware->text() + (git.empty() ? "" : fmt::format(" ({})", git)));
    }
    append_periods(lines, vehicle);
    append_journey(lines, vehicle.journey);
    if (vehicle.battery) append_battery(lines, *vehicle.battery);
}

void append_more(Out out, const std::string& more) {
    if (!more.empty()) fmt::format_to(out, "  {}\n", more);
}

void append_texts(Out out, const RecordingInfo& info, const dialect::Dialect& dialect) {
    if (info.summary.texts.empty()) return;
    fmt::format_to(out, "\nwarnings\n");
    for (const auto& text : shown_of(info.summary.texts)) {
        const auto repeated = text.count == 1
                                  ? ""
                                  : fmt::format("  ({} times, last {})", text.count, clock_text(text.last.at));
        fmt::format_to(out, "  {:>9}  {:<7}  {:<9}  {}{}\n", clock_text(text.first.at), source_text(text.source),
                       entry_text(dialect, "MAV_SEVERITY", text.severity), printable(text.text), repeated);
    }
    append_more(out, more_text(info.summary.texts));
}

void append_parameters(Out out, const observe::Summary& all) {
    if (all.parameters.empty()) return;
    fmt::format_to(out, "\nparameters that changed\n");
    for (const auto& change : shown_of(all.parameters))
        fmt::format_to(out, "  {:>9}  {:<7}  {:<16}  {:.9g} -> {:.9g}\n", clock_text(change.when.at),
                       source_text(change.source), printable(change.name), change.before, change.after);
    append_more(out, more_text(all.parameters));
}

void append_senders(Out out, const observe::Summary& all, const dialect::Dialect& dialect) {
    fmt::format_to(out, "\n{:<9} {:<28} {:>10} {:>12} {:>8} {:>7} {:>7} {:>9} {:>6}\n", "sender", "kind", "frames",
                   "bytes", "lost", "loss %", "late", "duplicate", "resync");
    for (const auto& sender : all.senders) {
        const auto& its = sender.losses;
        fmt::format_to(out, "{:<9} {:<28} {:>10} {:>12} {:>8} {:>7.2f} {:>7} {:>9} {:>6}\n", source_text(sender.source),
                       kind_text(sender, dialect), sender.frames, sender.bytes, its.lost,
                       100 * observe::loss_ratio(its), its.late, its.duplicate, its.resync);
    }
}

void append_messages(Out out, const observe::Summary& all) {
    fmt::format_to(out, "\n{:<9} {:<38} {:>10} {:>9} {:>12} {:>7}\n", "sender", "message", "count", "Hz", "bytes",
                   "share %");
    for (const auto& sender : all.senders)
        for (const auto& message : sender.messages)
            fmt::format_to(out, "{:<9} {:<38} {:>10} {:>9.2f} {:>12} {:>7.2f}\n", source_text(sender.source),
                           message.name.empty() ? fmt::format("#{}", message.id.value) : std::string(message.name),
                           message.count, all.rate_hz(message), message.bytes,
                           100.0 * static_cast<double>(message.bytes) / static_cast<double>(all.bytes));
}

}  // namespace

std::string info_text(const RecordingInfo& info, const dialect::Dialect& dialect) {
    const auto& all = info.summary;
    std::string text;
    const auto out = std::back_inserter(text);
    append_head(out, info);
    for (const auto& sender : all.senders)
        if (sender.is_vehicle) append_vehicle(out, sender, dialect);
    append_texts(out, info, dialect);
    append_parameters(out, all);
    append_senders(out, all, dialect);
    append_messages(out, all);
    if (all.unlisted_frames != 0)
        fmt::format_to(out, "\n{} of further senders or messages not listed\n", counted(all.unlisted_frames, "frame"));
    if (all.unlisted_entries != 0)
        fmt::format_to(out, "\n{} not listed: modes, warnings, parameters and jumps beyond {} of each\n",
                       counted(all.unlisted_entries, "entry", "entries"), observe::Summarizer::max_entries);
    return text;
}

}  // namespace mavloom::app
