// SPDX-License-Identifier: MIT
#include "mavloom/observe/inspector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "observe/parts.hpp"

namespace mavloom::observe {

Inspector::Inspector(const dialect::Dialect& dialect)
    : latest_(dialect, LatestTable::WhenFull::forgets), parts_(new Parts{dialect}) {}
Inspector::~Inspector() = default;

const LatestRow* Inspector::add(const Heard& heard) {
    auto* const row = latest_.add(heard);
    if (row == nullptr) return nullptr;
    if (row->traffic.count == 1) row->tag = handler_of(*row);
    const auto source = row->traffic.source;
    auto* const sender = parts_->vehicles.find(source);
    if (sender != nullptr) {
        sender->heard = heard.now;
        sender->link = heard.link;
    }
    if (row->tag != 0) handle(*parts_, *row, sender, {source, heard.time, heard.now - heard.waited});
    return row;
}

void Inspector::note_losses(std::span<const SenderLoss> losses, WallTime time, MonoTime now) {
    parts_->losses.judge(parts_->alarms, losses, time, now);
}

void Inspector::set_hops(std::vector<Hop> hops, WallTime time, MonoTime now) {
    hops_.set(std::move(hops), parts_->alarms, time, now);
}

void Inspector::watch_silence(WallTime time, MonoTime now) {
    auto& alarms = parts_->alarms;
    std::size_t silent = 0;
    for (const auto& sender : parts_->vehicles.all()) {
        if (sender.heartbeats < heartbeats_before_silence) continue;
        const Alarms::Key key{Alarm::Kind::silent, sender.source};
        const auto quiet = now - sender.heard;
        if (quiet < silence || has_ended(sender.link)) alarms.clear(key, time);
        else if (++silent <= max_silent && !alarms.is_raised(key))
            alarms.raise(key, {Alarm::Severity::error, "nothing is heard of it"}, time, time - quiet);
    }
    constexpr Alarms::Key others{Alarm::Kind::silent};
    if (silent <= max_silent) return alarms.clear(others, time);
    alarms.raise(others, {Alarm::Severity::error, fmt::format("{} more are silent", silent - max_silent)}, time);
}

void Inspector::tick(WallTime time, MonoTime now) {
    watch_silence(time, now);
    parts_->clocks.tick(parts_->alarms, time, now);
    parts_->alarms.tick(time, now);
}

std::vector<Alarm> Inspector::alarms() const { return parts_->alarms.newest_first(); }

std::uint64_t Inspector::evicted_alarms() const { return parts_->alarms.evicted(); }

std::vector<Vehicle> Inspector::vehicles(WallTime time) const {
    std::unordered_map<std::uint32_t, double> hz;  // by sender
    const auto key = [](Source source) { return std::uint32_t{source.system.value} << 8 | source.component.value; };
    for (const auto& row : latest_.rows())
        if (row.born != 0) hz[key(row.traffic.source)] += row.traffic.recent_rate_hz(time);
    std::vector<Vehicle> all(parts_->vehicles.all().begin(), parts_->vehicles.all().end());
    std::ranges::sort(all, {}, &Vehicle::source);
    for (auto& vehicle : all) {
        vehicle.hz = hz[key(vehicle.source)];
        vehicle.has_ended = has_ended(vehicle.link);
    }
    return all;
}

}  // namespace mavloom::observe
