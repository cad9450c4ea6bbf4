// SPDX-License-Identifier: MIT
// History: the latest payloads of one message, for plots. One owner thread. Bounded.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "mavloom/observe/latest_table.hpp"

namespace mavloom::view {

struct RowKey {
    LinkId link{};
    Source source{};
    MessageId id{};
    std::uint64_t instance = 0;
    friend auto operator<=>(const RowKey&, const RowKey&) = default;
};
[[nodiscard]] RowKey key_of(const observe::LatestRow& row) noexcept;

struct Point {
    WallTime time{};
    double value = 0;
};

// A number of a message: which field, and which element of it.
struct Number {
    const dialect::Field* field = nullptr;
    std::size_t element = 0;
};

class History {
public:
    static constexpr std::size_t max_payloads = 8192;
    static constexpr Nanoseconds window = std::chrono::seconds{60};

    // Forgets the payloads if the message is another one.
    void watch(const std::optional<RowKey>& key);
    // Keeps the payload if the row is the watched one.
    void take(const observe::LatestRow& row) {
        if (watched_ && key_of(row) == *watched_) keep(row);
    }
    void clear() noexcept { kept_.clear(); }
    [[nodiscard]] bool is_of(const RowKey& key) const noexcept { return watched_ == key; }
    // Of the last `window` before `now`, oldest first, and at most `most` of them. Invalid numbers are left out.
    [[nodiscard]] std::vector<Point> points(const Number& number, WallTime now, std::size_t most = max_payloads) const;

private:
    struct Kept {
        WallTime time{};
        std::uint8_t size = 0;
        std::array<std::uint8_t, wire::max_payload_length> bytes{};
    };
    void keep(const observe::LatestRow& row);

    std::optional<RowKey> watched_;
    const dialect::Message* message_ = nullptr;
    std::deque<Kept> kept_;
    std::size_t dropped_ = 0;  // payloads that were kept before the first one
};

}  // namespace mavloom::view
