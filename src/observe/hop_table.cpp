// SPDX-License-Identifier: MIT
#include "mavloom/observe/hop_table.hpp"

#include <fmt/format.h>

#include <functional>
#include <string_view>
#include <utility>

#include "mavloom/base/durations.hpp"

namespace mavloom::observe {

namespace {

// Counter pages are up to a quarter of a second old, which is no large part of the longer time.
constexpr auto least_rate_span = std::chrono::seconds(1), rate_span = std::chrono::seconds(5);

double rate(std::uint64_t from, std::uint64_t to, Nanoseconds in) {
    return static_cast<double>(to - from) / seconds(in);
}

// Faults also send on what they damage.
bool is_damage(std::string_view loss) { return loss == "fault_corrupted" || loss == "fault_cut"; }

// `lost` since the alarm began, of `loss.count` since the program started.
std::string text_of(const std::string& name, const NamedCount& loss, std::uint64_t lost) {
    const auto in_all = lost == loss.count ? std::string() : fmt::format(", {} in all", loss.count);
    return fmt::format("{} {} {}{}: {}{}{}", name, is_damage(loss.name) ? "damaged" : "lost", lost, in_all, loss.name,
                       loss.help.empty() ? "" : ", ", loss.help);
}

}  // namespace

void HopTable::set(std::vector<Hop> hops, Alarms& alarms, WallTime time, MonoTime now) {
    hops_ = std::move(hops);
    for (auto& hop : hops_) {
        const auto severity = hop.is_up ? Alarm::Severity::warning : Alarm::Severity::error;
        fill_rates(hop, hop.name, now);
        watch(hop.name, hop.losses, alarms, severity, {time, now});
        for (auto& link : hop.links) {
            const auto name = fmt::format("{}: {}", hop.name, link.name);
            fill_rates(link, name, now);
            if (!link.is_sum) watch(name, link.losses, alarms, severity, {time, now});
        }
    }
    flows_ = std::exchange(new_flows_, {});  // what is gone is forgotten
    growths_ = std::exchange(new_growths_, {});
}

// Counts that fell belong to a program that was started again.
template <class Flowing>
void HopTable::fill_rates(Flowing& of, const std::string& name, MonoTime now) {
    auto& flow = new_flows_[name];
    if (const auto known = flows_.find(name); known != flows_.end()) flow = std::move(known->second);
    if (!flow.empty() && (of.frames_in < flow.back().in || of.frames_out < flow.back().out)) flow.clear();
    flow.push_back({now, of.frames_in, of.frames_out});
    while (flow.size() > 2 && now - flow[1].time >= rate_span) flow.pop_front();
    const auto& from = flow.front();
    if (now - from.time < least_rate_span) return;
    if (!of.hz_in) of.hz_in = rate(from.in, of.frames_in, now - from.time);
    if (!of.hz_out) of.hz_out = rate(from.out, of.frames_out, now - from.time);
}

void HopTable::watch(const std::string& name, const std::vector<NamedCount>& losses, Alarms& alarms,
                     Alarm::Severity severity, When when) {
    for (const auto& loss : losses) watch(name, loss, alarms, severity, when);
}

// Losses before the first call are no news. A loss that is reported for the first time, of a hop that was reported
// before, was 0 until then. "lost" is what a link lost, for which there are alarms of their own.
void HopTable::watch(const std::string& name, const NamedCount& loss, Alarms& alarms, Alarm::Severity severity,
                     When when) {
    if (loss.name == "lost") return;
    const auto key = fmt::format("{}\n{}", name, loss.name);
    const auto at = growths_.find(key);
    const auto before = flows_.contains(name) ? 0 : loss.count;
    Growth growth = at != growths_.end() ? at->second : Growth{before, before};
    const Alarms::Key alarm{Alarm::Kind::drop, {}, std::hash<std::string>{}(key)};
    if (loss.count < growth.last || !alarms.is_raised(alarm)) growth.first = growth.last;
    if (loss.count > growth.last)
        alarms.happened(alarm, {severity, text_of(name, loss, loss.count - growth.first)}, when.time, when.now);
    growth.last = loss.count;
    if (loss.count < growth.first) growth.first = loss.count;
    new_growths_.insert_or_assign(key, growth);
}

}  // namespace mavloom::observe
