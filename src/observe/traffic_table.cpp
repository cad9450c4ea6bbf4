// SPDX-License-Identifier: MIT
#include "mavloom/observe/traffic_table.hpp"

#include <algorithm>
#include <tuple>

namespace mavloom::observe {

double TrafficRow::rate_hz() const noexcept {
    const std::chrono::duration<double> span = last - first;
    return count > 1 && span.count() > 0 ? static_cast<double>(count - 1) / span.count() : 0;
}

Nanoseconds TrafficRow::mean_gap() const noexcept {
    return count > 1 ? (last - first) / static_cast<std::int64_t>(count - 1) : Nanoseconds{};
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
    } else {
        auto& row = it->second;
        const auto gap = time - row.last;
        row.shortest_gap = row.count == 1 ? gap : std::min(row.shortest_gap, gap);
        row.longest_gap = row.count == 1 ? gap : std::max(row.longest_gap, gap);
    }
    auto& row = it->second;
    row.last = time;
    ++row.count;
    row.bytes += frame.size();
}

std::vector<TrafficRow> TrafficTable::sorted() const {
    std::vector<TrafficRow> rows;
    rows.reserve(rows_.size());
    for (const auto& [key, row] : rows_) rows.push_back(row);
    std::ranges::sort(rows, {}, [](const TrafficRow& r) { return std::tuple(r.link, r.source, r.id); });
    return rows;
}

}  // namespace mavloom::observe
