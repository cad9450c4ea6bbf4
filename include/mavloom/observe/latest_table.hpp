// SPDX-License-Identifier: MIT
// The latest message of each link, source, message id and instance (battery 1, battery 2), with its statistics.
//
// One owner thread. Bounded in rows. Allocates for a new row, never for a known one. Rows keep their place in memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "mavloom/base/secret_hash.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/message/instance.hpp"
#include "mavloom/observe/heard.hpp"
#include "mavloom/observe/traffic_table.hpp"

namespace mavloom::observe {

// A sender or a message is silent if nothing was heard of it for so long. Heartbeats come once a second (MAVLink guide,
// "Heartbeat"); QGroundControl reports a lost connection after 3.5 s.
inline constexpr Nanoseconds silence = std::chrono::seconds{5};

struct LinkTotal {
    std::string name;
    std::uint64_t bytes = 0;  // of all frames that have a row
    std::size_t rows = 0;
};

struct LatestRow {
    TrafficRow traffic;
    const dialect::Message* message = nullptr;  // null: it has no definition
    const dialect::Field* instance_field = nullptr;
    std::uint64_t instance_number = 0;  // of a text, a hash
    LinkTotal* link = nullptr;
    std::uint64_t born = 0, number = 0;  // the numbers of its first and latest frame, among the frames of the table
    MonoTime heard{};                    // when the latest frame came
    std::uint32_t place = 0;             // in the table, from 0
    std::uint8_t tag = 0;                // free for the owner of the table

    // Jitter as in RFC 3550, section 6.4.1. The usual gap stands in for the sender's own times, which MAVLink frames do
    // not have. It is a running mean of the gaps, of the same weight (1/16).
    Nanoseconds usual_gap{}, jitter{};

    std::uint8_t payload_size = 0;
    std::array<std::uint8_t, wire::max_payload_length> payload_bytes{};

    [[nodiscard]] ByteView payload() const noexcept { return {payload_bytes.data(), payload_size}; }
    [[nodiscard]] std::optional<message::Instance> instance() const;
    // How long after its latest frame the row is silent. Empty if its frames have no steady rate, such as events: that
    // takes 10 s, and gaps that differ by less than half of the usual one.
    [[nodiscard]] std::optional<Nanoseconds> silent_after() const noexcept;
    // Of all bytes of the link, 0 to 1.
    [[nodiscard]] double share() const noexcept;
};

class LatestTable {
public:
    static constexpr std::size_t max_rows = TrafficTable::max_rows;
    // If the table is full, rows that were silent for so long may leave their place to new ones.
    static constexpr Nanoseconds forgotten_after = std::chrono::seconds{60};

    enum class WhenFull : std::uint8_t { counts, forgets };  // frames that need a new row; silent rows
    // `dialect` must outlive the table.
    explicit LatestTable(const dialect::Dialect& dialect, WhenFull when_full = WhenFull::counts,
                         std::size_t limit = max_rows);

    // Null, and counted, if there is no room for another row. Valid until the row is forgotten: see `born`.
    LatestRow* add(const Heard& heard);

    // By place.
    [[nodiscard]] const std::deque<LatestRow>& rows() const noexcept { return rows_; }
    // Sorted by link, source, message id and instance.
    [[nodiscard]] std::vector<const LatestRow*> sorted() const;
    [[nodiscard]] std::uint64_t frames() const noexcept { return frames_; }
    // Frames that have no row.
    [[nodiscard]] std::uint64_t unlisted() const noexcept { return unlisted_; }

private:
    static constexpr std::size_t recent_rows = 1024;
    struct Key {
        std::uint32_t link;
        std::uint64_t source_and_id, instance;
        friend bool operator==(const Key&, const Key&) = default;
    };
    struct KeyHash {
        std::size_t operator()(const Key& key) const noexcept {
            return secret_hash(secret_hash(key.source_and_id, key.link), key.instance);
        }
    };

    [[nodiscard]] LatestRow*& recent(LinkId link, const wire::FrameView& frame) noexcept;
    [[nodiscard]] LatestRow* find_or_add(const Heard& heard);
    [[nodiscard]] const dialect::Field* instance_field_of(const dialect::Message* message) const noexcept;
    [[nodiscard]] LatestRow* add_row(const Key& key, const Heard& heard, const dialect::Message* message);
    [[nodiscard]] LatestRow* free_row(MonoTime now);
    void forget_silent(MonoTime now);

    const dialect::Dialect& dialect_;
    const WhenFull when_full_;
    const std::size_t limit_;
    std::vector<const dialect::Field*> instance_fields_;  // by message of the dialect
    std::deque<LatestRow> rows_;
    std::unordered_map<Key, LatestRow*, KeyHash> by_key_;
    std::unordered_map<LinkId, LinkTotal> links_;
    // The row that was used last, by a part of its key. Most frames find theirs here.
    std::vector<LatestRow*> recent_ = std::vector<LatestRow*>(recent_rows);
    std::vector<LatestRow*> free_;
    MonoTime may_forget_at_{};
    std::uint64_t frames_ = 0, unlisted_ = 0;
};

}  // namespace mavloom::observe
