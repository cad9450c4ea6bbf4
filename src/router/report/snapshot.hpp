// SPDX-License-Identifier: MIT
// A copy of a router's counters, for reports. The router copies it in pieces, each between two of its turns.
//
// The values of one link belong together; those of different links may be some turns apart.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "mavloom/link/snapshot.hpp"
#include "mavloom/router/router.hpp"
#include "router/newest_heartbeats.hpp"

namespace mavloom::router {

struct Snapshot : link::Snapshot {
    struct OfRecording {
        std::string label;
        std::vector<link::NamedCount> counts;
    };

    // Sorts routes and messages by their ids. Not for the router's thread, because it takes long. Sorts once.
    void sort();

    const dialect::Dialect* dialect = nullptr;
    WallTime time{};
    Nanoseconds uptime{};
    std::vector<link::NamedCount> counts{};
    std::vector<observe::TrafficRow> messages{};
    NewestHeartbeats heartbeats{};
    std::vector<OfRecording> recordings{};
    std::vector<route::RouteInfo> routes{};
    std::vector<route::UnknownTargetInfo> unknown_targets{};
    bool is_complete = false;

private:
    bool is_sorted_ = false;
};

enum class Contents : std::uint8_t { links, routes, all };  // `all` has everything but routes; the others lack `time`

// The snapshots that are being copied. On the router's thread only.
class Snapshots {
public:
    // How many rows a piece has; a link counts as `rows_per_link` of them, and its senders as one each. A piece takes
    // about 0.1 ms (docs/design/turn.md).
    static constexpr std::size_t piece = 512, rows_per_link = 8;

    // Returns a snapshot of which nothing is copied yet. Requests for the same contents share it, so a flood of
    // requests costs no more than a few.
    [[nodiscard]] std::shared_ptr<Snapshot> request(Contents contents);
    // Copies one piece of the oldest snapshot that is not complete.
    void copy_piece(Router& router);

private:
    struct Copy {
        Contents contents;
        std::shared_ptr<Snapshot> to;
        bool has_begun = false;
        std::vector<LinkId> links{};
        // The next of each kind to copy.
        std::size_t link = 0, message = 0, target_system = 0;
        std::size_t copied = 0;  // rows of this piece
    };

    [[nodiscard]] static bool has_all(const Copy& copy) noexcept;
    static void begin(Copy& copy, Router& router);
    static void copy_links(Copy& copy, Router& router);
    static void copy_messages(Copy& copy, const Router& router);
    static void copy_unknown_targets(Copy& copy, const Router& router);

    std::deque<Copy> copies_;
};

// A Report's `copy_more`: copies a piece, and returns true until `snapshot` is complete.
[[nodiscard]] std::function<bool()> copying(Router& router, std::shared_ptr<const Snapshot> snapshot);

}  // namespace mavloom::router
