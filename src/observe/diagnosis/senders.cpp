// SPDX-License-Identifier: MIT
// Rules about senders: two with one id, one by two links, heartbeats, signatures and clocks.
#include <algorithm>
#include <array>
#include <map>

#include "mavloom/msg/high_latency.hpp"
#include "mavloom/msg/high_latency2.hpp"
#include "mavloom/msg/hil_sensor.hpp"
#include "observe/diagnosis/rules.hpp"
#include "observe/diagnosis/words.hpp"

namespace mavloom::observe::rules {

namespace {

constexpr std::uint64_t least_heard = 10;
constexpr double disorder_limit = 0.03, copies_limit = 0.05, split_limit = 0.05, whole_limit = 0.01;
constexpr std::uint64_t least_changes = 3, least_clocks = 3;
constexpr ComponentId autopilot{1};  // MAV_COMP_ID_AUTOPILOT1

bool is_share(std::uint64_t part, std::uint64_t all, double limit) {
    return part >= least_heard && static_cast<double>(part) >= limit * static_cast<double>(all);
}

template <class Take>
void each_loss(const Evidence& evidence, std::size_t source, Source sender, Take take) {
    for (const auto& loss : evidence.losses) {
        const auto* const link = evidence.link(loss.link);
        if (loss.source == sender && link != nullptr && link->source == source) take(loss);
    }
}

std::uint64_t resyncs_of(const Evidence& evidence, std::size_t source, Source sender) {
    std::uint64_t sum = 0;
    each_loss(evidence, source, sender, [&](const SenderLoss& loss) { sum += loss.resync; });
    return sum;
}

double worst_loss_of(const Evidence& evidence, std::size_t source, Source sender) {
    double worst = 0;
    each_loss(evidence, source, sender, [&](const SenderLoss& loss) {
        if (loss.received >= least_heard) worst = std::max(worst, loss_ratio(loss));
    });
    return worst;
}

bool has_two_clocks(const Evidence& evidence, Source sender) {
    return std::ranges::any_of(evidence.alarms, [&](const Alarm& alarm) {
        return alarm.kind == Alarm::Kind::two_senders && alarm.source == sender;
    });
}

// Simulators that were started together send the same frames, but for the time of day. One clock may contradict itself
// once or twice, when the vehicle's processor is busy.
bool has_other_times(const SenderStream& sender) { return sender.clocks_across >= least_clocks; }

// Links that carry a good part of its frames.
std::size_t busy_links(const SenderStream& sender) {
    return static_cast<std::size_t>(std::ranges::count_if(
        sender.links, [&](const auto& link) { return is_share(link.second, sender.frames, copies_limit); }));
}

bool is_mixed(const Evidence& evidence, std::size_t source, const SenderStream& sender) {
    const auto disorder = sender.conflicts_on_link + resyncs_of(evidence, source, sender.source);
    return sender.has_sequence && is_share(disorder, sender.frames, disorder_limit);
}

Arrival arrival_by_links(const Evidence& evidence, std::size_t source, const SenderStream& sender) {
    if (is_share(sender.copies_across, sender.frames, copies_limit)) return Arrival::two_links;
    // Only autopilots have clocks by which two of them would have been noticed.
    if (is_share(sender.conflicts_across, sender.frames, copies_limit))
        return sender.source.component == autopilot ? Arrival::two_links : Arrival::two_senders;
    const auto whole = static_cast<double>(sender.missing) < whole_limit * static_cast<double>(sender.frames);
    const auto worst = worst_loss_of(evidence, source, sender.source);
    return whole && worst >= split_limit ? Arrival::split : Arrival::usual;
}

std::string where_of(const Evidence& evidence, std::size_t source, const SenderStream& sender) {
    std::string where;
    for (const auto& [link, frames] : sender.links) {
        if (frames < least_heard && sender.links.size() > 1) continue;
        where += (where.empty() ? "" : ", ") + std::string(evidence.name_of(link));
    }
    return where.empty() ? evidence.sources[source].name : where;
}

words::TwoSenders two_senders(const Evidence& evidence, std::size_t source, const SenderStream& sender) {
    const auto where = where_of(evidence, source, sender);
    if (has_two_clocks(evidence, sender.source)) return {where, "Their clocks (time_boot_ms) differ."};
    if (has_other_times(sender)) return {where, "The clocks of the links differ (SYSTEM_TIME)."};
    if (sender.changes_of_kind >= least_changes)
        return {where, "The kind of vehicle in the HEARTBEATs changes to and fro."};
    if (is_mixed(evidence, source, sender)) return {where, "Two sequences of numbers mix on one link."};
    return {where, "Each link has a sequence of numbers of its own."};
}

void find_sender(const Evidence& evidence, std::size_t source, const SenderStream& sender, Findings& findings) {
    switch (arrival_of(evidence, source, sender)) {
        case Arrival::usual: return;
        case Arrival::two_senders:
            findings.push_back(words::two_senders(sender.source, two_senders(evidence, source, sender)));
            return;
        case Arrival::two_links: findings.push_back(words::two_links(evidence, source, sender)); return;
        case Arrival::split:
            findings.push_back(
                words::split_stream(evidence, source, sender, worst_loss_of(evidence, source, sender.source)));
            return;
        case Arrival::duplicates: findings.push_back(words::duplicates(evidence, source, sender)); return;
    }
}

}  // namespace

const SenderStream* stream_of(const Evidence& evidence, std::size_t source, Source sender) {
    if (source >= evidence.senders.size()) return nullptr;
    const auto& all = evidence.senders[source];
    const auto at = std::ranges::find(all, sender, &SenderStream::source);
    return at == all.end() ? nullptr : &*at;
}

Arrival arrival_of(const Evidence& evidence, std::size_t source, const SenderStream& sender) {
    if (has_two_clocks(evidence, sender.source) || has_other_times(sender) || sender.changes_of_kind >= least_changes ||
        is_mixed(evidence, source, sender))
        return Arrival::two_senders;
    if (busy_links(sender) > 1)
        if (const auto by_links = arrival_by_links(evidence, source, sender); by_links != Arrival::usual)
            return by_links;
    if (is_share(sender.copies_on_link, sender.frames, copies_limit)) return Arrival::duplicates;
    return Arrival::usual;
}

void find_senders(const Evidence& evidence, Findings& findings) {
    for (std::size_t source = 0; source < evidence.senders.size(); ++source)
        for (const auto& sender : evidence.senders[source]) find_sender(evidence, source, sender, findings);
}

namespace {

// HIGH_LATENCY is sent instead of HEARTBEAT on a slow link. HIL_SENSOR comes from a simulator, which is no vehicle.
bool stands_for_heartbeat(MessageId id) {
    return id == msg::HighLatency::id || id == msg::HighLatency2::id || id == msg::HilSensor::id;
}

// A system that sends a stream, and not only answers.
struct System {
    std::uint64_t frames = 0, heartbeats = 0;
    WallTime first = WallTime::max(), last = WallTime::min();
    std::size_t source = 0;
};

bool is_exempt(const Evidence& evidence, SystemId system) {
    bool has_others = false;
    for (const auto& stream : evidence.streams) {
        if (stream.source.system != system) continue;
        if (stands_for_heartbeat(stream.id)) return true;
        has_others = has_others || !is_of_radio(stream.id);
    }
    return !has_others;
}

}  // namespace

void find_missing_heartbeats(const Evidence& evidence, Findings& findings) {
    constexpr auto least_time = std::chrono::milliseconds(1500);  // HEARTBEATs come once a second
    std::map<SystemId, System> systems;
    for (std::size_t source = 0; source < evidence.senders.size(); ++source) {
        for (const auto& sender : evidence.senders[source]) {
            auto& system = systems[sender.source.system];
            if (system.frames == 0) system.source = source;
            system.frames += sender.frames;
            system.heartbeats += sender.heartbeats;
            system.first = std::min(system.first, sender.first);
            system.last = std::max(system.last, sender.last);
        }
    }
    for (const auto& [id, system] : systems)
        if (system.heartbeats == 0 && system.frames >= least_heard && system.last - system.first >= least_time &&
            id.value != 0 && !is_exempt(evidence, id))
            findings.push_back(words::no_heartbeat(evidence, system.source, id, system.frames));
}

void find_unsigned(const Evidence& evidence, Findings& findings) {
    constexpr std::uint64_t some = 3;
    for (std::size_t source = 0; source < evidence.senders.size(); ++source) {
        std::vector<Source> with, without;
        for (const auto& sender : evidence.senders[source]) {
            if (sender.signed_frames >= some && sender.unsigned_frames >= some)
                findings.push_back(words::partly_signed(evidence.sources[source], sender));
            else if (sender.signed_frames >= some) with.push_back(sender.source);
            else if (sender.unsigned_frames >= some) without.push_back(sender.source);
        }
        if (!with.empty() && !without.empty())
            findings.push_back(words::unsigned_frames(evidence.sources[source], with, without));
    }
}

void find_clocks(const Evidence& evidence, Findings& findings) {
    for (const auto& alarm : evidence.alarms) {
        const bool is_clock = alarm.kind == Alarm::Kind::clock || alarm.kind == Alarm::Kind::restart;
        const bool is_silent = alarm.kind == Alarm::Kind::silent && !alarm.ended && !evidence.is_recorded;
        if ((is_clock && !has_two_clocks(evidence, alarm.source)) || is_silent)
            findings.push_back(words::of_alarm(alarm));
    }
}

}  // namespace mavloom::observe::rules
