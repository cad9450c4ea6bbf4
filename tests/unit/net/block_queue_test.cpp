// SPDX-License-Identifier: MIT
#include "mavloom/net/block_queue.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace mavloom::net {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

const MonoTime start{seconds(1000)};

BlockQueue queue_of(std::size_t max_bytes) {
    BlockQueue::Limits limits;
    limits.max_bytes = max_bytes;
    return BlockQueue(limits);
}

BlockQueue::Pushed push(BlockQueue& queue, std::string_view text, std::uint8_t block_class = 2, std::uint64_t key = 0,
                        MonoTime now = start) {
    return queue.push({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, block_class, key, now);
}

std::string text_of(std::span<const iovec> pieces) {
    std::string text;
    for (const iovec& piece : pieces) text.append(static_cast<const char*>(piece.iov_base), piece.iov_len);
    return text;
}

std::string content(const BlockQueue& queue) {
    std::vector<iovec> room(256);
    return text_of(std::span(room).first(queue.pieces(room)));
}

TEST(BlockQueue, KeepsOrderAndLiesInOnePiece) {
    BlockQueue queue = queue_of(100);
    for (const auto* text : {"one", "two", "three"}) EXPECT_TRUE(push(queue, text).queued);
    std::vector<iovec> room(8);
    ASSERT_EQ(queue.pieces(room), 1u);
    EXPECT_EQ(text_of(std::span(room).first(1)), "onetwothree");
    EXPECT_EQ(queue.bytes(), 11u);
    EXPECT_EQ(queue.blocks(), 3u);
}

// For some sizes, the memory area is too small for the last block by a single byte.
TEST(BlockQueue, GrowsForBlocksOfEverySize) {
    for (std::size_t size = 1; size <= 300; ++size) {
        BlockQueue queue = queue_of(40'000);
        std::string expected;
        for (char letter = 'a'; expected.size() + size <= 40'000;
             letter = letter == 'z' ? 'a' : static_cast<char>(letter + 1)) {
            const std::string block(size, letter);
            ASSERT_TRUE(push(queue, block).queued);
            expected += block;
        }
        ASSERT_EQ(content(queue), expected) << size;
    }
}

TEST(BlockQueue, GivesAStreamNoMoreBlocksThanFitYetAlwaysTheFirst) {
    BlockQueue queue = queue_of(100);
    for (const auto* text : {"aaaa", "bbbb", "cccc"}) push(queue, text);
    std::vector<iovec> room(8);
    const auto next = [&](std::size_t most) { return text_of(std::span(room).first(queue.pieces(room, most))); };
    EXPECT_EQ(next(8), "aaaabbbb");
    EXPECT_EQ(next(7), "aaaa");
    EXPECT_EQ(next(1), "aaaa");
    EXPECT_EQ(queue.consume(3), 0u);
    EXPECT_EQ(next(1), "a");
    EXPECT_EQ(next(5), "abbbb");
    EXPECT_EQ(next(SIZE_MAX), "abbbbcccc");
}

TEST(BlockQueue, ReplacesNothingBeforeTheBoundIsReached) {
    BlockQueue queue = queue_of(12);
    for (const auto* text : {"aaa1", "aaa2", "aaa3"}) EXPECT_EQ(push(queue, text, 2, 7).dropped, 0u);
    EXPECT_EQ(content(queue), "aaa1aaa2aaa3");
}

TEST(BlockQueue, AtTheBoundSupersededTelemetryGoesFirst) {
    BlockQueue queue = queue_of(16);
    push(queue, "old1", 2, 1);
    push(queue, "old2", 2, 2);
    push(queue, "new1", 2, 1);
    push(queue, "cmd.", 0);
    EXPECT_EQ(push(queue, "more", 2, 3).dropped, 1u);
    EXPECT_EQ(content(queue), "old2new1cmd.more");
}

TEST(BlockQueue, CountsWhatItDropsByClass) {
    BlockQueue queue = queue_of(10);
    for (const auto block_class : {1, 2, 2}) (void)push(queue, "abc", static_cast<std::uint8_t>(block_class));
    EXPECT_THAT(queue.dropped(), testing::ElementsAre(0, 0, 0));
    EXPECT_EQ(push(queue, "essential", 0).dropped, 3u);
    EXPECT_EQ(push(queue, "late", 2).dropped, 1u);
    EXPECT_THAT(queue.dropped(), testing::ElementsAre(0, 1, 3));
    EXPECT_EQ(queue.expire(start + seconds(60)), 1u);
    EXPECT_THAT(queue.dropped(), testing::ElementsAre(1, 1, 3));
}

TEST(BlockQueue, AnArrivingValueReplacesTheOlderOneOfItsKey) {
    BlockQueue queue = queue_of(12);
    push(queue, "aaa1", 2, 1);
    push(queue, "bbb1", 2, 2);
    push(queue, "ccc1", 2, 3);
    EXPECT_EQ(push(queue, "bbb2", 2, 2).dropped, 1u);
    EXPECT_EQ(content(queue), "aaa1ccc1bbb2");
}

TEST(BlockQueue, KeyZeroIsNeverReplacedOnlyDroppedOldestFirst) {
    BlockQueue queue = queue_of(12);
    push(queue, "log1");
    push(queue, "log2");
    push(queue, "aaa1", 2, 1);
    EXPECT_EQ(push(queue, "log3").dropped, 1u);
    EXPECT_EQ(content(queue), "log2aaa1log3");
}

TEST(BlockQueue, KeysOfMoreImportantClassesAreIgnored) {
    BlockQueue queue = queue_of(8);
    push(queue, "cmd1", 0, 5);
    push(queue, "cmd2", 0, 5);
    EXPECT_EQ(push(queue, "tele", 2, 1).dropped, 1u);
    EXPECT_EQ(content(queue), "cmd1cmd2");
}

TEST(BlockQueue, ClassesGoFromTheLeastImportantUp) {
    BlockQueue queue = queue_of(12);
    push(queue, "cmd1", 0);
    push(queue, "tgt1", 1);
    push(queue, "tel1", 2);
    EXPECT_EQ(push(queue, "cmd2", 0).dropped, 1u);
    EXPECT_EQ(content(queue), "cmd1tgt1cmd2");
    EXPECT_EQ(push(queue, "cmd3", 0).dropped, 1u);
    EXPECT_EQ(content(queue), "cmd1cmd2cmd3");
    EXPECT_EQ(push(queue, "cmd4", 0).dropped, 1u);
    EXPECT_EQ(content(queue), "cmd2cmd3cmd4");
}

TEST(BlockQueue, AnArrivalNeverDisplacesAMoreImportantBlock) {
    BlockQueue queue = queue_of(8);
    push(queue, "cmd1", 0);
    push(queue, "tgt1", 1);
    const auto refused = push(queue, "tele", 2, 9);
    EXPECT_FALSE(refused.queued);
    EXPECT_EQ(refused.dropped, 1u);
    EXPECT_EQ(content(queue), "cmd1tgt1");
}

TEST(BlockQueue, DropsNothingForABlockThatDoesNotFitAnyway) {
    BlockQueue queue = queue_of(8);
    push(queue, "cmd1", 0);
    push(queue, "tel1", 2);
    EXPECT_EQ(push(queue, "longer", 2).dropped, 1u);
    EXPECT_EQ(content(queue), "cmd1tel1");
    EXPECT_FALSE(push(queue, "123456789", 0).queued);
    EXPECT_EQ(content(queue), "cmd1tel1");
}

TEST(BlockQueue, DropsByAgeOfTheClass) {
    BlockQueue queue = queue_of(100);
    push(queue, "cmd1", 0, 0, start);
    push(queue, "tel1", 2, 0, start);
    push(queue, "tel2", 2, 0, start + milliseconds(500));
    EXPECT_EQ(queue.expire(start + seconds(1)), 0u);
    EXPECT_EQ(queue.expire(start + milliseconds(1001)), 1u);
    EXPECT_EQ(content(queue), "cmd1tel2");
    EXPECT_EQ(queue.expire(start + seconds(10)), 1u);
    EXPECT_EQ(content(queue), "cmd1");
    EXPECT_EQ(queue.expire(start + milliseconds(10001)), 1u);
    EXPECT_TRUE(queue.empty());
}

TEST(BlockQueue, ABlockBegunIsNeverDropped) {
    BlockQueue queue = queue_of(8);
    push(queue, "begu", 2, 1);
    push(queue, "tele", 2, 2);
    EXPECT_EQ(queue.consume(1), 0u);
    EXPECT_EQ(push(queue, "new1", 2, 1).dropped, 1u);
    EXPECT_EQ(content(queue), "egunew1");
    EXPECT_EQ(queue.expire(start + seconds(60)), 1u);
    EXPECT_EQ(content(queue), "egu");
    EXPECT_EQ(queue.consume(3), 1u);
    EXPECT_TRUE(queue.empty());
}

TEST(BlockQueue, RewindStartsTheBlockOver) {
    BlockQueue queue = queue_of(100);
    push(queue, "first");
    push(queue, "second");
    EXPECT_EQ(queue.consume(8), 1u);
    EXPECT_EQ(content(queue), "ond");
    queue.rewind();
    EXPECT_EQ(content(queue), "second");
}

TEST(BlockQueue, GathersDatagramsOfWholeBlocks) {
    BlockQueue queue = queue_of(100);
    for (const auto* text : {"aaaa", "bbbb", "cccc", "dddddddddddd"}) push(queue, text);
    std::vector<iovec> room(8);
    auto position = queue.front();
    auto got = queue.gather(position, 10, room);
    EXPECT_EQ(text_of(std::span(room).first(got.pieces)), "aaaabbbb");
    EXPECT_EQ(got.blocks, 2u);
    queue.pop(position);
    got = queue.gather(position, 10, room);
    EXPECT_EQ(text_of(std::span(room).first(got.pieces)), "cccc");
    got = queue.gather(position, 10, room);
    EXPECT_EQ(text_of(std::span(room).first(got.pieces)), "dddddddddddd")
        << "one that is too long for the bound goes alone";
    queue.pop(position);
    EXPECT_TRUE(queue.empty());
    EXPECT_EQ(queue.gather(position, 10, room).blocks, 0u);
}

TEST(BlockQueue, StaysWithinItsBoundOverALongJam) {
    BlockQueue queue = queue_of(10'000);
    push(queue, "commands stay", 0);
    std::size_t dropped = 0;
    for (int i = 0; i < 100'000; ++i) {
        dropped += push(queue, "telemetry of forty bytes, more or less..", 2, 1 + static_cast<std::uint64_t>(i % 7)).dropped;
        ASSERT_LE(queue.bytes(), 10'000u);
    }
    EXPECT_EQ(queue.blocks() + dropped, 100'001u);
    EXPECT_THAT(content(queue), ::testing::StartsWith("commands stay"));
}

void drain(BlockQueue& queue) {
    std::vector<iovec> room(256);
    while (!queue.empty()) {
        std::size_t bytes = 0;
        for (const iovec& piece : std::span(room).first(queue.pieces(room))) bytes += piece.iov_len;
        queue.consume(bytes);
    }
}

// As long as a HEARTBEAT.
constexpr std::string_view short_block = "twenty-one bytes long";
constexpr std::size_t kept_bytes = 65536 + 2048 * 24;

// It took 7 MB.
TEST(BlockQueue, ShortBlocksTakeLittleMemoryInALongJam) {
    BlockQueue queue = queue_of(1 << 20);
    std::size_t most = 0;
    for (int i = 0; i < 300'000; ++i) {
        push(queue, short_block, 2, 0);
        most = std::max(most, queue.memory_bytes());
    }
    EXPECT_GT(queue.bytes(), (1u << 20) - 21);
    EXPECT_LE(most, 2'900'000u);
}

TEST(BlockQueue, FreesItsMemoryAfterAJam) {
    BlockQueue queue = queue_of(1 << 20);
    for (std::uint64_t i = 0; i < 100'000; ++i) push(queue, short_block, 2, 1 + i % 1000);
    drain(queue);
    EXPECT_LE(queue.memory_bytes(), kept_bytes);
}

// `expire` runs while the outlet is blocked.
TEST(BlockQueue, FreesItsMemoryAfterABacklogThatFitted) {
    BlockQueue queue = queue_of(1 << 20);
    for (int i = 0; i < 40'000; ++i) push(queue, short_block);
    EXPECT_EQ(queue.expire(start), 0u);
    drain(queue);
    EXPECT_LE(queue.memory_bytes(), kept_bytes);
}

TEST(BlockQueue, KeepsItsMemoryForTrafficButNotAfterABurst) {
    BlockQueue queue = queue_of(1 << 20);
    for (int turn = 0; turn < 1000; ++turn) {
        for (int i = 0; i < 10'000; ++i) push(queue, short_block);
        drain(queue);
        ASSERT_GT(queue.memory_bytes(), kept_bytes);
    }
    for (int turn = 0; turn < 1000; ++turn) {
        push(queue, short_block);
        drain(queue);
    }
    EXPECT_LE(queue.memory_bytes(), kept_bytes);
}

TEST(BlockQueue, ARewoundBlockMayExpire) {
    BlockQueue queue = queue_of(100);
    push(queue, "begun", 0);
    push(queue, "next", 0, 0, start + seconds(9));
    EXPECT_EQ(queue.consume(2), 0u);
    EXPECT_EQ(queue.expire(start + seconds(11)), 0u) << "a part is with the kernel";
    queue.rewind();
    EXPECT_EQ(queue.expire(start + seconds(11)), 1u);
    EXPECT_EQ(content(queue), "next");
}

TEST(BlockQueue, ARewoundBlockMakesRoom) {
    BlockQueue queue = queue_of(8);
    push(queue, "aaaa");
    push(queue, "bbbb");
    EXPECT_EQ(queue.consume(1), 0u);
    EXPECT_EQ(push(queue, "cccccccc").dropped, 1u);
    EXPECT_EQ(push(queue, "dddd").dropped, 1u);
    EXPECT_EQ(content(queue), "aaadddd");
    queue.rewind();
    const auto pushed = push(queue, "eeeeeeee");
    EXPECT_TRUE(pushed.queued);
    EXPECT_EQ(pushed.dropped, 2u);
    EXPECT_EQ(content(queue), "eeeeeeee");
}

TEST(BlockQueue, ARewoundBlockThatHasANewerOneGoesFirst) {
    BlockQueue queue = queue_of(10);
    push(queue, "aaa", 2, 1);
    push(queue, "bbb", 2, 2);
    push(queue, "A", 2, 1);
    push(queue, "BB", 2, 2);
    EXPECT_EQ(queue.consume(1), 0u);
    EXPECT_EQ(push(queue, "cccc").dropped, 1u) << "bbb; aaa is begun";
    EXPECT_EQ(content(queue), "aaABBcccc");
    queue.rewind();
    EXPECT_EQ(push(queue, "AAA", 2, 1).dropped, 1u) << "aaa, before the A that this one supersedes";
    EXPECT_EQ(content(queue), "ABBccccAAA");
}

}  // namespace
}  // namespace mavloom::net
