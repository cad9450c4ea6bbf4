// SPDX-License-Identifier: MIT
#include "mavloom/observe/round_trips.hpp"

namespace mavloom::observe {

void RoundTrips::ask(const Open& request) noexcept {
    open_[next_] = request;
    next_ = (next_ + 1) % open_.size();
}

template <class Matches>
std::optional<Nanoseconds> RoundTrips::answer(What what, std::uint64_t id, WallTime time, Matches&& matches) noexcept {
    for (std::size_t back = 1; back <= open_.size(); ++back) {
        auto& request = open_[(next_ + open_.size() - back) % open_.size()];
        if (request.what == What::none && request.time == WallTime{}) break;  // never used
        if (request.what != what || request.id != id || !matches(request)) continue;
        request.what = What::none;
        const auto taken = time - request.time;
        if (taken < Nanoseconds{} || taken > max_age) return std::nullopt;
        return taken;
    }
    return std::nullopt;
}

// The answer repeats ts1, and has its sender's own time as tc1.
std::optional<Nanoseconds> RoundTrips::take(Source source, const msg::Timesync& message, WallTime time) noexcept {
    const auto id = static_cast<std::uint64_t>(message.ts1);
    if (message.tc1 == 0) {
        ask({.what = What::timesync, .from = source, .id = id, .time = time});
        return std::nullopt;
    }
    return answer(What::timesync, id, time, [&](const Open& request) { return request.from != source; });
}

// The answer repeats time and number, and is addressed to the sender of the request.
std::optional<Nanoseconds> RoundTrips::take(Source source, const msg::Ping& message, WallTime time) noexcept {
    if (message.target_system == 0) {
        ask({.what = What::ping, .from = source, .id = message.time_usec, .more = message.seq, .time = time});
        return std::nullopt;
    }
    return answer(What::ping, message.time_usec, time, [&](const Open& request) {
        return request.more == message.seq && request.from.system.value == message.target_system;
    });
}

void RoundTrips::command(Source source, SystemId target, std::uint16_t number, WallTime time) noexcept {
    (void)answer(What::command, number, time,
                 [&](const Open& request) { return request.from == source && request.to == target; });
    ask({.what = What::command, .from = source, .to = target, .id = number, .time = time});
}

// Old senders address the answer to nobody.
std::optional<Nanoseconds> RoundTrips::take(Source source, const msg::CommandAck& message, WallTime time) noexcept {
    return answer(What::command, message.command, time, [&](const Open& request) {
        const bool is_for_it = message.target_system == 0 || message.target_system == request.from.system.value;
        return is_for_it && (request.to == source.system || request.to.value == 0) && request.from != source;
    });
}

}  // namespace mavloom::observe
