// SPDX-License-Identifier: MIT
// The queue of outgoing blocks of one link: two BlockQueues, called lanes. The first lane is sent before the second.
// See docs/design/queues.md.
//
// Each lane has its own bounds, so no block of one lane displaces a block of the other. Blocks of the second lane leave
// only when the first lane is empty. A block that a stream has begun is sent to its end before any other. One datagram
// or one write never holds blocks of both lanes. Memory and errors are those of BlockQueue. Not thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "mavloom/net/block_queue.hpp"

namespace mavloom::net {

enum class Lane : std::uint8_t { first, second };

class LaneQueue {
public:
    struct Position {
        Lane lane = Lane::first;
        BlockQueue::Position place;
    };

    explicit LaneQueue(const BlockQueue::Limits& limits) noexcept : lanes_{BlockQueue(limits), BlockQueue(limits)} {}

    // Push to the lane. Do everything else through LaneQueue.
    [[nodiscard]] BlockQueue& lane(Lane lane) noexcept { return lanes_[static_cast<std::size_t>(lane)]; }

    // See BlockQueue for all that follows.
    std::uint32_t expire(MonoTime now) noexcept { return first().expire(now) + second().expire(now); }

    [[nodiscard]] bool empty() const noexcept { return first().empty() && second().empty(); }
    [[nodiscard]] std::size_t bytes() const noexcept { return first().bytes() + second().bytes(); }
    [[nodiscard]] std::size_t blocks() const noexcept { return first().blocks() + second().blocks(); }

    [[nodiscard]] Position front() const noexcept { return front_of(first().empty() ? Lane::second : Lane::first); }
    [[nodiscard]] BlockQueue::Gathered gather(Position& from, std::size_t max_bytes,
                                              std::span<iovec> room) const noexcept {
        const auto gathered = at(from.lane).gather(from.place, max_bytes, room);
        if (gathered.blocks != 0 || from.lane == Lane::second || second().empty()) return gathered;
        from = front_of(Lane::second);
        return second().gather(from.place, max_bytes, room);
    }
    void pop(Position until) noexcept {
        if (until.lane == Lane::second && !first().empty()) first().clear();
        lane(until.lane).pop(until.place);
    }

    [[nodiscard]] std::size_t pieces(std::span<iovec> room, std::size_t max_bytes = SIZE_MAX) const noexcept {
        const bool only_ends_a_block = second().has_begun() && !first().empty();
        return at(streaming()).pieces(room, only_ends_a_block ? 0 : max_bytes);
    }
    std::size_t consume(std::size_t bytes) noexcept { return lane(streaming()).consume(bytes); }
    void rewind() noexcept {
        first().rewind();
        second().rewind();
    }

private:
    [[nodiscard]] const BlockQueue& at(Lane lane) const noexcept { return lanes_[static_cast<std::size_t>(lane)]; }
    [[nodiscard]] BlockQueue& first() noexcept { return lanes_[0]; }
    [[nodiscard]] BlockQueue& second() noexcept { return lanes_[1]; }
    [[nodiscard]] const BlockQueue& first() const noexcept { return lanes_[0]; }
    [[nodiscard]] const BlockQueue& second() const noexcept { return lanes_[1]; }
    [[nodiscard]] Position front_of(Lane lane) const noexcept { return {lane, at(lane).front()}; }
    // The lane from which a stream takes its next bytes.
    [[nodiscard]] Lane streaming() const noexcept {
        return second().has_begun() || first().empty() ? Lane::second : Lane::first;
    }

    std::array<BlockQueue, 2> lanes_;
};

}  // namespace mavloom::net
