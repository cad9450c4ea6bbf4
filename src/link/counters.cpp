// SPDX-License-Identifier: MIT
#include "mavloom/link/counters.hpp"

namespace mavloom::link {

void LinkCounters::add(const LinkCounters& other) noexcept {
    for (const auto& counter : link_counters) (this->*counter.word).add((other.*counter.word).value());
}

void LinkCounters::add(const wire::SequenceTracker::Update& update) noexcept {
    const auto change = [](Counter& counter, std::int32_t by) {
        if (by != 0) counter.set(counter.value() + static_cast<std::uint64_t>(std::int64_t{by}));
    };
    change(lost, update.lost);
    change(late, update.late);
    change(duplicate, update.duplicate);
    change(resync, update.resync);
    if (update.verdict == wire::SequenceTracker::Verdict::untracked) untracked.add();
}

}  // namespace mavloom::link
