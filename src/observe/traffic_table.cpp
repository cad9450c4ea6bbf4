// SPDX-License-Identifier: MIT
#include "mavloom/observe/traffic_table.hpp"

#include <algorithm>
#include <tuple>

namespace mavloom::observe {

double TrafficRow::rate_hz() const noexcept {
    const std::chrono::duration<double> span = last - first;
    return count > 1 && span.count() > 0 ? static_cast<double>(count - 1) / span.count() : 0;
}

double TrafficRow::recent_rate_hz(WallTime now) const noexcept {
    const bool is_long_ago = last - older.time > 3 * rate_window && count > newer.count;
    const Mark& from = is_long_ago ? newer : older;
    const std::chrono::duration<double> silence = now - last;
    std::chrono::duration<double> span = last - from.time;
    const auto gaps = static_cast<double>(count - from.count);
    // Silence after a burst lowers the rate, so include the silence in the span.
    if (span < rate_window && silence > 4 * span / gaps) span += silence;
    if (span.count() <= 0 || gaps == 0) return 0;
    const double rate = gaps / span.count();
    return silence <= 2 * rate_window ? rate : std::min(rate, 1 / silence.count());
}

Nanoseconds TrafficRow::mean_gap() const noexcept {
    return count > 1 ? (last - first) / static_cast<std::int64_t>(count - 1) : Nanoseconds{};
}

// After a pause, the older mark is the last frame before the pause. If the clock was set back, both marks are reset.
static void move_marks(TrafficRow& row, TrafficRow::Mark now) noexcept {
    const auto age = now.time - row.newer.time;
    row.older = age < Nanoseconds{}                 ? now
                : age > 2 * TrafficRow::rate_window ? TrafficRow::Mark{row.last, row.count}
                                                    : row.newer;
    row.newer = now;
}

void TrafficTable::add(LinkId link, const wire::FrameView& frame, WallTime time) {
    const auto source = frame.source();
    const Key key{link.value, std::uint64_t{frame.id().value} << 16 | std::uint64_t{source.system.value} << 8 |
                                  source.component.value};
    auto it = rows_.find(key);
    if (it == rows_.end()) {
        if (rows_.size() == max_rows) {
            ++unlisted_;
            return;
        }
        it = rows_.emplace(key, TrafficRow{link, source, frame.id()}).first;
        it->second.first = time;
        it->second.older = it->second.newer = {time, 1};
    } else {
        auto& row = it->second;
        const auto gap = time - row.last;
        row.shortest_gap = row.count == 1 ? gap : std::min(row.shortest_gap, gap);
        row.longest_gap = row.count == 1 ? gap : std::max(row.longest_gap, gap);
        const auto age = time - row.newer.time;
        if (age >= TrafficRow::rate_window || age < Nanoseconds{}) [[unlikely]]
            move_marks(row, {time, row.count + 1});
    }
    auto& row = it->second;
    row.last = time;
    ++row.count;
    row.bytes += frame.size();
}

std::vector<TrafficRow> TrafficTable::rows() const {
    std::vector<TrafficRow> rows;
    rows.reserve(rows_.size());
    for (const auto& [key, row] : rows_) rows.push_back(row);
    return rows;
}

std::vector<TrafficRow> TrafficTable::sorted(std::vector<TrafficRow> rows) {
    std::ranges::sort(rows, {}, [](const TrafficRow& r) { return std::tuple(r.link, r.source, r.id); });
    return rows;
}

}  // namespace mavloom::observe
