// SPDX-License-Identifier: MIT
#include "mavloom/record/frame_queue.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "support/golden_frames.hpp"

namespace mavloom::record {

namespace {

std::unique_ptr<FrameQueue> queue_of(std::size_t bytes) { return std::move(*FrameQueue::create(bytes)); }

// A tunnel frame that carries `number` in its payload and is shortened to a length that depends on it.
test::Bytes numbered(std::uint32_t number) {
    auto bytes = test::tunnel_v2;
    store_le(bytes.data() + 20, number);
    bytes.resize(30 + number % 100);
    return bytes;
}

FrameQueue::Entry entry(const test::Bytes& bytes, std::int64_t time_ns = 0, std::uint32_t link = 0) {
    return {WallTime{Nanoseconds{time_ns}}, LinkId{link}, wire::FrameView::unchecked(bytes)};
}

std::uint32_t number_of(const FrameQueue::Entry& e) { return load_le<std::uint32_t>(e.frame.bytes().data() + 20); }

}  // namespace

TEST(FrameQueue, GivesBackWhatWentInWithTimeAndLink) {
    const auto sut = queue_of(65536);
    ASSERT_TRUE(sut->push(entry(test::heartbeat_v2, 12345, 7)));
    ASSERT_TRUE(sut->push(entry(test::attitude_v1, -1, 8)));

    const auto first = sut->next();
    ASSERT_TRUE(first);
    EXPECT_EQ(first->time.time_since_epoch().count(), 12345);
    EXPECT_EQ(first->link, LinkId{7});
    EXPECT_EQ(test::copy(first->frame.bytes()), test::heartbeat_v2);
    const auto second = sut->next();
    ASSERT_TRUE(second);
    EXPECT_EQ(second->time.time_since_epoch().count(), -1);
    EXPECT_EQ(test::copy(second->frame.bytes()), test::attitude_v1);
    EXPECT_FALSE(sut->next());
}

TEST(FrameQueue, RefusesWhatDoesNotFitAndTakesItAfterTheReader) {
    const auto sut = queue_of(65536);
    std::uint32_t pushed = 0;
    while (sut->push(entry(numbered(pushed)))) ++pushed;
    EXPECT_GT(pushed, 65536u / (16 + 136));
    EXPECT_LE(sut->used_bytes(), sut->capacity());

    for (std::uint32_t i = 0; i < 8; ++i) ASSERT_EQ(number_of(*sut->next()), i);

    EXPECT_TRUE(sut->push(entry(numbered(pushed))));
    for (std::uint32_t expected = 8; expected <= pushed; ++expected) ASSERT_EQ(number_of(*sut->next()), expected);
    EXPECT_FALSE(sut->next());
}

TEST(FrameQueue, KeepsOrderOverManyWraps) {
    const auto sut = queue_of(65536);
    std::uint32_t written = 0, read = 0;
    while (read < 200'000) {
        for (unsigned burst = written % 37 + 1; burst != 0 && sut->push(entry(numbered(written))); --burst) ++written;
        for (unsigned burst = read % 41 + 1; burst != 0; --burst) {
            const auto e = sut->next();
            if (!e) break;
            ASSERT_EQ(number_of(*e), read);
            ASSERT_EQ(e->frame.size(), 30 + read % 100);
            ++read;
        }
    }
}

TEST(FrameQueue, StaysInItsFirstPartWhileTheReaderKeepsUp) {
    const auto sut = queue_of(64u << 20);
    const std::uint8_t* lowest = nullptr;
    const std::uint8_t* highest = nullptr;
    for (std::uint32_t i = 0; i < 100'000; ++i) {
        ASSERT_TRUE(sut->push(entry(numbered(i))));
        const auto* at = sut->next()->frame.bytes().data();
        EXPECT_FALSE(sut->next());
        lowest = lowest == nullptr ? at : std::min(lowest, at);
        highest = std::max(highest, at);
    }

    EXPECT_LT(highest - lowest, 512 * 1024);
}

// A queue that went back to its start is as large as before, although the reader has not yet followed.
TEST(FrameQueue, HoldsItsWholeCapacityWherever) {
    const auto sut = queue_of(2u << 20);
    std::uint32_t written = 0, read = 0;
    for (int round = 0; round < 20; ++round) {
        std::size_t bytes = 0;
        for (; sut->push(entry(numbered(written))); ++written) bytes += 16 + (30 + written % 100 + 7) / 8 * 8;
        ASSERT_GT(bytes, sut->capacity() - 1024) << round;
        for (unsigned to_read = round % 2 == 0 ? written - read : 5000; to_read != 0; --to_read)
            ASSERT_EQ(number_of(*sut->next()), read++);
        const auto rest = written - read;
        for (unsigned i = 0; i < rest; ++i) ASSERT_EQ(number_of(*sut->next()), read++);
        ASSERT_FALSE(sut->next());
        for (unsigned i = 0; i < 4000 + 17u * static_cast<unsigned>(round); ++i) {
            ASSERT_TRUE(sut->push(entry(numbered(written++))));
            ASSERT_EQ(number_of(*sut->next()), read++);
        }
        ASSERT_FALSE(sut->next());
    }
}

TEST(FrameQueue, EndsAfterCloseOnceItIsEmpty) {
    const auto sut = queue_of(65536);
    ASSERT_TRUE(sut->push(entry(test::heartbeat_v2)));
    sut->publish();
    sut->close();

    EXPECT_TRUE(sut->wait());
    EXPECT_TRUE(sut->next());
    EXPECT_FALSE(sut->next());
    EXPECT_FALSE(sut->wait());
}

TEST(FrameQueue, HandsAMillionFramesFromThreadToThread) {
    const auto sut = queue_of(1u << 18);
    constexpr std::uint32_t total = 1'000'000;
    std::thread writer([&] {
        for (std::uint32_t i = 0; i < total;) {
            const bool taken = sut->push(entry(numbered(i)));
            i += taken;
            if (!taken || i % 64 == 0) sut->publish();
            if (!taken) std::this_thread::yield();
        }
        sut->publish();
        sut->close();
    });
    std::uint32_t expected = 0;
    bool in_order = true;
    while (sut->wait())
        while (const auto e = sut->next()) in_order &= number_of(*e) == expected++;
    writer.join();

    EXPECT_TRUE(in_order);
    EXPECT_EQ(expected, total);
}

}  // namespace mavloom::record
