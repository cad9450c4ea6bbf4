// SPDX-License-Identifier: MIT
// Senders, heartbeats, signatures and clocks.
#include <fmt/format.h>

#include "mavloom/base/counted.hpp"
#include "mavloom/base/source_text.hpp"
#include "observe/diagnosis/word_parts.hpp"
#include "observe/diagnosis/words.hpp"

namespace mavloom::observe::words {

using Severity = Finding::Severity;

namespace {

std::string sources_text(std::span<const Source> sources) {
    std::string text;
    for (const auto source : sources) text += (text.empty() ? "" : ", ") + source_text(source);
    return text;
}

std::string links_text(const Evidence& evidence, const SenderStream& sender) {
    std::string text;
    for (const auto& [link, frames] : sender.links)
        text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", evidence.name_of(link), counted(frames, "frame"));
    return text;
}

}  // namespace

Finding two_senders(Source sender, const TwoSenders& senders) {
    auto finding = of_sender("two-senders", Severity::error, sender, senders.where);
    finding.what = fmt::format("Two senders have the id {}. {}", source_text(sender), senders.reason);
    finding.why =
        "Ground stations and routers take them for one: they mix values, send commands to both, and show losses.";
    finding.remedy =
        "Give each a system id of its own: MAV_SYS_ID on PX4, MAV_SYSID (SYSID_THISMAV before 4.7) on ArduPilot, the "
        "settings of a ground station. `mavloom relay --remap-system 1=2` changes one on the way.";
    return finding;
}

Finding two_links(const Evidence& evidence, std::size_t source, const SenderStream& sender) {
    const bool are_copies = sender.copies_across >= sender.conflicts_across;
    auto finding = of_sender("two-links", Severity::warning, sender.source, evidence.sources[source].name);
    finding.source = evidence.sources[source].name;
    finding.what = fmt::format("It is heard by {} links: {}.", sender.links.size(), links_text(evidence, sender));
    finding.why = fmt::format(
        "{} {}",
        are_copies ? fmt::format("{} of its frames came as copies of earlier ones.",
                                 percent(static_cast<double>(sender.copies_across) / static_cast<double>(sender.frames)))
                   : "Each link has a sequence of numbers of its own: two ports of one vehicle, or two vehicles.",
        shown_loss(sender.station_loss()));
    finding.remedy =
        are_copies
            ? "Give both endpoints of the router the same group=; it then passes each frame once. Two simulators "
              "with one --seed and --start-time look the same: there, give one another --system."
            : "Connect one of them only, or give both endpoints the same group= with "
              "group_mode=best, so that one at a time is used.";
    return finding;
}

Finding split_stream(const Evidence& evidence, std::size_t source, const SenderStream& sender, double worst_loss) {
    auto finding = of_sender("split-stream", Severity::warning, sender.source, evidence.sources[source].name);
    finding.source = evidence.sources[source].name;
    finding.what = fmt::format("Its frames are split over {} links: {}. Together, nothing is missing.",
                               sender.links.size(), links_text(evidence, sender));
    finding.why = fmt::format(
        "A program that hears only one of the links shows a loss of up to {}, although nothing is "
        "lost.",
        percent(worst_loss));
    finding.remedy = "Give both endpoints of the router the same group=, and let the ground station use the router.";
    return finding;
}

Finding duplicates(const Evidence& evidence, std::size_t source, const SenderStream& sender) {
    auto finding = of_sender("duplicates", Severity::warning, sender.source, evidence.sources[source].name);
    finding.source = evidence.sources[source].name;
    finding.what = fmt::format("{} of its {} frames came more than once on the same link.", sender.copies_on_link,
                               sender.frames);
    finding.why = fmt::format(
        "Two ways lead here, such as two routers or two endpoints of one router, or the network "
        "repeats datagrams. {}",
        shown_loss(sender.station_loss()));
    finding.remedy = "Remove one of the ways, or pass both through one router, which drops copies (dedup_ms).";
    return finding;
}

Finding no_heartbeat(const Evidence& evidence, std::size_t source, SystemId system, std::uint64_t frames) {
    Finding finding{.id = "no-heartbeat", .severity = Severity::error};
    finding.where = fmt::format("system {} by {}", system.value, evidence.sources[source].name);
    finding.source = evidence.sources[source].name;
    finding.sender = Source{system, {}};
    finding.what = fmt::format("System {} sent {}, and no HEARTBEAT.", system.value, counted(frames, "frame"));
    finding.why =
        "Ground stations show only vehicles that send HEARTBEATs, once a second, and vehicles act on a lost ground "
        "station without them.";
    finding.remedy =
        "Check that no filter removes HEARTBEAT, and that its stream is on: MAV_n_MODE on PX4, SERIALn_PROTOCOL on "
        "ArduPilot.";
    return finding;
}

Finding unsigned_frames(const Listened& source, std::span<const Source> with, std::span<const Source> without) {
    auto finding = of_source("unsigned-frames", Severity::warning, source);
    finding.what = fmt::format("{} {} frames, {} not.", sources_text(with),
                               with.size() == 1 ? "signs its" : "sign their",
                               sources_text(without) + (without.size() == 1 ? " does" : " do"));
    finding.why = "A vehicle that signs takes no commands from a sender that does not.";
    finding.remedy = "Give both the same key, or let the router sign at the border: sign= and verify= of an endpoint.";
    return finding;
}

Finding partly_signed(const Listened& source, const SenderStream& sender) {
    auto finding = of_sender("unsigned-frames", Severity::warning, sender.source, source.name);
    finding.source = source.name;
    finding.what = fmt::format("It signs {} of its frames, and {} not.", sender.signed_frames, sender.unsigned_frames);
    finding.why = "Signing began or ended meanwhile, or a second program sends with the same id and without the key.";
    finding.remedy = "Check which program sends them, and that each has the key.";
    return finding;
}

Finding of_alarm(const Alarm& alarm) {
    using Kind = Alarm::Kind;
    Finding finding{.id = {}, .severity = Severity::warning};
    const bool is_ours = alarm.source == Source{};
    finding.where = is_ours ? "this machine" : source_text(alarm.source);
    if (!is_ours) finding.sender = alarm.source;
    finding.what = alarm.text.empty() ? std::string() : alarm.text + ".";
    if (!finding.what.empty() && finding.what[0] >= 'a' && finding.what[0] <= 'z')
        finding.what[0] = static_cast<char>(finding.what[0] - 'a' + 'A');
    if (alarm.kind == Kind::silent) {
        finding.id = "went-silent";
        finding.severity = Severity::error;
        finding.what = "It was heard, and then nothing came from it any more.";
        finding.why = "The vehicle was switched off, went out of range, or the link broke.";
        finding.remedy = "Check the vehicle and the link.";
    } else if (alarm.kind == Kind::restart) {
        finding.id = "restart";
        finding.why = "Its time since boot began again.";
        finding.remedy = "If nobody restarted it, check its power.";
    } else {
        finding.id = "clock-jump";
        finding.why = is_ours ? "NTP or a person set it while we listened; recordings then have steps in their times."
                              : "The vehicle set its clock, for example when GPS gave the time, or two vehicles share "
                                "an id.";
        finding.remedy = is_ours ? "Let the clock settle before a flight." : "Usually nothing, once after its start.";
    }
    return finding;
}

}  // namespace mavloom::observe::words
