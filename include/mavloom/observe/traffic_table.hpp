// SPDX-License-Identifier: MIT
// Traffic statistics per link, source and message: frame count, bytes, rates and gaps between arrivals.
// One owner thread. Allocates for a new row (at most `max_rows`), never for a known one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/base/secret_hash.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::observe {

struct TrafficRow {
    LinkId link;
    Source source;
    MessageId id;
    std::uint64_t count = 0, bytes = 0;
    WallTime first{}, last{};
    Nanoseconds shortest_gap{}, longest_gap{};  // both 0 before the second frame

    // A point in time, and the frame count at that time.
    struct Mark {
        WallTime time{};
        std::uint64_t count = 0;
    };
    Mark older{}, newer{};  // at least rate_window apart; equal at the start and after the clock was set back
    static constexpr Nanoseconds rate_window = std::chrono::seconds{5};

    // The average rate between the first and the last frame, in Hz. 0 before the second frame, or if no time has
    // passed.
    [[nodiscard]] double rate_hz() const noexcept;
    // The rate over the last 5 to 10 s, in Hz; for rarer messages, over the last gap. If the last frame is more than 10
    // s old, the rate is at most 1 divided by its age in seconds.
    [[nodiscard]] double recent_rate_hz(WallTime now) const noexcept;
    [[nodiscard]] Nanoseconds mean_gap() const noexcept;

    // A row before its first frame. Each frame is counted; before that, the gap of each but the first.
    [[nodiscard]] static TrafficRow begin(LinkId link, Source source, MessageId id, WallTime time) noexcept {
        const Mark mark{time, 1};
        return {.link = link, .source = source, .id = id, .first = time, .older = mark, .newer = mark};
    }
    void note_gap(WallTime time) noexcept {
        const auto gap = time - last;
        shortest_gap = count == 1 ? gap : std::min(shortest_gap, gap);
        longest_gap = count == 1 ? gap : std::max(longest_gap, gap);
        const auto age = time - newer.time;
        if (age >= rate_window || age < Nanoseconds{}) [[unlikely]]
            move_marks({time, count + 1});
    }
    void count_frame(std::size_t size, WallTime time) noexcept {
        last = time;
        ++count;
        bytes += size;
    }

private:
    void move_marks(Mark now) noexcept;
};

class TrafficTable {
public:
    static constexpr std::size_t max_rows = 32'768;

    void add(LinkId link, const wire::FrameView& frame, WallTime time);
    // Removes the rows of all links for which `is_there(LinkId)` returns false.
    template <class IsThere>
    void forget_links_unless(IsThere&& is_there) {
        for (std::size_t i = 0; i < places_.size(); ++i) {
            if (places_[i] == nullptr || is_there(places_[i]->link)) continue;
            rows_.erase(key_of(*places_[i]));
            places_[i] = nullptr;
            refill_from_ = std::min(refill_from_, i);
        }
    }

    // An unsorted copy of the rows. Faster than `sorted`.
    [[nodiscard]] std::vector<TrafficRow> rows() const;
    // Copies rows in pieces; the table may change between two pieces. Examines the next `most` places from `from` (0
    // for the first piece) and appends their rows to `to`. Returns the place to continue from, or `end` after the last.
    // A row that exists throughout the copy is copied exactly once.
    [[nodiscard]] std::size_t copy_rows(std::size_t from, std::size_t most, std::vector<TrafficRow>& to) const;
    static constexpr std::size_t end = SIZE_MAX;
    [[nodiscard]] std::size_t size() const noexcept { return rows_.size(); }
    // A copy sorted by link, system, component, then message id.
    [[nodiscard]] std::vector<TrafficRow> sorted() const { return sorted(rows()); }
    [[nodiscard]] static std::vector<TrafficRow> sorted(std::vector<TrafficRow> rows);
    // The number of frames that would have needed a row beyond `max_rows`.
    [[nodiscard]] std::uint64_t unlisted() const noexcept { return unlisted_; }

private:
    struct Key {
        std::uint32_t link;
        std::uint64_t source_and_id;
        friend bool operator==(const Key&, const Key&) = default;
    };
    struct KeyHash {
        std::size_t operator()(const Key& key) const noexcept { return secret_hash(key.source_and_id, key.link); }
    };

    [[nodiscard]] static Key key_of(const TrafficRow& row) noexcept { return key_of(row.link, row.source, row.id); }
    [[nodiscard]] static Key key_of(LinkId link, Source source, MessageId id) noexcept;
    using Rows = std::unordered_map<Key, TrafficRow, KeyHash>;
    Rows::iterator add_row(const Key& key, const TrafficRow& row);

    Rows rows_;
    // Each row keeps its place, so that a copy in pieces misses no row. Null: the place is free.
    std::vector<TrafficRow*> places_;
    std::size_t refill_from_ = 0;  // no place before this one is free
    std::uint64_t unlisted_ = 0;
};

}  // namespace mavloom::observe
