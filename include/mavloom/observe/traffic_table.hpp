// SPDX-License-Identifier: MIT
// What was heard, by link, source and message: count, bytes, and the gaps between arrivals, from which the rate comes (measured time, not a
// nominal window). One owner thread; allocates when a row is new (at most `max_rows`), never for a known one.
// Source: routing.md section 6, the proposal's "per message" list.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::observe {

struct TrafficRow {
    LinkId link;
    Source source;
    MessageId id;
    std::uint64_t count = 0, bytes = 0;
    WallTime first{}, last{};
    Nanoseconds shortest_gap{}, longest_gap{};  // 0 before the second frame

    // A moment, and how many frames had come by then.
    struct Mark {
        WallTime time{};
        std::uint64_t count = 0;
    };
    Mark older{}, newer{};  // at least rate_window apart
    static constexpr Nanoseconds rate_window = std::chrono::seconds{5};

    // Frames a second between the first and the last arrival; 0 before the second frame or where no time has passed.
    [[nodiscard]] double rate_hz() const noexcept;
    // Of the last 5 to 10 s in which it came; when it was silent for longer, or comes that seldom, at most one a gap.
    [[nodiscard]] double recent_rate_hz(WallTime now) const noexcept;
    [[nodiscard]] Nanoseconds mean_gap() const noexcept;
};

class TrafficTable {
public:
    static constexpr std::size_t max_rows = 65'536;

    void add(LinkId link, const wire::FrameView& frame, WallTime time);
    // Gives back the rows of links of which `is_there(LinkId)` says no.
    template <class IsThere>
    void forget_links_unless(IsThere&& is_there) {
        std::erase_if(rows_, [&](const auto& row) { return !is_there(row.second.link); });
    }

    // In no order: a copy and nothing more, for who has no time.
    [[nodiscard]] std::vector<TrafficRow> rows() const;
    // By link, system, component, then message id.
    [[nodiscard]] std::vector<TrafficRow> sorted() const { return sorted(rows()); }
    [[nodiscard]] static std::vector<TrafficRow> sorted(std::vector<TrafficRow> rows);
    // Frames of rows beyond `max_rows`.
    [[nodiscard]] std::uint64_t unlisted() const noexcept { return unlisted_; }

private:
    struct Key {
        std::uint32_t link;
        std::uint64_t source_and_id;
        friend bool operator==(const Key&, const Key&) = default;
    };
    struct KeyHash {
        std::size_t operator()(const Key& key) const noexcept {
            return (key.source_and_id ^ std::uint64_t{key.link} << 40) * 0x9e3779b97f4a7c15u >> 7;
        }
    };

    std::unordered_map<Key, TrafficRow, KeyHash> rows_;
    std::uint64_t unlisted_ = 0;
};

}  // namespace mavloom::observe
