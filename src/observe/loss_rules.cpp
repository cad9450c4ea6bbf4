// SPDX-License-Identifier: MIT
#include "observe/loss_rules.hpp"

#include <fmt/format.h>

#include <utility>

namespace mavloom::observe {

namespace {

constexpr double loss_limit = 0.05, disorder_limit = 0.1;
constexpr std::int64_t least_frames = 10;

Alarms::Key lossy(const SenderLoss& loss) { return {Alarm::Kind::loss, loss.source, loss.link.value}; }
Alarms::Key two_senders(const SenderLoss& loss) {
    return {Alarm::Kind::two_senders, loss.source, std::uint64_t{loss.link.value} << 1};
}

std::int64_t grown(std::uint64_t from, std::uint64_t to) { return static_cast<std::int64_t>(to - from); }

}  // namespace

void LossRules::judge(Alarms& alarms, std::span<const SenderLoss> losses, WallTime time, MonoTime now) {
    for (const auto& loss : losses) {
        const std::pair key{loss.link, loss.source};
        const auto at = begins_.find(key);
        if (at == begins_.end()) {
            if (begins_.size() < max_senders) begins_.emplace(key, Begin{now, loss, now});
            continue;
        }
        at->second.noted = now;
        if (now - at->second.time < span) continue;
        judge_one(alarms, at->second.loss, loss, time);
        at->second = {now, loss, now};
    }
    forget_others(alarms, time, now);
}

void LossRules::forget_others(Alarms& alarms, WallTime time, MonoTime now) {
    std::erase_if(begins_, [&](const auto& entry) {
        const auto& begin = entry.second;
        if (begin.noted == now) return false;
        alarms.clear(lossy(begin.loss), time);
        alarms.clear(two_senders(begin.loss), time);
        return true;
    });
}

// Late frames lower the loss, so it may shrink.
void LossRules::judge_one(Alarms& alarms, const SenderLoss& begin, const SenderLoss& end, WallTime time) {
    const auto received = grown(begin.received, end.received), lost = grown(begin.lost, end.lost);
    const auto disorder = grown(begin.late, end.late) + grown(begin.resync, end.resync);
    const auto share = [](std::int64_t part, std::int64_t all) {
        return part < least_frames || all <= 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(all);
    };
    const double loss = share(lost, received + lost);
    auto text = fmt::format("{:.1f} % of its frames are lost ({} of {} in 10 s)", loss * 100, lost, received + lost);
    if (loss >= loss_limit) alarms.raise(lossy(end), {Alarm::Severity::warning, std::move(text), end.link_name}, time);
    else if (loss < loss_limit / 2) alarms.clear(lossy(end), time);
    constexpr auto mixed = "two senders have this id: their sequence numbers mix";
    if (share(disorder, received) < disorder_limit) alarms.clear(two_senders(end), time);
    else alarms.raise(two_senders(end), {Alarm::Severity::error, mixed, end.link_name}, time);
}

}  // namespace mavloom::observe
