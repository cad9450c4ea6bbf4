// SPDX-License-Identifier: MIT
// Snapshot: what an Inspector knew at one moment, as the views show it. Plain data, independent of the Inspector.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mavloom/observe/inspector.hpp"
#include "mavloom/view/history.hpp"

namespace mavloom::view {

struct Now {
    WallTime wall{};
    MonoTime mono{};
};

struct Row {
    observe::LatestRow its;    // without its link
    double hz = 0, share = 0;  // the recent rate of a silent row is 0
    bool is_silent = false;    // the message, or all of its sender

    [[nodiscard]] RowKey key() const noexcept { return key_of(its); }
};

// Of a recording that is played.
struct Playing {
    WallTime begin{}, end{};
    double speed = 1;
    bool is_halted = false, is_over = false;
};

// Of a router: a link by which it reaches a sender.
struct Route {
    std::string router{};
    Source source{};
    std::string link{};
    Nanoseconds age{};
    std::uint64_t frames = 0;
    std::string error{};  // why the router's routes are not known
};

struct Snapshot {
    const dialect::Dialect* dialect = nullptr;
    Now now{};
    MonoTime began{};
    std::string title{};      // the sources
    std::vector<Row> rows{};  // by link, source, name and instance
    std::map<LinkId, std::string> links{};
    std::vector<observe::Vehicle> vehicles{};
    std::vector<observe::Hop> hops{};  // the last one is this program
    std::vector<observe::Alarm> alarms{};
    std::vector<Route> routes{};
    std::vector<observe::SenderLoss> losses{};
    std::vector<std::string> notices{};  // of the program itself, newest last
    std::vector<std::string> hints{};    // shown while nothing was heard; empty: the notices are
    std::optional<Playing> playing{};
    std::uint64_t frames = 0;
    double hz = 0, bytes_per_s = 0;
    History history{};  // of the open message

    [[nodiscard]] const Row* find(const std::optional<RowKey>& key) const;
    [[nodiscard]] const observe::SenderLoss* loss_of(LinkId link, Source source) const;
};

enum class Rates : std::uint8_t { recent, average };

// `dialect` must outlive the snapshot. Fills what the Inspector has; the caller fills the rest.
[[nodiscard]] Snapshot take_snapshot(const dialect::Dialect& dialect, const observe::Inspector& inspector, Now now,
                                     const std::vector<observe::SenderLoss>& losses, Rates rates = Rates::recent);

}  // namespace mavloom::view
