// SPDX-License-Identifier: MIT
// A module outside `link` may put a chain of stages at the border of a link, between the wire and the parser or queue.
// Each stage may pass, change, cut, copy, drop or hold what it gets. Faults of links are such stages.
//
// Inward, a chain takes what was received, before the parser: a datagram, a message of a transport with threads, or the
// bytes of one read of a stream, which may begin and end anywhere. Outward, it takes one frame at a time, after
// signing and before the queue, on every kind of link. The pieces that it passes outward need not be frames: the queue
// sends any bytes, and treats them as the frame that they were made from. It counts each piece in `frames_out`.
// Several pieces may share a datagram or a message.
//
// Links holds pieces for the stages. They count as queued outward. At most queue_bytes are held in each direction, and
// not more pieces than so many bytes could have frames. Pieces beyond that, and those that are held when the link ends,
// are dropped and count in `held_dropped`. A stage counts its own doings.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/clock.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/link/counters.hpp"
#include "mavloom/wire/message_table.hpp"

namespace mavloom::link {

// To pass other bytes, copy the piece and exchange `bytes`. They are copied before `pass` and `pass_at` return.
struct Piece {
    ByteView bytes;   // never empty; valid during the call
    WallTime time{};  // inward: when it was received
    // Outward: the frame's class, key and lane, for the queue. For Links.
    std::uint8_t block_class = 0;
    bool is_strangers = false;
    std::uint64_t key = 0;
};

// Takes pieces from a stage, for the next one or for the parser or queue. A stage may call it any number of times.
// Empty pieces are ignored. Outward, a piece may not be longer than the one that the stage got.
class Next {
public:
    virtual ~Next() = default;
    virtual void pass(const Piece& piece) noexcept = 0;
    // Passes the piece on at that time, or at once if it is past. Inward, the piece's time then moves by as much.
    // Pieces leave in the order of their times. So pieces that are passed meanwhile overtake it. Inward on a stream,
    // that tears frames apart.
    virtual void pass_at(const Piece& piece, MonoTime when) noexcept = 0;
};

// Serves one direction of one link. Links' thread calls it.
class Stage {
public:
    virtual ~Stage() = default;
    // `now`: the time of the turn; for a piece that an earlier stage held, the time at which it was due.
    virtual void take(const Piece& piece, MonoTime now, Next& next) noexcept = 0;
    // When to call `tick`, if no piece comes before. Empty: the stage waits for nothing.
    [[nodiscard]] virtual std::optional<MonoTime> tick_due() const noexcept { return std::nullopt; }
    // Passes on what the stage has kept to itself for long enough. After a call at `tick_due`, that is later or empty.
    virtual void tick(MonoTime /*now*/, WallTime /*time*/, Next& /*next*/) noexcept {}
    // The connection has ended, or other stages replace this one. Passes on what the stage itself has kept.
    virtual void finish(WallTime /*time*/, Next& /*next*/) noexcept {}
};

// The chains of one link, each in the order in which a piece passes through its stages.
struct Stages {
    std::vector<std::unique_ptr<Stage>> in, out;
    std::string text{};  // what they do, for LinkInfo::stages
};

// The link that gets stages. The link outlives them.
struct StageSite {
    LinkId link;
    std::string_view name;   // valid during the call
    bool is_stream = false;  // of the scheme, see SchemeRow
    std::uint64_t ordinal;   // how many links the endpoint had before this one, those that are gone included
    LinkCounters& counters;
    const wire::MessageTable& table;
};
using CreateStages = std::function<Stages(const StageSite&)>;

}  // namespace mavloom::link
