// SPDX-License-Identifier: MIT
#include "link/link_stats.hpp"

#include <fmt/format.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/vector.h>

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
auto of_links() {
    return [](const LinkStats& stats) { return (stats.links.*member).value(); };
}
template <auto member>
auto of_endpoint() {
    return [](const LinkStats& stats) { return (stats.endpoint.*member).value(); };
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

}  // namespace

void bind_link_stats(nb::module_& module) {
    using L = link::LinkCounters;
    using E = link::EndpointCounters;
    using T = feed::Totals;
    bind_source_stats(module);
    nb::class_<LinkStats>(
        module, "LinkStats", nb::is_final(),
        "The counters of a link, summed over all its peers, including closed ones. Every kind of loss has\n"
        "a counter.")
        .def_ro("peers", &LinkStats::peers, "Peers or clients that are connected now.")
        .def_prop_ro("frames_in", of_links<&L::frames_in>())
        .def_prop_ro("bytes_in", of_links<&L::bytes_in>())
        .def_prop_ro("frames_out", of_links<&L::frames_out>())
        .def_prop_ro("bytes_out", of_links<&L::bytes_out>())
        .def_ro("missed", &LinkStats::missed,
                "Frames that were overwritten in the buffer because the link's own reader was too slow.")
        .def_ro("not_kept", &LinkStats::not_kept,
                "Messages that `latest` does not keep. It keeps one for each source, id and instance, up to\n"
                "16,384.")
        .def_ro("no_peer", &LinkStats::no_peer, "Messages that `send` did not send because there was no peer.")
        .def_ro("answers", &LinkStats::answers, "Frames that programs sent to the inlet of `serve_inlet`.")
        .def_ro("unheard_answers", &LinkStats::unheard_answers,
                "Those of `answers` that were dropped because there was no peer.")
        .def_prop_ro("lost", of_links<&L::lost>(),
                     "Frames lost before they arrived, by sequence numbers. Late and duplicate frames do not count as\n"
                     "lost.")
        .def_prop_ro("late", of_links<&L::late>(), "Frames that arrived out of order; not counted in `lost`.")
        .def_prop_ro("duplicate", of_links<&L::duplicate>(), "Frames that arrived again.")
        .def_prop_ro("resync", of_links<&L::resync>(), "Sequence jumps that are too large to be loss, such as a reboot.")
        .def_prop_ro("kernel_drop", of_endpoint<&E::kernel_drop>(),
                     "Datagrams that the kernel dropped because the receive buffer was full.")
        .def_prop_ro("untracked", of_links<&L::untracked>(),
                     "Frames whose loss is not computed, because too many sources send.")
        .def_prop_ro("crc_error", of_links<&L::crc_error>(),
                     "Frames with a wrong checksum: damaged, or encoded with another definition.")
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
        .def_prop_ro("junk_bytes", of_links<&L::junk_bytes>(), "Bytes that belong to no frame.")
        .def_prop_ro("unknown_ids", of_links<&L::unknown_ids>(),
                     "Valid frames whose id has no definition; `frames_in` includes them.")
        .def_prop_ro("unknown_flags", of_links<&L::unknown_flags>(),
                     "Frames that were left out because of an undefined incompatibility flag.")
        .def_prop_ro("implausible_unknown", of_links<&L::implausible_unknown>(),
                     "Apparent frames without a definition that were rejected as implausible.")
        .def_prop_ro("bad_signature", of_links<&L::bad_signature>(),
                     "With `verify=`: frames that are unsigned or whose signature is invalid.")
        .def_prop_ro("wrong_peer", of_endpoint<&E::wrong_peer>(),
                     "With `udpout`: datagrams from an address other than the destination.")
        .def_prop_ro(
            "bad_source", of_endpoint<&E::bad_source>(),
            "Datagrams whose source can be no peer: port 0, a broadcast or multicast address, or the link's own.")
        .def_prop_ro("stray_bytes", of_endpoint<&E::stray_bytes>(),
                     "Bytes of datagrams that came from unknown senders and held no valid frame.")
        .def_prop_ro("peers_refused", of_endpoint<&E::peers_refused>(), "New peers that were turned away.")
        .def_prop_ro("peers_limited", of_endpoint<&E::peers_limited>(),
                     "New peers that were turned away although they sent repeatedly, because too many did.")
        .def_prop_ro("peers_evicted", of_endpoint<&E::peers_evicted>(), "Idle peers that were evicted for new ones.")
        .def_prop_ro("peers_displaced", of_endpoint<&E::peers_displaced>(),
                     "Active peers that were evicted for new ones.")
        .def_prop_ro("http_refused", of_endpoint<&E::http_refused>(),
                     "HTTP and TLS clients of a `tcpin`, which were disconnected.")
        .def_prop_ro("queue_bytes", of_links<&L::queue_bytes>(),
                     "Outgoing frames that were dropped because the queue was full.")
        .def_prop_ro("queue_age", of_links<&L::queue_age>(),
                     "Outgoing frames that were dropped because they were too old.")
        .def_prop_ro("not_sent", of_links<&L::frames_not_sent>(), "Outgoing frames that the kernel rejected.")
        .def_prop_ro("refused", of_links<&L::refused>(), "Frames sent to a port on which no program listens.")
        .def_prop_ro("unconfirmed", of_links<&L::unconfirmed>(),
                     "Frames not sent to a UDP peer that was heard only once: its address may be forged.")
        .def_prop_ro("send_errors", of_endpoint<&E::send_errors>(),
                     "Datagrams that the kernel rejected, or that met a closed port.")
        .def_prop_ro("reconnects", of_endpoint<&E::reconnects>())
        .def("__repr__", &counters_repr);
}

}  // namespace mavloom::python
