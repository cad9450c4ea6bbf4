// SPDX-License-Identifier: MIT
#include "link/link_stats.hpp"

#include <fmt/format.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/vector.h>

#include <cctype>

#include "counters_repr.hpp"
#include "strings.hpp"

namespace mavloom::python {

// If the checksum of a message never matches, its sender has another definition of it.
std::vector<std::string> hints_of(const dialect::Dialect& dialect, const LinkStats& stats) {
    constexpr std::uint64_t enough = 5;  // fewer may be mere damage
    std::vector<std::string> hints;
    if (!stats.failure.empty()) hints.push_back(stats.failure);
    for (const auto& [id, errors] : stats.crc_errors) {
        const auto* message = dialect.find(id);
        if (message != nullptr && errors.always && errors.count >= enough)
            hints.push_back(fmt::format(
                "all {} frames of {} ({}) failed their checksum: their sender has another "
                "definition of it; pass that definition to the link: dialect=mavloom.Dialect(\"theirs.xml\")",
                errors.count, message->name, id.value));
    }
    return hints;
}

namespace {

struct SourceStats {
    std::string link;
    wire::SequenceStats stats;
};

std::vector<SourceStats> source_stats(const LinkStats& stats) {
    std::vector<SourceStats> sources;
    for (const auto& [key, loss] : stats.losses) {
        sources.push_back({std::get<std::string>(key), loss});
        sources.back().stats.source = std::get<Source>(key);
    }
    return sources;
}

std::map<std::uint32_t, std::uint64_t> crc_error_ids(const LinkStats& stats) {
    std::map<std::uint32_t, std::uint64_t> counts;
    for (const auto& [id, errors] : stats.crc_errors) counts[id.value] = errors.count;
    return counts;
}

template <auto member>
auto of_ring() {
    return [](const LinkStats& stats) { return stats.ring.*member; };
}

template <auto member>
auto of_source() {
    return [](const SourceStats& source) { return source.stats.*member; };
}

void bind_source_stats(nb::module_& module) {
    using S = wire::SequenceStats;
    nb::class_<SourceStats>(
        module, "SourceStats", nb::is_final(),
        "The loss of one source on one link, derived from sequence numbers. Late and duplicate frames do\n"
        "not count as lost.")
        .def_prop_ro(
            "link_name", [](const SourceStats& s) { return s.link; },
            "The link's name. Successive links of the same name share one entry.")
        .def_prop_ro("sys", [](const SourceStats& s) { return s.stats.source.system.value; })
        .def_prop_ro("comp", [](const SourceStats& s) { return s.stats.source.component.value; })
        .def_prop_ro("received", of_source<&S::received>(), "All frames received, including late and duplicate ones.")
        .def_prop_ro("lost", of_source<&S::lost>())
        .def_prop_ro("late", of_source<&S::late>())
        .def_prop_ro("duplicate", of_source<&S::duplicate>())
        .def_prop_ro("resync", of_source<&S::resync>(),
                     "Sequence jumps that are too large to be loss, such as a reboot.")
        .def("__repr__", &counters_repr);
}

// Two have a shorter name here.
std::string python_name(std::string_view counter) {
    if (counter == "repeated") return "duplicate";
    if (counter == "frames_not_sent") return "not_sent";
    return std::string(counter);
}

// A property for each counter of the table. `in` is the member of LinkStats that has them.
void bind_counters(nb::class_<LinkStats>& bound, auto in, const auto& table) {
    for (const auto& row : table) {
        std::string doc = fmt::format("{}.", row.help);
        doc.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(doc.front())));
        bound.def_prop_ro(
            python_name(row.name).c_str(),
            [in, word = row.word](const LinkStats& stats) { return (stats.*in.*word).value(); }, doc.c_str());
    }
}

}  // namespace

void bind_link_stats(nb::module_& module) {
    using T = feed::Totals;
    bind_source_stats(module);
    nb::class_<LinkStats> bound(
        module, "LinkStats", nb::is_final(),
        "The counters of a link, summed over all its peers, including closed ones. Every kind of loss has\n"
        "a counter.");
    bound.def_ro("peers", &LinkStats::peers, "Peers or clients that are connected now.");
    bind_counters(bound, &LinkStats::links, link::link_counters);
    bind_counters(bound, &LinkStats::endpoint, link::endpoint_counters);
    bound
        .def_ro("missed", &LinkStats::missed,
                "Frames that were overwritten in the buffer because the link's own reader was too slow.")
        .def_ro("not_kept", &LinkStats::not_kept,
                "Messages that `latest` does not keep. It keeps one for each source, id and instance, up to\n"
                "16,384.")
        .def_ro("no_peer", &LinkStats::no_peer, "Messages that `send` did not send because there was no peer.")
        .def_ro("answers", &LinkStats::answers, "Frames that programs sent to the inlet of `serve_inlet`.")
        .def_ro("unheard_answers", &LinkStats::unheard_answers,
                "Those of `answers` that were dropped because there was no peer.")
        .def_prop_ro("crc_error_ids", &crc_error_ids, nb::sig("def crc_error_ids(self) -> dict[int, int]"),
                     "`crc_error` by message id.")
        .def_prop_ro("sources", &source_stats, "The loss of each source on each link, as a list of SourceStats.")
        .def_prop_ro("lapped", of_ring<&T::lapped>(), "Records of a ring that were overwritten before they were read.")
        .def_prop_ro("bad_records", of_ring<&T::bad_records>(), "Records of a ring that contained no whole valid frame.")
        .def_prop_ro("other_kinds", of_ring<&T::other_kinds>(), "Records of a ring whose kind is not MAVLink.")
        .def_prop_ro("echo", of_ring<&T::echo>(),
                     "Records of a ring that this link itself sent to the inlet; they are not returned as messages.")
        .def_ro("hints", &LinkStats::hints,
                "Advice on what to check, as text, for example why the endpoint is not connected, or a message\n"
                "whose checksum is always wrong.")
        .def("__repr__", &counters_repr);
}

}  // namespace mavloom::python
