// SPDX-License-Identifier: MIT
#include "mavloom/observe/alarm.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace mavloom::observe {

std::string_view name_of(Alarm::Kind kind) noexcept {
    static constexpr std::array<std::string_view, 11> names{
        "silent", "loss", "drop", "two_senders", "clock", "restart", "battery", "health", "ekf", "failsafe", "text"};
    return names[static_cast<std::size_t>(kind)];
}

Alarm& Alarms::raise(const Key& key, What what, WallTime time, WallTime since) {
    auto& entry = begin(key, time, since);
    entry.alarm.severity = what.severity;
    entry.alarm.text = std::move(what.text);
    entry.alarm.link = what.link;
    return entry.alarm;
}

Alarm& Alarms::happened(const Key& key, What what, WallTime time, MonoTime now) {
    auto& alarm = raise(key, std::move(what), time);
    newest_.find(key)->second->ends_at = now + pause;
    return alarm;
}

Alarms::Entry& Alarms::begin(const Key& key, WallTime time, WallTime since) {
    if (const auto at = newest_.find(key); at != newest_.end()) {
        auto& entry = *at->second;
        if (!entry.alarm.ended || time - *entry.alarm.ended < pause) {
            entry.alarm.ended.reset();
            return entry;
        }
    }
    make_room();
    all_.push_back({key, {.id = ++last_id_, .kind = key.kind, .source = key.source, .since = since}});
    newest_.insert_or_assign(key, std::prev(all_.end()));
    return all_.back();
}

void Alarms::clear(const Key& key, WallTime time) {
    const auto at = newest_.find(key);
    if (at != newest_.end() && !at->second->alarm.ended) at->second->alarm.ended = time;
}

bool Alarms::is_raised(const Key& key) const {
    const auto at = newest_.find(key);
    return at != newest_.end() && !at->second->alarm.ended;
}

void Alarms::tick(WallTime time, MonoTime now) {
    for (auto entry = all_.begin(); entry != all_.end();) {
        auto& alarm = entry->alarm;
        if (!alarm.ended && now >= entry->ends_at) alarm.ended = time;
        entry = alarm.ended && time - *alarm.ended > kept_after_end ? drop(entry) : std::next(entry);
    }
}

void Alarms::make_room() {
    if (all_.size() < max_alarms) return;
    const auto leaves = std::ranges::find_if(
        all_, [](const Entry& entry) { return entry.alarm.ended.has_value() || entry.key.kind == Alarm::Kind::text; });
    drop(leaves != all_.end() ? leaves : all_.begin());
    ++evicted_;
}

Alarms::Entries::iterator Alarms::drop(Entries::iterator entry) {
    if (const auto at = newest_.find(entry->key); at != newest_.end() && at->second == entry) newest_.erase(at);
    return all_.erase(entry);
}

std::vector<Alarm> Alarms::newest_first() const {
    std::vector<Alarm> all;
    all.reserve(all_.size());
    for (auto entry = all_.rbegin(); entry != all_.rend(); ++entry) all.push_back(entry->alarm);
    std::ranges::stable_sort(all, std::ranges::greater{}, &Alarm::since);
    return all;
}

}  // namespace mavloom::observe
