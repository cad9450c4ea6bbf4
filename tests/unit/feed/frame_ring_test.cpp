// SPDX-License-Identifier: MIT
#include "mavloom/feed/frame_ring.hpp"

#include <gtest/gtest.h>

#include "unit/feed/fixture.hpp"

namespace mavloom::feed {
namespace {

using namespace testing;

// One reader with what it read.
struct Reader {
    explicit Reader(const FrameRing& of) : ring(of), at(of.newest()) {}
    // Zero when there is nothing.
    std::uint32_t next() { return ring.next(at, missed, head, frame) ? number_of(frame) : 0; }

    const FrameRing& ring;
    FrameRing::Position at;
    std::uint64_t missed = 0;
    FrameRing::Head head;
    wire::FrameView frame;
};

// A frame with a payload of this length, whose last byte is not 0.
Bytes cut_after(std::size_t length) {
    Bytes payload(255);
    payload[0] = payload[length - 1] = 1;
    return frame_of(131, payload);
}

void push_numbers(FrameRing& ring, std::uint32_t first, std::uint32_t last) {
    for (auto number = first; number <= last; ++number) ring.push({}, view(numbered(number)));
}

TEST(FrameRing, KeepsOrderBytesAndHead) {
    FrameRing ring(smallest_buffer);
    Reader reader(ring);
    const auto short_one = frame_of(0), long_one = frame_of(131, Bytes(255, 7));

    ring.push({.time_ns = 5, .link = 8, .verdict = 16}, view(short_one));
    ring.push({.time_ns = -6, .link = 9}, view(long_one));

    ASSERT_TRUE(ring.next(reader.at, reader.missed, reader.head, reader.frame));
    EXPECT_EQ(Bytes(reader.frame.bytes().begin(), reader.frame.bytes().end()), short_one);
    EXPECT_EQ(reader.head.time_ns, 5);
    EXPECT_EQ(reader.head.link, 8u);
    EXPECT_EQ(reader.head.verdict, 16);
    ASSERT_TRUE(ring.next(reader.at, reader.missed, reader.head, reader.frame));
    EXPECT_EQ(Bytes(reader.frame.bytes().begin(), reader.frame.bytes().end()), long_one);
    EXPECT_EQ(reader.head.time_ns, -6);
    EXPECT_EQ(reader.head.link, 9u);
    EXPECT_FALSE(ring.next(reader.at, reader.missed, reader.head, reader.frame));
}

// Frames of all lengths meet the end of the memory at every offset of 16 bytes.
TEST(FrameRing, WrapsAnywhereWithoutTearingAFrame) {
    FrameRing ring(smallest_buffer);
    Reader reader(ring);
    for (std::uint32_t number = 1; number <= 20'000; ++number) {
        Bytes payload(4 + number * 7 % 251, static_cast<std::uint8_t>(number | 1u));
        std::memcpy(payload.data(), &number, sizeof number);
        const auto bytes = frame_of(131, payload);
        ring.push({.link = number}, view(bytes));
        ASSERT_EQ(reader.next(), number);
        ASSERT_TRUE(std::ranges::equal(reader.frame.bytes(), bytes));
        ASSERT_EQ(reader.head.link, number);
    }
    EXPECT_EQ(reader.missed, 0u);
}

TEST(FrameRing, OverwritesTheOldestAndCountsWhatEachReaderMissed) {
    FrameRing ring(smallest_buffer);
    Reader slow(ring), fast(ring);
    constexpr std::uint32_t last = 10'000;
    for (std::uint32_t number = 1; number <= last; ++number) {
        ring.push({}, view(numbered(number)));
        ASSERT_EQ(fast.next(), number);
    }
    EXPECT_EQ(fast.missed, 0u);

    const auto overwritten = ring.overwritten(slow.at);
    EXPECT_GT(overwritten, 0u);
    EXPECT_EQ(slow.next(), overwritten + 1);
    EXPECT_EQ(slow.missed, overwritten);
    for (auto number = overwritten + 2; number <= last; ++number) ASSERT_EQ(slow.next(), number);
    EXPECT_EQ(slow.next(), 0u);
    EXPECT_EQ(slow.missed, overwritten);
}

// The frames that are left must fit into the capacity, however much was pushed.
TEST(FrameRing, TheCapacityIsInBytes) {
    for (const std::size_t given : {std::size_t{0}, smallest_buffer, smallest_buffer + 1}) {
        FrameRing ring(given);
        Reader reader(ring);
        push_numbers(ring, 1, 30'000);
        const std::size_t frame_bytes = numbered(1).size(), kept = 30'000 - ring.overwritten(reader.at);
        const std::size_t capacity = given <= smallest_buffer ? smallest_buffer : 2 * smallest_buffer;
        EXPECT_LE(kept * frame_bytes, capacity);
        EXPECT_GE(kept * (frame_bytes + 32), capacity - 1024);
    }
}

TEST(FrameRing, AsLongAsThereIsRoomNothingUnreadIsOverwritten) {
    FrameRing ring(smallest_buffer);
    Reader reader(ring);
    std::vector<Bytes> frames;
    for (std::size_t i = 0; i < 251; ++i) frames.push_back(cut_after(5 + i * 97 % 251));
    std::uint64_t pushed = 0, read = 0;
    for (std::uint32_t round = 0; round < 20'000; ++round) {
        for (; ring.has_room(reader.at, 1); ++pushed)  // of many lengths, so that the wrap comes anywhere
            ring.push({}, view(frames[pushed % frames.size()]));
        read += reader.next() != 0;
    }
    while (reader.next() != 0) ++read;
    EXPECT_EQ(reader.missed, 0u);
    EXPECT_EQ(read, pushed);
}

TEST(FrameRing, AReaderBeginsWithWhatComesAfterIt) {
    FrameRing ring(smallest_buffer);
    push_numbers(ring, 1, 3);
    Reader reader(ring);
    EXPECT_EQ(reader.next(), 0u);
    push_numbers(ring, 4, 4);
    EXPECT_EQ(reader.next(), 4u);
    EXPECT_EQ(ring.newest().frame, 4u);
}

}  // namespace
}  // namespace mavloom::feed
