// SPDX-License-Identifier: MIT
// Rules about sources: ports, connections, and bytes that are no frames.
#include <algorithm>
#include <map>

#include "observe/diagnosis/rules.hpp"
#include "observe/diagnosis/words.hpp"

namespace mavloom::observe::rules {

namespace {

// Of what arrived, in places where no more than a few bytes of noise are expected.
constexpr double damaged_limit = 0.01;
constexpr std::uint64_t least_damaged = 5, least_junk_bytes = 100, least_wrong = 3;

std::uint64_t junk_of(const Listened& source) { return source.count("junk_bytes") + source.count("stray_bytes"); }

bool is_heard(const Listened& source) { return source.count("frames_in") != 0; }

void find_silent(const Evidence& evidence, const Listened& source, Findings& findings) {
    const auto junk = junk_of(source);
    if (junk + source.count("crc_error") >= least_junk_bytes) {
        findings.push_back(source.kind == Listened::Kind::serial ? words::wrong_baud(source, junk)
                                                                 : words::not_mavlink(source, junk));
        return;
    }
    // "connection refused", as the system words it.
    const bool is_refused = source.failure.find("refused") != std::string::npos;
    if (is_refused || source.count("refused") + source.count("send_errors") != 0)
        findings.push_back(words::port_refused(source));
    else if (!source.failure.empty()) findings.push_back(words::not_connected(source));
    else if (source.is_asked) findings.push_back(words::nothing_heard(evidence, source));
}

}  // namespace

void find_unheard(const Evidence& evidence, Findings& findings) {
    const bool is_any_heard = std::ranges::any_of(evidence.sources, is_heard);
    bool is_any_asked = false;
    for (const auto& source : evidence.sources) {
        is_any_asked = is_any_asked || source.is_asked;
        if (!source.refusal.empty()) {
            if (source.is_asked || !is_any_heard)
                findings.push_back(source.is_taken ? words::port_taken(source) : words::cannot_open(source));
        } else if (!is_heard(source)) {
            find_silent(evidence, source, findings);
        }
    }
    const auto refused = static_cast<std::size_t>(
        std::ranges::count_if(evidence.sources, [](const Listened& source) { return !source.refusal.empty(); }));
    const bool is_any_open = refused < evidence.sources.size() || evidence.sources.empty();
    if (!is_any_heard && !is_any_asked && is_any_open && findings.size() == refused)
        findings.push_back(words::nothing_heard(evidence));
}

namespace {

using Bad = std::map<LinkId, std::vector<words::WrongMessage>>;

// A message of which no frame has a good checksum has another definition there.
Bad wrong_messages(const Evidence& evidence) {
    Bad bad;
    for (const auto& one : evidence.bad_checksums) {
        const bool has_good = std::ranges::any_of(
            evidence.streams, [&](const Stream& stream) { return stream.link == one.link && stream.id == one.id; });
        const auto* const message = evidence.dialect->find(one.id);
        if (!has_good && message != nullptr && one.count >= least_wrong)
            bad[one.link].push_back({one.id, message->name, one.count});
    }
    for (const auto& stream : evidence.streams)
        if (stream.name.empty() && stream.count >= least_wrong)
            bad[stream.link].push_back({stream.id, {}, stream.count});
    return bad;
}

void find_damage(const Listened& source, std::uint64_t explained, Findings& findings) {
    const auto good = source.count("frames_in"), damaged = source.count("crc_error");
    if (good == 0) return;
    if (const auto places = source.count("damaged_places"); places != 0)
        findings.push_back(words::damaged_recording(source, places));
    const auto rest = damaged - std::min(damaged, explained);
    if (rest >= least_damaged && static_cast<double>(rest) >= damaged_limit * static_cast<double>(good))
        findings.push_back(words::damaged_frames(source, rest, good));
    if (const auto count = source.count("long_datagrams"); count != 0)
        findings.push_back(words::long_datagrams(source, count));
}

}  // namespace

void find_unreadable(const Evidence& evidence, Findings& findings) {
    std::map<const Listened*, std::uint64_t> explained;
    for (const auto& [link, messages] : wrong_messages(evidence)) {
        const auto* const source = evidence.source_of(link);
        if (source == nullptr || !is_heard(*source)) continue;  // junk has the ids of messages here and there
        for (const auto& message : messages)
            if (!message.name.empty()) explained[source] += message.count;
        findings.push_back(words::wrong_dialect(std::string(evidence.name_of(link)), messages));
    }
    for (const auto& source : evidence.sources) find_damage(source, explained[&source], findings);
}

}  // namespace mavloom::observe::rules
