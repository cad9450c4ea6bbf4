// SPDX-License-Identifier: MIT
#include "latency.hpp"

#include <algorithm>
#include <functional>
#include <string_view>
#include <vector>

namespace mavloom::app::demo_parts {

// The ring's reader and the receiver of the second place are threads of their own: either may be first.
void Latency::note(const wire::FrameView& frame, WallTime time, bool is_first) {
    const auto bytes = frame.bytes();
    const auto key = std::hash<std::string_view>{}({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    const std::lock_guard lock(mutex_);
    const auto other = open_.find(key);
    if (other == open_.end() || other->second.is_first == is_first) {
        if (open_.size() >= max_open) open_.clear();  // frames that were lost between the places
        open_.insert_or_assign(key, Heard{time, is_first});
        return;
    }
    times_.push_back(is_first ? other->second.time - time : time - other->second.time);
    open_.erase(other);
    if (times_.size() > kept) times_.pop_front();
}

std::optional<LatencyFigures> Latency::figures() const {
    std::vector<Nanoseconds> times;
    {
        const std::lock_guard lock(mutex_);
        times.assign(times_.begin(), times_.end());
    }
    if (times.empty()) return std::nullopt;
    std::ranges::sort(times);
    const auto at = [&](double share) {
        return times[std::min(times.size() - 1, static_cast<std::size_t>(static_cast<double>(times.size()) * share))];
    };
    return LatencyFigures{at(0.5), at(0.99), times.back()};
}

}  // namespace mavloom::app::demo_parts
