// SPDX-License-Identifier: MIT
// Rules about frames that did not arrive: before this machine, in it, and between two sources.
#include <algorithm>
#include <array>
#include <string_view>

#include "observe/diagnosis/rules.hpp"
#include "observe/diagnosis/words.hpp"

namespace mavloom::observe::rules {

namespace {

// Our own choice: a person notices a percent. Fewer frames may be lost at the begin of a link.
constexpr double loss_limit = 0.01;
constexpr std::uint64_t least_lost = 5;

bool is_lossy(const SenderLoss& loss) { return loss.lost > least_lost && loss_ratio(loss) >= loss_limit; }

std::uint64_t count_of(const std::vector<NamedCount>& losses, std::string_view name) {
    const auto at = std::ranges::find(losses, name, &NamedCount::name);
    return at == losses.end() ? 0 : at->count;
}

// A count that fell belongs to a program that was started again.
std::uint64_t grown(std::uint64_t from, std::uint64_t to) { return to < from ? to : to - from; }

const Hop* before_of(const Evidence& evidence, const Hop& hop) {
    const auto at = std::ranges::find(evidence.hops_before, hop.name, &Hop::name);
    return at == evidence.hops_before.end() ? nullptr : &*at;
}

std::uint64_t ring_dropped(const Hop& before, const Hop& after) {
    return grown(count_of(before.losses, "ring_dropped"), count_of(after.losses, "ring_dropped"));
}

// Frames of a ring may be missing because the router of this machine did not write them.
std::uint64_t missing_in_rings(const Evidence& evidence) {
    std::uint64_t sum = 0;
    for (const auto& hop : evidence.hops_after)
        if (const auto* const before = before_of(evidence, hop)) sum += ring_dropped(*before, hop);
    return sum;
}

// Frames and pieces that fault= drops or damages. Inward, a piece may hold several frames. Only faults hold pieces.
std::vector<NamedCount> injected(const HopLink& before, const HopLink& after) {
    std::vector<NamedCount> counts;
    for (const auto& loss : after.losses) {
        if (!loss.name.starts_with("fault_") && loss.name != "held_dropped") continue;
        if (const auto more = grown(count_of(before.losses, loss.name), loss.count); more != 0)
            counts.push_back({loss.name, more});
    }
    return counts;
}

// A link that is new, or that closed and moved its counts elsewhere, has none.
const HopLink& link_before(const Hop& before, const HopLink& link) {
    static const HopLink none;
    const auto same = std::ranges::find(before.links, link.name, &HopLink::name);
    return same == before.links.end() ? none : *same;
}

bool injects_faults(const Evidence& evidence) {
    return std::ranges::any_of(evidence.hops_after, [&](const Hop& hop) {
        const auto* const before = before_of(evidence, hop);
        return before != nullptr && std::ranges::any_of(hop.links, [&](const HopLink& link) {
                   return !injected(link_before(*before, link), link).empty();
               });
    });
}

std::uint64_t own_losses(const Evidence& evidence, const Listened& source) {
    const auto unwritten = source.kind == Listened::Kind::ring ? missing_in_rings(evidence) : 0;
    return source.count("kernel_drop") + source.count("lapped") + evidence.buffer_full + unwritten;
}

const RadioReport* radio_on(const Evidence& evidence, LinkId link) {
    const auto at = std::ranges::find(evidence.radios, link, &RadioReport::link);
    return at == evidence.radios.end() ? nullptr : &*at;
}

// The source before has the same sender, so the two were compared.
bool is_compared(const Evidence& evidence, std::size_t source, Source sender) {
    if (source == 0 || source > evidence.passages.size()) return false;
    return std::ranges::any_of(evidence.passages[source - 1], [&](const Passage& passage) {
        return passage.source == sender && passage.is_comparable;
    });
}

// Damaged frames, and those of other definitions, have sequence numbers, too.
bool is_explained(const Evidence& evidence, const Listened& source, const SenderLoss& loss) {
    std::uint64_t bad = 0;
    for (const auto& one : evidence.bad_checksums) bad += one.link == loss.link ? one.count : 0;
    return loss.lost <= std::max(bad, source.count("crc_error")) + least_lost;
}

void find_loss(const Evidence& evidence, const SenderLoss& loss, words::Faults faults, Findings& findings) {
    const auto* const link = evidence.link(loss.link);
    if (!is_lossy(loss) || link == nullptr || is_compared(evidence, link->source, loss.source)) return;
    const auto& source = evidence.sources[link->source];
    if (own_losses(evidence, source) != 0 || is_explained(evidence, source, loss)) return;
    const auto* const sender = stream_of(evidence, link->source, loss.source);
    if (sender == nullptr || !sender->has_sequence || arrival_of(evidence, link->source, *sender) != Arrival::usual)
        return;
    const bool is_alone = sender->links.size() == 1;
    if (faults == words::Faults::off && is_alone && sender->has_regular_gaps())
        findings.push_back(words::regular_gaps(evidence, loss, sender->station_loss()));
    else findings.push_back(words::lost_before(evidence, loss, radio_on(evidence, loss.link), faults));
}

}  // namespace

void find_losses(const Evidence& evidence, Findings& findings) {
    const auto faults = injects_faults(evidence) ? words::Faults::on : words::Faults::off;
    for (const auto& loss : evidence.losses) find_loss(evidence, loss, faults, findings);
}

void find_own_losses(const Evidence& evidence, Findings& findings) {
    // A small datagram takes this much of a receive buffer (sk_buff and its data); the buffer should last this long.
    constexpr double bytes_each = 768, lasts_s = 0.1;
    for (std::size_t i = 0; i < evidence.sources.size(); ++i) {
        const auto& source = evidence.sources[i];
        std::uint64_t lost = 0;
        for (const auto& loss : evidence.losses)
            if (evidence.source_of(loss.link) == &source) lost += loss.lost;
        const auto rate = static_cast<double>(source.count("frames_in")) / std::max(seconds(source.duration), 0.1);
        if (const auto dropped = source.count("kernel_drop"); dropped != 0)
            findings.push_back(words::kernel_drop(source, dropped, lost));
        else if (source.rcvbuf_granted != 0 && source.rcvbuf_granted < source.rcvbuf_asked &&
                 rate * lasts_s * bytes_each > static_cast<double>(source.rcvbuf_granted))
            findings.push_back(words::receive_buffer(source, rate));
        if (const auto records = source.count("lapped"); records != 0)
            findings.push_back(words::ring_lapped(source, records));
    }
    if (evidence.buffer_full != 0) findings.push_back(words::too_slow(evidence.buffer_full));
}

namespace {

// "14550" of "udpout://127.0.0.1:14550".
std::string_view port_of(std::string_view name) {
    const auto colon = name.rfind(':');
    return colon == std::string_view::npos ? std::string_view() : name.substr(colon + 1);
}

bool is_on_this_machine(std::string_view url) {
    constexpr std::array<std::string_view, 3> hosts{"://127.", "://localhost:", "://[::1]:"};
    return std::ranges::any_of(hosts, [&](auto host) { return url.find(host) != std::string_view::npos; });
}

// Until we opened the port, it was closed.
bool is_ours(const Evidence& evidence, const HopLink& link) {
    const auto port = port_of(link.destination());
    if (port.empty() || !is_on_this_machine(link.destination())) return false;
    return std::ranges::any_of(evidence.sources, [&](const Listened& source) {
        return source.kind == Listened::Kind::listens && port_of(source.name) == port;
    });
}

// A program on this machine, or we, opened the port meanwhile.
bool is_open_by_now(const Evidence& evidence, const Hop& hop, const HopLink& before, const HopLink& link) {
    if (grown(before.frames_out, link.frames_out) == 0) return false;
    const auto settled = std::ranges::find(evidence.hops_settled, hop.name, &Hop::name);
    return settled != evidence.hops_settled.end() && link_before(*settled, link).refused == link.refused;
}

void find_link_losses(const Evidence& evidence, const Hop& hop, const HopLink& before, const HopLink& link,
                      Findings& findings) {
    constexpr std::array<std::string_view, 3> kinds{"queue_bytes", "queue_age", "frames_not_sent"};
    for (const auto& loss : link.losses) {
        if (std::ranges::find(kinds, loss.name) == kinds.end()) continue;
        const auto more = grown(count_of(before.losses, loss.name), loss.count);
        if (more != 0) findings.push_back(words::queue_drop(hop, link, {loss.name, more, loss.help}));
    }
    if (const auto counts = injected(before, link); !counts.empty())
        findings.push_back(words::faults_on(hop, link, counts));
    if (const auto more = grown(before.refused, link.refused);
        more != 0 && !is_ours(evidence, link) && !is_open_by_now(evidence, hop, before, link))
        findings.push_back(words::port_refused(hop, link, more));
}

}  // namespace

void find_hop_losses(const Evidence& evidence, Findings& findings) {
    for (const auto& hop : evidence.hops_after) {
        const auto* const before = before_of(evidence, hop);
        if (before == nullptr) continue;
        for (const auto& link : hop.links) {
            if (link.is_sum) continue;  // a link that closes moves its counts there
            find_link_losses(evidence, hop, link_before(*before, link), link, findings);
        }
        if (const auto more = ring_dropped(*before, hop); more != 0)
            findings.push_back(words::ring_dropped(hop, {"ring_dropped", more}));
    }
}

void find_passages(const Evidence& evidence, Findings& findings) {
    for (std::size_t i = 0; i < evidence.passages.size(); ++i) {
        for (const auto& passage : evidence.passages[i]) {
            if (passage.lost != 0) findings.push_back(words::lost_between(evidence, i, passage));
            if (passage.filtered != 0) findings.push_back(words::filtered_between(evidence, i, passage));
        }
    }
}

}  // namespace mavloom::observe::rules
