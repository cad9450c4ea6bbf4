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

TrafficTable::Key TrafficTable::key_of(LinkId link, Source source, MessageId id) noexcept {
    return {link.value,
            std::uint64_t{id.value} << 16 | std::uint64_t{source.system.value} << 8 | source.component.value};
}

TrafficTable::Rows::iterator TrafficTable::add_row(const Key& key, const TrafficRow& row) {
    const auto added = rows_.emplace(key, row).first;
    while (refill_from_ < places_.size() && places_[refill_from_] != nullptr) ++refill_from_;
    if (refill_from_ == places_.size()) places_.push_back(nullptr);
    places_[refill_from_] = &added->second;
    return added;
}

void TrafficTable::add(LinkId link, const wire::FrameView& frame, WallTime time) {
    const Key key = key_of(link, frame.source(), frame.id());
    auto it = rows_.find(key);
    if (it == rows_.end()) [[unlikely]] {
        if (rows_.size() == max_rows) {
            ++unlisted_;
            return;
        }
        const TrafficRow::Mark mark{time, 1};
        it = add_row(
            key,
            {.link = link, .source = frame.source(), .id = frame.id(), .first = time, .older = mark, .newer = mark});
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

void TrafficTable::note_heartbeat(LinkId link, const wire::FrameView& frame) noexcept {
    const auto row = rows_.find(key_of(link, frame.source(), frame.id()));
    if (row == rows_.end()) return;
    auto& kept = row->second.heartbeat;
    kept = {};
    std::ranges::copy(frame.payload().first(std::min(frame.payload().size(), kept.size())), kept.begin());
}

std::vector<TrafficRow> TrafficTable::rows() const {
    std::vector<TrafficRow> rows;
    rows.reserve(rows_.size());
    (void)copy_rows(0, places_.size(), rows);
    return rows;
}

std::size_t TrafficTable::copy_rows(std::size_t from, std::size_t most, std::vector<TrafficRow>& to) const {
    const std::size_t until = from + std::min(most, places_.size() - std::min(from, places_.size()));
    for (; from < until; ++from)
        if (places_[from] != nullptr) to.push_back(*places_[from]);
    return until < places_.size() ? until : end;
}

std::vector<TrafficRow> TrafficTable::sorted(std::vector<TrafficRow> rows) {
    std::ranges::sort(rows, {}, [](const TrafficRow& r) { return std::tuple(r.link, r.source, r.id); });
    return rows;
}

}  // namespace mavloom::observe
