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
    const std::chrono::duration<double> quiet = now - last;
    std::chrono::duration<double> span = last - from.time;
    const auto gaps = static_cast<double>(count - from.count);
    // Silence after a burst lowers the rate, so include the silence in the span.
    if (span < rate_window && quiet > 4 * span / gaps) span += quiet;
    if (span.count() <= 0 || gaps == 0) return 0;
    const double rate = gaps / span.count();
    return quiet <= 2 * rate_window ? rate : std::min(rate, 1 / quiet.count());
}

Nanoseconds TrafficRow::mean_gap() const noexcept {
    return count > 1 ? (last - first) / static_cast<std::int64_t>(count - 1) : Nanoseconds{};
}

// After a pause, the older mark is the last frame before the pause. If the clock was set back, both marks are reset.
void TrafficRow::move_marks(Mark now) noexcept {
    const auto age = now.time - newer.time;
    older = age < Nanoseconds{} ? now : age > 2 * rate_window ? Mark{last, count} : newer;
    newer = now;
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
        it = add_row(key, TrafficRow::begin(link, frame.source(), frame.id(), time));
    } else {
        it->second.note_gap(time);
    }
    it->second.count_frame(frame.size(), time);
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
