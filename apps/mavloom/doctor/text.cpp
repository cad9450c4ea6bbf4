// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "doctor/reports.hpp"
#include "entry_text.hpp"
#include "mavloom/base/counted.hpp"
#include "mavloom/base/durations.hpp"
#include "mavloom/base/shown.hpp"
#include "mavloom/base/source_text.hpp"
#include "wrapped.hpp"

namespace mavloom::app {

namespace {

using observe::Finding;

std::string kind_of_sender(const observe::Evidence& evidence, Source source) {
    const auto vehicle = std::ranges::find(evidence.vehicles, source, &observe::Vehicle::source);
    if (vehicle == evidence.vehicles.end()) return {};
    return fmt::format(" ({})", kind_text(*evidence.dialect, vehicle->type, vehicle->autopilot));
}

std::string senders_text(const observe::Evidence& evidence, std::size_t source) {
    constexpr std::size_t most = 8;
    const auto& senders = evidence.senders[source];
    std::string text;
    for (std::size_t i = 0; i < std::min(senders.size(), most); ++i)
        text += fmt::format("{}{}{}", text.empty() ? "" : ", ", source_text(senders[i].source),
                            kind_of_sender(evidence, senders[i].source));
    return senders.size() <= most ? text : fmt::format("{} and {} more", text, senders.size() - most);
}

std::string time_text(Nanoseconds time) {
    const auto s = seconds(time);
    return s < 120 ? fmt::format("{:.0f} s", s) : fmt::format("{:.0f} min", s / 60);
}

std::string source_line(const observe::Evidence& evidence, std::size_t i) {
    const auto& source = evidence.sources[i];
    const auto frames = source.count("frames_in");
    if (!source.refusal.empty()) return source.name + ": not opened";
    if (frames == 0) return fmt::format("{}: nothing in {}", source.name, time_text(source.duration));
    return fmt::format("{}: {} in {} of {}", source.name, counted(frames, "frame"), time_text(source.duration),
                       senders_text(evidence, i));
}

void add_sources(std::string& out, const observe::Evidence& evidence, int width) {
    for (std::size_t i = 0; i < evidence.sources.size(); ++i)
        out += wrapped(printable(source_line(evidence, i)), width, 2);
}

std::string passage_text(const observe::Evidence& evidence, std::size_t first, const observe::Passage& passage) {
    const auto &a = evidence.sources[first].name, &b = evidence.sources[first + 1].name;
    const auto sender = source_text(passage.source);
    if (passage.has_few) return fmt::format("{} sent too few frames to compare those of {} and {}.", sender, a, b);
    if (!passage.is_comparable)
        return fmt::format("{} sends other frames to {} than to {}, so these cannot be compared.", sender, a, b);
    std::string text = passage.lost + passage.filtered == 0
                           ? fmt::format("Nothing is lost between {} and {}: all {} of {} came through.", a, b,
                                         counted(passage.before, "frame"), sender)
                           : fmt::format("Between {} and {}, {} of {} of {} did not come through.", a, b,
                                         passage.lost + passage.filtered, counted(passage.before, "frame"), sender);
    if (passage.added != 0) text += fmt::format(" {} came only to {}.", counted(passage.added, "frame"), b);
    return text;
}

void add_passages(std::string& out, const observe::Evidence& evidence, int width) {
    for (std::size_t i = 0; i < evidence.passages.size(); ++i)
        for (const auto& passage : evidence.passages[i])
            out += wrapped(printable(passage_text(evidence, i, passage)), width, 2);
}

void add_finding(std::string& out, const Finding& finding, TextStyle style) {
    const auto* const color = finding.severity == Finding::Severity::error ? "\x1b[1;31m" : "\x1b[1;33m";
    out += '\n';
    out += style.has_color ? fmt::format("{}{}\x1b[0m", color, finding.id) : std::string(finding.id);
    out += "  " + printable(finding.where) + "\n";
    out += wrapped("  " + printable(finding.what), style.width, 2);
    if (!finding.why.empty()) out += wrapped("  Why: " + printable(finding.why), style.width, 7);
    if (!finding.remedy.empty()) out += wrapped("  Do:  " + printable(finding.remedy), style.width, 7);
}

}  // namespace

std::string doctor_text(const observe::Evidence& evidence, std::span<const Finding> findings, TextStyle style) {
    std::string out;
    add_sources(out, evidence, style.width);
    add_passages(out, evidence, style.width);
    for (const auto& finding : findings) add_finding(out, finding, style);
    out += findings.empty() ? "Nothing is wrong.\n" : fmt::format("\n{}.\n", counted(findings.size(), "finding"));
    return out;
}

}  // namespace mavloom::app
