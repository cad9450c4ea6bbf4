// SPDX-License-Identifier: MIT
// What the first lane does is what it would do without the second, and the second does what a queue of its own does
// with the room that is left.
#include "mavloom/net/lane_queue.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <vector>

#include "support/seed.hpp"

namespace mavloom::net {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint8_t second_lane = 0x80;  // set in all bytes of the second lane's blocks

Lane lane_of(std::uint8_t byte) { return (byte & second_lane) != 0 ? Lane::second : Lane::first; }

Bytes joined(std::span<const iovec> pieces) {
    Bytes all;
    for (const iovec& piece : pieces) {
        const auto* bytes = static_cast<const std::uint8_t*>(piece.iov_base);
        all.insert(all.end(), bytes, bytes + piece.iov_len);
    }
    return all;
}

template <class Queue>
Bytes next_write(const Queue& queue, std::size_t most) {
    std::vector<iovec> room(queue.blocks() + 1);
    return joined(std::span(room).first(queue.pieces(room, most)));
}

bool is_of_one_lane(const Bytes& bytes) {
    return std::ranges::all_of(bytes, [&](std::uint8_t byte) { return lane_of(byte) == lane_of(bytes.front()); });
}

// A queue of two lanes, and a queue for each lane that knows nothing of the other.
class LanesAndQueues {
public:
    explicit LanesAndQueues(const BlockQueue::Limits& limits)
        : sut_(limits), alone_{BlockQueue(limits), BlockQueue(limits)} {}

    void push(Lane lane, MonoTime now) {
        const auto fill = static_cast<std::uint8_t>(*rc::gen::inRange(0, 0x80) |
                                                    (lane == Lane::second ? second_lane : 0));
        const Bytes block(*rc::gen::inRange<std::size_t>(1, 60), fill);
        const auto block_class = *rc::gen::inRange<std::uint8_t>(0, 3);
        const auto key = *rc::gen::inRange<std::uint64_t>(0, 4);
        const auto pushed = sut_.lane(lane).push(block, block_class, key, now);
        const auto expected = alone(lane).push(block, block_class, key, now);
        RC_ASSERT(pushed.queued == expected.queued);
        RC_ASSERT(pushed.dropped == expected.dropped);
    }
    void expire(MonoTime now) {
        const auto first = alone(Lane::first).expire(now), second = alone(Lane::second).expire(now);
        RC_ASSERT(sut_.expire(now) == first + second);
    }
    void rewind() {
        sut_.rewind();
        alone(Lane::first).rewind();
        alone(Lane::second).rewind();
    }
    // The kernel takes some of the bytes that it is offered.
    void write() {
        const std::size_t most = *rc::gen::inRange<std::size_t>(0, 200);
        const Bytes offered = next_write(sut_, most);
        RC_ASSERT(offered.empty() == sut_.empty());
        if (offered.empty()) return;
        RC_ASSERT(is_of_one_lane(offered));
        const Lane lane = lane_of(offered.front());
        const bool ends_a_block = lane == Lane::second && !alone(Lane::first).empty();
        RC_ASSERT(!ends_a_block || alone(Lane::second).has_begun());
        RC_ASSERT(offered == next_write(alone(lane), ends_a_block ? 0 : most));
        const std::size_t taken = *rc::gen::inRange<std::size_t>(0, offered.size() + 1);
        const auto whole = alone(lane).consume(taken);
        RC_ASSERT(sut_.consume(taken) == whole);
    }
    void compare() const {
        RC_ASSERT(sut_.bytes() == alone_[0].bytes() + alone_[1].bytes());
        RC_ASSERT(sut_.blocks() == alone_[0].blocks() + alone_[1].blocks());
        RC_ASSERT(sut_.empty() == (alone_[0].empty() && alone_[1].empty()));
    }

private:
    [[nodiscard]] BlockQueue& alone(Lane lane) { return alone_[lane == Lane::first ? 0 : 1]; }

    LaneQueue sut_;
    std::array<BlockQueue, 2> alone_;
};

RC_GTEST_PROP(LaneQueue, TheFirstLaneDoesWhatItDoesWithoutTheSecond, ()) {
    BlockQueue::Limits limits;
    limits.max_bytes = *rc::gen::inRange<std::size_t>(1, 400);
    limits.max_age = {std::chrono::milliseconds(100), std::chrono::milliseconds(100), std::chrono::milliseconds(10)};
    LanesAndQueues sut(limits);
    MonoTime now{std::chrono::seconds(1)};
    const int steps = *rc::gen::inRange(1, 300);
    for (int step = 0; step < steps; ++step) {
        now += std::chrono::milliseconds(*rc::gen::inRange(0, 4));
        switch (*rc::gen::inRange(0, 10)) {
            case 0: sut.expire(now); break;
            case 1: sut.rewind(); break;
            case 2:
            case 3:
            case 4: sut.write(); break;
            case 5:
            case 6: sut.push(Lane::first, now); break;
            default: sut.push(Lane::second, now); break;
        }
        sut.compare();
    }
}

// The datagrams from `from` to the end, and the position behind each.
struct Datagrams {
    std::vector<Bytes> bytes;
    std::vector<LaneQueue::Position> ends;
};
Datagrams gathered(const LaneQueue& queue, std::size_t mtu) {
    Datagrams all;
    std::vector<iovec> room(64);
    auto position = queue.front();
    while (true) {
        const auto got = queue.gather(position, mtu, room);
        if (got.blocks == 0) return all;
        all.bytes.push_back(joined(std::span(room).first(got.pieces)));
        RC_ASSERT(all.bytes.back().size() == got.bytes);
        all.ends.push_back(position);
    }
}

RC_GTEST_PROP(LaneQueue, DatagramsOfTheFirstLaneComeFirstAndNeverHoldBoth, ()) {
    LaneQueue queue(BlockQueue::Limits{});
    const auto fills = *rc::gen::container<Bytes>(rc::gen::arbitrary<std::uint8_t>());
    const auto mtu = *rc::gen::inRange<std::size_t>(0, 200);
    Bytes expected;
    for (const Lane lane : {Lane::first, Lane::second})
        for (const std::uint8_t fill : fills)
            if (lane_of(fill) == lane) expected.insert(expected.end(), 1 + fill % 50, fill);
    for (const std::uint8_t fill : fills) queue.lane(lane_of(fill)).push(Bytes(1 + fill % 50, fill), 2, 0, MonoTime{});

    const Datagrams all = gathered(queue, mtu);
    Bytes bytes;
    for (const Bytes& datagram : all.bytes) {
        RC_ASSERT(is_of_one_lane(datagram));
        bytes.insert(bytes.end(), datagram.begin(), datagram.end());
    }
    RC_ASSERT(bytes == expected);
    if (all.bytes.empty()) return;
    const std::size_t sent = *rc::gen::inRange<std::size_t>(0, all.bytes.size());
    queue.pop(all.ends[sent]);
    const Datagrams rest = gathered(queue, mtu);
    RC_ASSERT(rest.bytes == std::vector(all.bytes.begin() + static_cast<std::ptrdiff_t>(sent) + 1, all.bytes.end()));
}

}  // namespace
}  // namespace mavloom::net
