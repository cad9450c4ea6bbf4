// SPDX-License-Identifier: MIT
// Frames that did not arrive.
#include <fmt/format.h>

#include <algorithm>

#include "mavloom/base/counted.hpp"
#include "mavloom/base/source_text.hpp"
#include "observe/diagnosis/word_parts.hpp"
#include "observe/diagnosis/words.hpp"

namespace mavloom::observe::words {

using Severity = Finding::Severity;

namespace {

std::string radio_text(const RadioReport* radio) {
    if (radio == nullptr) return {};
    return fmt::format(" The radio reports {} and {} corrected ones (RADIO_STATUS).",
                       counted(radio->rxerrors, "receive error"), radio->fixed);
}

}  // namespace

Finding lost_before(const Evidence& evidence, const SenderLoss& loss, const RadioReport* radio, Faults faults) {
    auto finding = of_link("lost-before", Severity::error, evidence, loss.link, loss.source);
    finding.what = fmt::format("{} of its frames did not arrive here: {} of {} are missing in its sequence numbers.",
                               percent(loss_ratio(loss)), loss.lost, loss.received - loss.duplicate + loss.lost);
    if (faults == Faults::on) {
        finding.severity = Severity::warning;
        finding.why = "Faults that are injected on purpose (faults-on) may explain some or all of it." +
                      radio_text(radio);
        finding.remedy = "End the faults, then listen again: a loss that remains has another cause.";
        return finding;
    }
    finding.why = fmt::format("{}, so they were lost before: by a radio, a network, or a program.{}",
                              evidence.is_recorded ? "The recording is whole" : "This machine dropped none of them",
                              radio_text(radio));
    finding.remedy =
        "Check the radio, its distance and its rates. To find the hop that loses them, compare a source before it "
        "with one behind it: `mavloom doctor A B`.";
    return finding;
}

Finding regular_gaps(const Evidence& evidence, const SenderLoss& loss, double station_loss) {
    auto finding = of_link("regular-gaps", Severity::warning, evidence, loss.link, loss.source);
    finding.what = fmt::format("{} of {} sequence numbers are missing, the same number in each half second.", loss.lost,
                               loss.received - loss.duplicate + loss.lost);
    finding.why = fmt::format(
        "Losses by chance vary more. A filter or a rate limit before this machine leaves out a stream, so probably "
        "nothing is lost. {}",
        shown_loss(station_loss));
    finding.remedy =
        "Look for in_allow=, out_block=, max_rate= or a private link on the way. `mavloom relay --resequence` numbers "
        "the frames again behind it.";
    return finding;
}

Finding kernel_drop(const Listened& source, std::uint64_t datagrams, std::uint64_t lost_frames) {
    auto finding = of_source("kernel-drop", Severity::error, source);
    finding.what = fmt::format("The kernel of this machine dropped {}: the receive buffer was full.{}",
                               counted(datagrams, "datagram"),
                               lost_frames == 0 ? "" : fmt::format(" {} are missing.", counted(lost_frames, "frame")));
    finding.why = fmt::format("The buffer has {} bytes; {} were asked for.", source.rcvbuf_granted, source.rcvbuf_asked);
    finding.remedy = fmt::format(
        "sysctl net.core.rmem_max={}, or a larger rcvbuf= if it was set. If the program that "
        "receives is slow or stopped, that is the cause.",
        std::max<std::uint64_t>(source.rcvbuf_asked, 32u << 20));
    return finding;
}

Finding receive_buffer(const Listened& source, double frames_per_s) {
    auto finding = of_source("receive-buffer", Severity::warning, source);
    finding.what = fmt::format("The receive buffer ({} bytes) holds less than 0.1 s of what comes ({:.0f} frames/s).",
                               source.rcvbuf_granted, frames_per_s);
    finding.why = fmt::format("{} bytes were asked for; net.core.rmem_max allows no more. Nothing was dropped so far.",
                              source.rcvbuf_asked);
    finding.remedy = fmt::format("sysctl net.core.rmem_max={}", source.rcvbuf_asked);
    return finding;
}

Finding ring_lapped(const Listened& source, std::uint64_t records) {
    auto finding = of_source("ring-lapped", Severity::error, source);
    finding.what = fmt::format("{} of the ring were overwritten before they were read.", counted(records, "record"));
    finding.why = "The ring holds less than what comes while its reader is busy.";
    finding.remedy = "Make the ring larger (--ring-capacity), or read it with lossless=true.";
    return finding;
}

Finding too_slow(std::uint64_t frames) {
    Finding finding{.id = "too-slow", .where = "mavloom doctor"};
    finding.what = fmt::format("This program was too slow for {}, and left them out.", counted(frames, "frame"));
    finding.why = "The machine is busy, or more arrives than one core can examine.";
    finding.remedy = "Examine fewer sources at once. The findings about losses may be incomplete.";
    return finding;
}

Finding queue_drop(const Hop& hop, const HopLink& link, const NamedCount& loss) {
    Finding finding{.id = "queue-drop",
                    .severity = Severity::error,
                    .where = fmt::format("{}: {}", hop.name, link.name),
                    .link = link.name};
    finding.what = fmt::format("{} dropped {} while we listened ({}).", hop.name, counted(loss.count, "frame"),
                               loss.name);
    const bool is_rejected = loss.name == "frames_not_sent";
    finding.why = is_rejected ? "The kernel rejected them: the network or the address cannot be reached."
                              : "The link is slower than what it should carry, its far side does not read, or its host "
                                "left the network.";
    finding.remedy = is_rejected ? "Check the address, the route and the interface of this link."
                                 : "Unless the host is gone, lower the rates of this link with max_rate= or "
                                   "out_block=, or make it faster. Commands and parameters are dropped last.";
    return finding;
}

Finding faults_on(const Hop& hop, const HopLink& link, std::span<const NamedCount> injected) {
    Finding finding{.id = "faults-on",
                    .severity = Severity::error,
                    .where = fmt::format("{}: {}", hop.name, link.name),
                    .link = link.name};
    std::string counts;
    for (const auto& one : injected) counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", one.name, one.count);
    finding.what = fmt::format("{} dropped or damaged frames on purpose while we listened: {}.", hop.name, counts);
    finding.why =
        "Faults are switched on for this link, by fault=, in_fault= or out_fault= of its endpoint, or by "
        "`mavloom ctl`. Losses that are shown behind it may be theirs.";
    finding.remedy = fmt::format("`mavloom ctl {} fault '{}' off` ends them; then listen again.", hop.name, link.name);
    return finding;
}

Finding ring_dropped(const Hop& hop, const NamedCount& loss) {
    Finding finding{.id = "ring-dropped", .where = fmt::format("{}: its ring", hop.name)};
    finding.what = fmt::format("{} did not write {} to its ring while we listened.", hop.name,
                               counted(loss.count, "frame"));
    finding.why = "A lossless reader holds the ring, or it is too small for a burst.";
    finding.remedy = "Make the ring larger, or end the reader that stands still: `mavloom shm stat` lists them.";
    return finding;
}

namespace {

std::string messages_text(const Evidence& evidence, const Passage& passage, bool are_filtered) {
    constexpr std::size_t most = 6;
    std::string text;
    std::size_t count = 0;
    for (const auto& message : passage.messages) {
        if (message.is_filtered != are_filtered) continue;
        if (++count <= most)
            text += fmt::format("{}{} ({} of {})", text.empty() ? "" : ", ", message_name(evidence, message.id),
                                message.lost, message.heard);
    }
    return count <= most ? text : fmt::format("{} and {} more", text, count - most);
}

std::string between(const Evidence& evidence, std::size_t first) {
    return fmt::format("{} and {}", evidence.sources[first].name, evidence.sources[first + 1].name);
}

}  // namespace

Finding lost_between(const Evidence& evidence, std::size_t first, const Passage& passage) {
    Finding finding{.id = "lost-between", .severity = Severity::error, .sender = passage.source};
    finding.where = fmt::format("{} between {}", source_text(passage.source), between(evidence, first));
    finding.source = evidence.sources[first + 1].name;
    finding.what = fmt::format(
        "{} of {} frames that {} heard did not come to {} ({}).", passage.lost, passage.before,
        evidence.sources[first].name, evidence.sources[first + 1].name,
        percent(static_cast<double>(passage.lost) / static_cast<double>(std::max<std::uint64_t>(passage.before, 1))));
    finding.why = fmt::format("The loss is real, and it happens between the two: {}.",
                              messages_text(evidence, passage, false));
    finding.remedy = "Look at the hop between them: its queues (`mavloom stat`), its radio or network, and its limits.";
    return finding;
}

Finding filtered_between(const Evidence& evidence, std::size_t first, const Passage& passage) {
    Finding finding{.id = "filtered-between", .severity = Severity::warning, .sender = passage.source};
    finding.where = fmt::format("{} between {}", source_text(passage.source), between(evidence, first));
    finding.source = evidence.sources[first + 1].name;
    finding.what = fmt::format("Of some messages, none came through: {}.", messages_text(evidence, passage, true));
    const auto shown = static_cast<double>(passage.filtered) /
                       static_cast<double>(std::max<std::uint64_t>(passage.before, 1));
    finding.why = fmt::format("A filter or a router between the two leaves them out. {}",
                              passage.is_rewritten ? "The frames are numbered again, so no ground station shows a loss."
                                                   : "They are not lost. " + shown_loss(shown));
    finding.remedy = "If that is not wanted, remove the filter (out_block=, in_allow=, max_rate=).";
    return finding;
}

}  // namespace mavloom::observe::words
