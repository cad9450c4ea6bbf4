// SPDX-License-Identifier: MIT
#include "observe/clock_rules.hpp"

#include <fmt/format.h>

#include <utility>

#include "mavloom/base/durations.hpp"
#include "mavloom/observe/latest_table.hpp"

namespace mavloom::observe {

namespace {

using Kind = Alarm::Kind;
using Severity = Alarm::Severity;
using namespace std::chrono_literals;

constexpr int returns_of_two = 3;
constexpr auto returns_within = 10s;  // the former start counts as another vehicle's if it was heard so recently
constexpr std::uint64_t year_2000_us = 946'684'800'000'000, year_2100_us = 4'102'444'800'000'000;

bool is_near(Nanoseconds difference) { return std::chrono::abs(difference) <= ClockRules::tolerance; }

}  // namespace

ClockRules::Clocks* ClockRules::find_or_add(const Moment& at) {
    const auto key = static_cast<std::uint16_t>(at.source.system.value << 8 | at.source.component.value);
    auto found = all_.find(key);
    if (found == all_.end()) {
        if (all_.size() == max_sources) forget_silent(at.now);
        if (all_.size() == max_sources) return nullptr;
        found = all_.try_emplace(key).first;
    }
    found->second.heard = at.now;
    return &found->second;
}

// Searches all, so it does that once a second at most.
void ClockRules::forget_silent(MonoTime now) {
    if (now < may_forget_at_) return;
    may_forget_at_ = now + std::chrono::seconds(1);
    std::erase_if(all_, [&](const auto& entry) { return now - entry.second.heard > LatestTable::forgotten_after; });
}

// 0: the clock does not run yet.
void ClockRules::boot_time(Alarms& alarms, const Moment& at, std::uint32_t boot_ms) {
    auto* const clocks = boot_ms == 0 ? nullptr : find_or_add(at);
    if (clocks == nullptr) return;
    const auto start = at.now - std::chrono::milliseconds(boot_ms);
    if (clocks->start && is_near(start - clocks->start->at)) {
        clocks->start = {start, at.now};
        return;
    }
    auto& former = clocks->former;
    const bool returns = former && is_near(start - former->at) && at.now - former->heard < returns_within;
    clocks->returns = returns ? clocks->returns + 1 : 0;
    if (clocks->returns >= returns_of_two)
        alarms.happened({Kind::two_senders, at.source, 1},
                        {Severity::error, "two vehicles have this id: their clocks differ"}, at.time, at.now);
    else if (clocks->start && !returns) new_start(alarms, at, *clocks, start);
    former = std::exchange(clocks->start, Start{start, at.now});
}

void ClockRules::new_start(Alarms& alarms, const Moment& at, Clocks& clocks, MonoTime start) {
    const auto later = start - clocks.start->at;
    const auto boot = at.now - start;
    // A clock that stood still has the old time; one that began anew has a time that has passed since.
    if (later > Nanoseconds{} && boot <= at.now - clocks.start->heard + ClockRules::tolerance)
        alarms.happened({Kind::restart, at.source}, {Severity::info, "the vehicle has restarted"}, at.time, at.now);
    else
        alarms.happened(
            {Kind::clock, at.source},
            {Severity::warning, fmt::format("the clock of its messages jumped by {:+.1f} s", -seconds(later))}, at.time,
            at.now);
}

void ClockRules::judge(Alarms& alarms, const Moment& at, const msg::SystemTime& time) {
    boot_time(alarms, at, time.time_boot_ms);
    if (time.time_unix_usec < year_2000_us || time.time_unix_usec > year_2100_us) return;
    auto* const clocks = find_or_add(at);
    if (clocks == nullptr) return;
    const auto from_mono = wall_from_us(time.time_unix_usec).time_since_epoch() - at.now.time_since_epoch();
    const auto former = std::exchange(clocks->day_from_mono, from_mono);
    if (former && !is_near(from_mono - *former))
        alarms.happened({Kind::clock, at.source, 1},
                        {Severity::warning,
                         fmt::format("its time of day (SYSTEM_TIME) jumped by {:+.1f} s", seconds(from_mono - *former))},
                        at.time, at.now);
}

void ClockRules::tick(Alarms& alarms, WallTime time, MonoTime now) {
    const auto from_mono = time.time_since_epoch() - now.time_since_epoch();
    const auto former = std::exchange(own_from_mono_, from_mono);
    if (former && !is_near(from_mono - *former))
        alarms.happened({Kind::clock},
                        {Severity::warning,
                         fmt::format("the clock of this machine was set by {:+.1f} s", seconds(from_mono - *former))},
                        time, now);
}

}  // namespace mavloom::observe
