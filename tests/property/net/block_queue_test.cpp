// SPDX-License-Identifier: MIT
// The queue beside a list that does the same the simple way.
#include "mavloom/net/block_queue.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <deque>
#include <utility>
#include <vector>

#include "support/seed.hpp"

namespace mavloom::net {
namespace {

struct Model {
    struct Block {
        std::vector<std::uint8_t> bytes;
        std::uint8_t block_class;
        std::uint64_t key;
        MonoTime queued;
        std::size_t number;
    };
    std::size_t max_bytes;
    std::deque<Block> blocks;
    std::size_t begun = 0;
    // Numbers of blocks that a newer one superseded, in that order, since the first jam of what is queued or, if
    // that is later, the first after the last rewind.
    std::vector<std::size_t> superseded;
    bool jammed = false;

    [[nodiscard]] std::size_t bytes() const {
        std::size_t sum = 0;
        for (const Block& b : blocks) sum += b.bytes.size();
        return sum;
    }
    [[nodiscard]] bool pinned(std::size_t i) const { return i == 0 && begun != 0; }
    void supersede(std::uint64_t key) {
        for (std::size_t i = blocks.size(); i-- > 0;) {
            if (blocks[i].key != key) continue;
            superseded.push_back(blocks[i].number);
            return;
        }
    }
    // Those of which a newer one is queued, in the order in which the newer ones came.
    void jam() {
        if (std::exchange(jammed, true)) return;
        superseded.clear();
        std::vector<Block> earlier;
        for (const Block& b : blocks) {
            if (b.key != 0) {
                for (std::size_t j = earlier.size(); j-- > 0;) {
                    if (earlier[j].key != b.key) continue;
                    superseded.push_back(earlier[j].number);
                    break;
                }
            }
            earlier.push_back(b);
        }
    }
    // Pinned blocks may be dropped again.
    void rewind() {
        if (std::exchange(begun, 0) != 0) jammed = false;
    }
    bool drop_one(std::uint8_t arriving) {
        while (!superseded.empty()) {
            const std::size_t number = superseded.front();
            superseded.erase(superseded.begin());
            for (std::size_t i = 0; i < blocks.size(); ++i) {
                if (blocks[i].number != number || pinned(i)) continue;
                erase(i);
                return true;
            }
        }
        for (int c = 2; c >= arriving; --c) {
            for (std::size_t i = 0; i < blocks.size(); ++i) {
                if (blocks[i].block_class != c || pinned(i)) continue;
                erase(i);
                return true;
            }
        }
        return false;
    }
    void erase(std::size_t i) {
        blocks.erase(blocks.begin() + static_cast<std::ptrdiff_t>(i));
        if (blocks.empty()) empty();
    }
    void empty() {
        begun = 0;
        jammed = false;
        superseded.clear();
    }
    // How many were lost.
    std::size_t push(Block block) {
        if (block.block_class != 2) block.key = 0;
        std::size_t may_go = 0, dropped = 0;
        for (std::size_t i = 0; i < blocks.size(); ++i)
            if (blocks[i].block_class >= block.block_class && !pinned(i)) may_go += blocks[i].bytes.size();
        if (bytes() + block.bytes.size() > max_bytes) {
            if (bytes() - may_go + block.bytes.size() > max_bytes) return 1;
            jam();
            if (block.key != 0) supersede(block.key);
            while (bytes() + block.bytes.size() > max_bytes) {
                if (!drop_one(block.block_class)) ADD_FAILURE() << "nothing to drop";
                ++dropped;
            }
        }
        if (jammed && block.key != 0) supersede(block.key);
        blocks.push_back(std::move(block));
        return dropped;
    }
    std::size_t expire(MonoTime now, const BlockQueue::Limits& limits) {
        std::size_t dropped = 0;
        for (std::size_t i = 0; i < blocks.size();) {
            if (!pinned(i) && now - blocks[i].queued > limits.max_age[blocks[i].block_class]) {
                erase(i);
                ++dropped;
            } else {
                ++i;
            }
        }
        return dropped;
    }
    void consume(std::size_t count) {
        begun += count;
        while (!blocks.empty() && begun >= blocks.front().bytes.size()) {
            begun -= blocks.front().bytes.size();
            blocks.pop_front();
        }
        if (blocks.empty()) empty();
    }
    [[nodiscard]] std::vector<std::uint8_t> content() const {
        std::vector<std::uint8_t> all;
        for (const Block& b : blocks) all.insert(all.end(), b.bytes.begin(), b.bytes.end());
        all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(begun));
        return all;
    }
};

std::vector<std::uint8_t> content(const BlockQueue& queue) {
    std::vector<iovec> room(queue.blocks() + 1);
    std::vector<std::uint8_t> all;
    for (const iovec& piece : std::span(room).first(queue.pieces(room))) {
        const auto* bytes = static_cast<const std::uint8_t*>(piece.iov_base);
        all.insert(all.end(), bytes, bytes + piece.iov_len);
    }
    return all;
}

RC_GTEST_PROP(BlockQueue, DoesWhatASimpleListDoes, ()) {
    BlockQueue::Limits limits;
    limits.max_bytes = *rc::gen::inRange<std::size_t>(1, 400);
    limits.max_age = {std::chrono::milliseconds(100), std::chrono::milliseconds(100), std::chrono::milliseconds(10)};
    BlockQueue queue(limits);
    Model model{limits.max_bytes, {}, 0, {}, false};
    MonoTime now{std::chrono::seconds(1)};
    const int steps = *rc::gen::inRange(1, 300);
    for (int step = 0; step < steps; ++step) {
        now += std::chrono::milliseconds(*rc::gen::inRange(0, 4));
        const int action = *rc::gen::inRange(0, 11);
        if (action < 7) {
            Model::Block block{
                std::vector<std::uint8_t>(*rc::gen::inRange<std::size_t>(1, 60), static_cast<std::uint8_t>(step)),
                *rc::gen::inRange<std::uint8_t>(0, 3), *rc::gen::inRange<std::uint64_t>(0, 4), now,
                static_cast<std::size_t>(step)};
            const auto pushed = queue.push(block.bytes, block.block_class, block.key, now);
            RC_ASSERT(pushed.dropped == model.push(std::move(block)));
        } else if (action == 7) {
            RC_ASSERT(queue.expire(now) == model.expire(now, limits));
        } else if (action == 8) {
            queue.rewind();
            model.rewind();
        } else if (!queue.empty()) {
            const std::size_t count = *rc::gen::inRange<std::size_t>(0, content(queue).size() + 1);
            (void)queue.consume(count);
            model.consume(count);
        }
        RC_ASSERT(queue.bytes() == model.bytes());
        RC_ASSERT(queue.blocks() == model.blocks.size());
        RC_ASSERT(content(queue) == model.content());
    }
}

RC_GTEST_PROP(BlockQueue, GatheredDatagramsHoldWholeBlocksInOrder, ()) {
    BlockQueue queue(BlockQueue::Limits{});
    const auto sizes = *rc::gen::container<std::vector<std::size_t>>(rc::gen::inRange<std::size_t>(1, 50));
    const auto mtu = *rc::gen::inRange<std::size_t>(0, 200);
    for (const std::size_t size : sizes) queue.push(std::vector<std::uint8_t>(size), 2, 0, MonoTime{});
    std::vector<iovec> room(64);
    auto position = queue.front();
    std::size_t next = 0;
    while (true) {
        const auto got = queue.gather(position, mtu, room);
        if (got.blocks == 0) break;
        std::size_t bytes = 0;
        for (std::size_t i = 0; i < got.blocks; ++i) bytes += sizes.at(next++);
        RC_ASSERT(got.bytes == bytes);
        RC_ASSERT(bytes <= mtu || got.blocks == 1);
        RC_ASSERT((next == sizes.size() || bytes + sizes[next] > mtu));  // in brackets: else || does not stop early
    }
    RC_ASSERT(next == sizes.size());
}

}  // namespace
}  // namespace mavloom::net
