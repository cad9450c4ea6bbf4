// SPDX-License-Identifier: MIT
#include "edit/rate_limiter.hpp"

#include <algorithm>

namespace mavloom::edit {

RateLimiter::RateLimiter(std::vector<Rate> rates, std::optional<Nanoseconds> others)
    : rates_(std::move(rates)), others_(others) {
    std::sort(rates_.begin(), rates_.end(), [](const Rate& a, const Rate& b) { return a.id < b.id; });
    if (!rates_.empty() || others_) streams_.resize(sets * ways);
}

const Nanoseconds* RateLimiter::interval_of(std::uint32_t id) const noexcept {
    const auto rate = std::lower_bound(rates_.begin(), rates_.end(), id,
                                       [](const Rate& r, std::uint32_t i) { return r.id < i; });
    if (rate != rates_.end() && rate->id == id) return &rate->interval;
    return others_ ? &*others_ : nullptr;
}

RateLimiter::Stream& RateLimiter::stream_of(std::uint64_t key) noexcept {
    const std::size_t set = (key * 0x9e3779b97f4a7c15u >> 32) % sets;
    Stream* const first = streams_.data() + set * ways;
    Stream* oldest = first;
    for (Stream* stream = first; stream != first + ways; ++stream) {
        if (stream->key == key) return *stream;
        if (stream->due < oldest->due) oldest = stream;
    }
    *oldest = {key, WallTime::min()};
    return *oldest;
}

bool RateLimiter::admit(const wire::FrameView& frame, WallTime received) noexcept {
    if (streams_.empty()) return true;
    const Nanoseconds* const interval = interval_of(frame.id().value);
    if (interval == nullptr) return true;
    const auto source = std::uint64_t{frame.system().value} << 8 | frame.component().value;
    Stream& stream = stream_of(source << 24 | frame.id().value);
    // A deadline more than an interval away is from before the clock was set back.
    if (received < stream.due && stream.due - received <= *interval) return false;
    const bool in_step = stream.due != WallTime::min() && received >= stream.due && received - stream.due < *interval;
    stream.due = (in_step ? stream.due : received) + *interval;
    return true;
}

}  // namespace mavloom::edit
