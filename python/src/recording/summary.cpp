// SPDX-License-Identifier: MIT
// class RecordingSummary and its parts: what happened in a recording.
#include "recording/summary.hpp"

#include <fmt/format.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include "bindings.hpp"
#include "counters_repr.hpp"
#include "errors.hpp"
#include "gil.hpp"
#include "mavloom/base/durations.hpp"
#include "mavloom/feed/summarize.hpp"
#include "recording/progress.hpp"
#include "strings.hpp"

namespace mavloom::python {

RecordingSummary summary_of(const std::string& path, const std::shared_ptr<const Origin>& origin, bool shows_progress) {
    constexpr std::uint64_t piece = 16 << 20;  // bytes to read before signals are handled
    auto reader = [&] {
        const WithoutGil outside;
        return record::TlogReader::open(path, origin->dialect().wire_table(), record::File::Empty::report);
    }();
    if (!reader) raise(reader.error());
    if (!reader->is_file()) raise({SetupCode::usage, 0, path + " is no regular file, so it can be read only once"});
    observe::Summarizer summarizer(origin->dialect());
    auto progress = shows_progress ? Progress::on_stderr() : Progress();
    for (;; check_signals()) {
        if (progress.is_due())
            progress.show({.frames = reader->counters().records.value(),
                           .bytes = reader->position(),
                           .part = static_cast<double>(reader->position()) / static_cast<double>(reader->size())});
        const auto done = [&] {
            const WithoutGil outside;
            return feed::summarize(*reader, summarizer, piece);
        }();
        if (!done) raise(done.error());
        if (*done == feed::Summarized::all) break;
    }
    const auto& counters = reader->counters();
    return {origin, summarizer.summary(), counters.lost_bytes.value(), counters.damaged_places.value()};
}

namespace {

using namespace observe;

std::int64_t unix_ns(WallTime time) { return time.time_since_epoch().count(); }
std::optional<std::int64_t> unix_ns(const std::optional<WallTime>& time) {
    return time ? std::optional(unix_ns(*time)) : std::nullopt;
}

// A member of the summary itself.
template <auto member>
auto of_summary() {
    return [](const RecordingSummary& all) -> const auto& { return all.summary.*member; };
}

template <class T>
nb::class_<T> part(nb::module_& module, const char* name, const char* doc) {
    return nb::class_<T>(module, name, doc).def("__repr__", &counters_repr);
}

// The properties of a moment.
template <auto member, class T>
void def_when(nb::class_<T>& type) {
    type.def_prop_ro(
        "time_ns", [](const T& part) { return unix_ns((part.*member).time); }, "Unix time.");
    type.def_prop_ro(
        "at", [](const T& part) { return seconds((part.*member).at); }, "Seconds since the first frame.");
}
template <class T>
void def_duration(nb::class_<T>& type) {
    type.def_prop_ro(
        "duration", [](const T& part) { return seconds(part.duration); }, "In seconds.");
}
template <class T>
void def_source(nb::class_<T>& type) {
    type.def_prop_ro("sys", [](const T& part) { return part.source.system.value; });
    type.def_prop_ro("comp", [](const T& part) { return part.source.component.value; });
}

void bind_moments(nb::module_& module) {
    auto jump = part<ClockJump>(module, "ClockJump", "The first frame after a jump of the recorded times.");
    def_when<&ClockJump::when>(jump);
    jump.def_prop_ro(
        "step", [](const ClockJump& one) { return seconds(one.step); }, "In seconds.");

    auto mode = part<ModePeriod>(module, "ModePeriod", "The time in one mode.");
    def_when<&ModePeriod::begin>(mode);
    def_duration(mode);
    mode.def_ro("name", &ModePeriod::name, "Empty if the mode has no known name.");
    mode.def_ro("custom_mode", &ModePeriod::custom_mode);

    auto armed = part<ArmedPeriod>(module, "ArmedPeriod", "The time from arming to disarming, or to the end.");
    def_when<&ArmedPeriod::begin>(armed);
    def_duration(armed);

    auto fix = part<Fix>(module, "Fix", "A position.");
    def_when<&Fix::when>(fix);
    fix.def_ro("lat_deg", &Fix::lat_deg).def_ro("lon_deg", &Fix::lon_deg);
    fix.def_ro("alt_m", &Fix::alt_m, "Above mean sea level.");
    fix.def_ro("relative_alt_m", &Fix::relative_alt_m, "Above home.");

    auto text = part<TextSummary>(module, "TextSummary", "A STATUSTEXT; equal ones of one sender are counted.");
    def_source(text);
    def_when<&TextSummary::first>(text);
    text.def_ro("severity", &TextSummary::severity).def_ro("text", &TextSummary::text);
    text.def_ro("count", &TextSummary::count);
    text.def_prop_ro("last_time_ns", [](const TextSummary& one) { return unix_ns(one.last.time); });

    auto change = part<ParameterChange>(module, "ParameterChange", "A PARAM_VALUE that differs from the earlier one.");
    def_source(change);
    def_when<&ParameterChange::when>(change);
    change.def_ro("name", &ParameterChange::name);
    change.def_ro("before", &ParameterChange::before).def_ro("after", &ParameterChange::after);
}

template <auto member>
auto of_journey() {
    return [](const SenderSummary& sender) -> const auto& { return sender.journey.*member; };
}
template <auto member>
auto of_battery() {
    return [](const SenderSummary& sender) { return sender.battery ? (*sender.battery).*member : std::nullopt; };
}
template <auto use, auto member>
auto of_battery() {
    return [](const SenderSummary& sender) { return sender.battery ? ((*sender.battery).*use).*member : std::nullopt; };
}
template <auto member>
auto of_losses() {
    return [](const SenderSummary& sender) { return sender.losses.*member; };
}

void bind_sender(nb::module_& module) {
    part<MessageTotal>(module, "MessageTotal", "How often one sender sent one message.")
        .def_prop_ro("id", [](const MessageTotal& one) { return one.id.value; })
        .def_ro("name", &MessageTotal::name, "Empty if it has no definition.")
        .def_ro("count", &MessageTotal::count)
        .def_ro("bytes", &MessageTotal::bytes);

    auto sender = part<SenderSummary>(module, "SenderSummary", "One sender. What it did not report is None or empty.");
    def_source(sender);
    sender.def_ro("is_vehicle", &SenderSummary::is_vehicle)
        .def_ro("type", &SenderSummary::type, "MAV_TYPE.")
        .def_ro("autopilot", &SenderSummary::autopilot, "MAV_AUTOPILOT.")
        .def_ro("frames", &SenderSummary::frames)
        .def_ro("bytes", &SenderSummary::bytes)
        .def_prop_ro("lost", of_losses<&wire::SequenceStats::lost>(), "Frames that are missing by sequence numbers.")
        .def_prop_ro("late", of_losses<&wire::SequenceStats::late>())
        .def_prop_ro("duplicate", of_losses<&wire::SequenceStats::duplicate>())
        .def_prop_ro("resync", of_losses<&wire::SequenceStats::resync>())
        .def_ro("messages", &SenderSummary::messages, "The most frequent first.")
        .def_prop_ro(
            "firmware",
            [](const SenderSummary& one) { return one.firmware ? std::optional(one.firmware->text()) : std::nullopt; },
            "Of AUTOPILOT_VERSION, such as \"1.16.0\".")
        .def_ro("modes", &SenderSummary::modes)
        .def_ro("armed", &SenderSummary::armed)
        .def_prop_ro("first_position", of_journey<&Journey::first>(), nb::rv_policy::reference_internal)
        .def_prop_ro("last_position", of_journey<&Journey::last>(), nb::rv_policy::reference_internal)
        .def_prop_ro("highest_alt_m", of_journey<&Journey::highest_alt_m>(), "Above mean sea level.")
        .def_prop_ro("highest_relative_alt_m", of_journey<&Journey::highest_relative_alt_m>(), "Above home.")
        .def_prop_ro("highest_speed_m_s", of_journey<&Journey::highest_speed_m_s>(), "Over ground.")
        .def_prop_ro("distance_m", of_journey<&Journey::distance_m>(), "Over ground, while armed.")
        .def_prop_ro("first_battery_percent", of_battery<&BatteryUse::first, &Battery::percent>())
        .def_prop_ro("last_battery_percent", of_battery<&BatteryUse::last, &Battery::percent>())
        .def_prop_ro("lowest_battery_percent", of_battery<&BatteryUse::lowest_percent>())
        .def_prop_ro("first_voltage_v", of_battery<&BatteryUse::first, &Battery::voltage_v>())
        .def_prop_ro("last_voltage_v", of_battery<&BatteryUse::last, &Battery::voltage_v>())
        .def_prop_ro("lowest_voltage_v", of_battery<&BatteryUse::lowest_voltage_v>());
}

std::string shown(const RecordingSummary& all) {
    return fmt::format("<RecordingSummary: {:.1f} s, {} frames, {} senders>", seconds(all.summary.duration),
                       all.summary.frames, all.summary.senders.size());
}

}  // namespace

void bind_recording_summary(nb::module_& module) {
    bind_moments(module);
    bind_sender(module);
    nb::class_<RecordingSummary>(module, "RecordingSummary",
                                 "What happened in a recording. docs/guide/info.md explains the values.")
        .def_prop_ro("begin_ns", [](const RecordingSummary& all) { return unix_ns(all.summary.begin); })
        .def_prop_ro("end_ns", [](const RecordingSummary& all) { return unix_ns(all.summary.end); })
        .def_prop_ro(
            "duration", [](const RecordingSummary& all) { return seconds(all.summary.duration); },
            "In seconds, without jumps of the clock.")
        .def_prop_ro("frames", of_summary<&Summary::frames>())
        .def_prop_ro("bytes", of_summary<&Summary::bytes>())
        .def_ro("junk_bytes", &RecordingSummary::junk_bytes)
        .def_ro("damaged_places", &RecordingSummary::damaged_places)
        .def_prop_ro("senders", of_summary<&Summary::senders>(), nb::rv_policy::reference_internal,
                     "In the order in which they were first heard.")
        .def_prop_ro("warnings", of_summary<&Summary::texts>(), nb::rv_policy::reference_internal,
                     "Texts of severity WARNING and above.")
        .def_prop_ro("parameters", of_summary<&Summary::parameters>(), nb::rv_policy::reference_internal,
                     "Parameters that changed.")
        .def_prop_ro("clock_jumps", of_summary<&Summary::clock_jumps>(), nb::rv_policy::reference_internal)
        .def_prop_ro("unlisted_frames", of_summary<&Summary::unlisted_frames>(), "Frames of more than 1024 senders.")
        .def_prop_ro("unlisted_entries", of_summary<&Summary::unlisted_entries>(), "Of lists with 1000 entries.")
        .def("__repr__", &shown);
}

}  // namespace mavloom::python
