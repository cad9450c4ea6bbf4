// SPDX-License-Identifier: MIT
// Each stage alone. Expected values follow from the definition of the fault (docs/guide/faults.md): exact equality with
// the counters, and for random faults bounds of five standard deviations. Seeds are fixed, so that a test passes
// always or never.
#include "fault/stages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

#include "unit/link/fixture.hpp"

namespace mavloom::fault::detail {
namespace {

using namespace std::chrono_literals;
using namespace link::testing;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// Remembers what a stage passes, and when it is due.
class Remember final : public Next {
public:
    void pass(const Piece& piece) noexcept override { pass_at(piece, now); }
    void pass_at(const Piece& piece, MonoTime when) noexcept override {
        pieces.emplace_back(piece.bytes.begin(), piece.bytes.end());
        due.push_back(std::max(when, now));
    }

    MonoTime now{1h};
    std::vector<Bytes> pieces;
    std::vector<MonoTime> due;
};

// A piece that states its number.
Bytes numbered(std::uint32_t number, std::size_t size = 40) {
    Bytes bytes(size);
    for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<std::uint8_t>(number >> (8 * i));
    return bytes;
}
std::uint32_t number_of(const Bytes& bytes) {
    return static_cast<std::uint32_t>(bytes[0] | bytes[1] << 8 | bytes[2] << 16 | bytes[3] << 24);
}

struct Trial {
    Remember next;
    Counter counter;

    void take(link::Stage& stage, const Bytes& bytes) { stage.take({.bytes = bytes}, next.now, next); }
    void take_numbered(link::Stage& stage, std::uint32_t count, Nanoseconds pace = 0ns) {
        for (std::uint32_t i = 0; i < count; ++i, next.now += pace) take(stage, numbered(i));
    }
    [[nodiscard]] std::vector<std::uint32_t> numbers() const {
        std::vector<std::uint32_t> all;
        all.reserve(next.pieces.size());
        for (const Bytes& piece : next.pieces) all.push_back(number_of(piece));
        return all;
    }
    // The lengths of the runs of missing numbers below `count`.
    [[nodiscard]] std::vector<std::uint32_t> gaps(std::uint32_t count) const {
        std::vector<std::uint32_t> all;
        std::uint32_t expected = 0;
        auto arrived = numbers();
        arrived.push_back(count);
        for (const std::uint32_t number : arrived) {
            if (number > expected) all.push_back(number - expected);
            expected = number + 1;
        }
        return all;
    }
};

constexpr std::uint32_t many = 100'000;
constexpr Seed seed{7};

// Five standard deviations of the number of hits among `many`.
double tolerance(double share) { return 5 * std::sqrt(many * share * (1 - share)); }

TEST(Lose, LosesTheShareAndCountsIt) {
    Trial run;
    Lose stage(0.05, seed, run.counter);
    run.take_numbered(stage, many);
    EXPECT_EQ(run.next.pieces.size() + run.counter.value(), many);
    EXPECT_NEAR(static_cast<double>(run.counter.value()), 0.05 * many, tolerance(0.05));
    EXPECT_TRUE(std::ranges::is_sorted(run.numbers()));
    const auto gaps = run.gaps(many);
    const double mean = static_cast<double>(run.counter.value()) / static_cast<double>(gaps.size());
    EXPECT_NEAR(mean, 1 / 0.95, 0.02) << "each is lost on its own";
}

TEST(Lose, AllAndNothing) {
    Trial all, none;
    Lose one(1, seed, all.counter), zero(0, seed, none.counter);
    all.take_numbered(one, 1000);
    none.take_numbered(zero, 1000);
    EXPECT_EQ(all.counter.value(), 1000u);
    EXPECT_THAT(all.next.pieces, IsEmpty());
    EXPECT_EQ(none.counter.value(), 0u);
}

// Mean loss p / (p + r), mean burst 1 / r (Gilbert 1960). A cycle has a mean of 160 pieces and 8 losses. With 625
// cycles, the standard deviation of the number of losses is about 8 * sqrt(2 * 625) = 283.
TEST(LoseInBursts, HasTheMeanLossAndTheMeanBurst) {
    Trial run;
    LoseInBursts stage(0.05, 8, seed, run.counter);
    run.take_numbered(stage, many);
    EXPECT_EQ(run.next.pieces.size() + run.counter.value(), many);
    const auto gaps = run.gaps(many);
    const double mean = static_cast<double>(run.counter.value()) / static_cast<double>(gaps.size());
    EXPECT_NEAR(static_cast<double>(run.counter.value()), 0.05 * many, 5 * 283);
    EXPECT_NEAR(mean, 8, 5 * 8 / std::sqrt(625));
    const auto ones = std::ranges::count(gaps, 1u);  // geometric: 1 of 8 bursts loses one piece
    EXPECT_NEAR(static_cast<double>(ones), static_cast<double>(gaps.size()) / 8, 5 * std::sqrt(625 / 8.0));
}

TEST(Duplicate, PassesTheShareTwiceAndInOrder) {
    Trial run;
    Duplicate stage(0.1, seed, run.counter);
    run.take_numbered(stage, many);
    EXPECT_EQ(run.next.pieces.size(), many + run.counter.value());
    EXPECT_NEAR(static_cast<double>(run.counter.value()), 0.1 * many, tolerance(0.1));
    auto numbers = run.numbers();
    EXPECT_TRUE(std::ranges::is_sorted(numbers));
    const auto copies = std::ranges::unique(numbers);
    EXPECT_EQ(copies.size(), run.counter.value());
}

TEST(Corrupt, InvertsOneBitOfTheShareAndAnyBit) {
    Trial run;
    Corrupt stage(0.5, seed, run.counter);
    std::set<std::size_t> bits;
    std::uint64_t changed = 0;
    const Bytes sent(10, 0x55);
    for (int i = 0; i < 10'000; ++i) run.take(stage, sent);
    for (const Bytes& got : run.next.pieces) {
        ASSERT_EQ(got.size(), sent.size());
        int wrong = 0;
        for (std::size_t byte = 0; byte < got.size(); ++byte) {
            const auto difference = static_cast<std::uint8_t>(got[byte] ^ sent[byte]);
            wrong += std::popcount(difference);
            if (difference != 0) bits.insert(8 * byte + static_cast<std::size_t>(std::countr_zero(difference)));
        }
        ASSERT_LE(wrong, 1);
        changed += static_cast<std::uint64_t>(wrong);
    }
    EXPECT_EQ(changed, run.counter.value());
    EXPECT_NEAR(static_cast<double>(changed), 5000, 5 * 50);
    EXPECT_THAT(bits, SizeIs(80));
}

TEST(CutShort, PassesABeginningOfAnyLength) {
    Trial run;
    CutShort stage(0.5, seed, run.counter);
    const Bytes sent = numbered(0xA1B2C3D4, 10);
    for (int i = 0; i < 10'000; ++i) run.take(stage, sent);
    run.take(stage, {1});
    std::set<std::size_t> lengths;
    std::uint64_t shorter = 0;
    for (const Bytes& got : run.next.pieces) {
        EXPECT_TRUE(std::equal(got.begin(), got.end(), sent.begin()) || got == Bytes{1});
        lengths.insert(got.size());
        shorter += got.size() < 10 ? 1 : 0;
    }
    EXPECT_EQ(shorter, run.counter.value() + 1) << "a single byte cannot be cut";
    EXPECT_THAT(lengths, ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9, 10));
}

TEST(Delay, IsWithinTheJitterAndKeepsTheOrder) {
    Trial run;
    Delay stage(80ms, 20ms, seed, run.counter);
    const MonoTime begin = run.next.now;
    run.take_numbered(stage, 10'000, 100ms);
    std::vector<double> delays_ms;
    for (std::size_t i = 0; i < run.next.due.size(); ++i)
        delays_ms.push_back(
            std::chrono::duration<double, std::milli>(run.next.due[i] - begin - static_cast<int>(i) * 100ms).count());
    EXPECT_EQ(run.counter.value(), 10'000u);
    EXPECT_GE(std::ranges::min(delays_ms), 60);
    EXPECT_LE(std::ranges::max(delays_ms), 100);
    EXPECT_LT(std::ranges::min(delays_ms), 60.1) << "the whole range is used";
    EXPECT_GT(std::ranges::max(delays_ms), 99.9);

    Trial fast;
    Delay jittering(80ms, 80ms, seed, fast.counter);
    fast.take_numbered(jittering, 10'000, 1ms);
    EXPECT_TRUE(std::ranges::is_sorted(fast.next.due));
}

TEST(Delay, WithoutJitterIsExact) {
    Trial run;
    Delay stage(80ms, 0ms, seed, run.counter);
    run.take_numbered(stage, 3, 10ms);
    EXPECT_THAT(run.next.due, ElementsAre(MonoTime{1h + 80ms}, MonoTime{1h + 90ms}, MonoTime{1h + 100ms}));
}

TEST(BlackOut, DropsAtTheEndOfEachPeriodFromTheFirstPieceOn) {
    Trial run;
    BlackOut stage({200ms, 1s}, run.counter);
    run.take_numbered(stage, 30, 100ms);  // 3 seconds
    EXPECT_THAT(run.gaps(30), ElementsAre(2, 2, 2));
    EXPECT_EQ(run.counter.value(), 6u);
    EXPECT_THAT(run.numbers(), ::testing::AllOf(::testing::Contains(7), ::testing::Not(::testing::Contains(8)),
                                                ::testing::Not(::testing::Contains(9)), ::testing::Contains(10)));
}

TEST(Stall, HoldsUntilTheEndOfTheEpisodeAndLosesNothing) {
    Trial run;
    Stall stage({200ms, 1s}, run.counter);
    run.take_numbered(stage, 12, 100ms);
    EXPECT_EQ(run.counter.value(), 2u);
    ASSERT_THAT(run.next.due, SizeIs(12));
    EXPECT_EQ(run.next.due[7], MonoTime{1h + 700ms});
    EXPECT_EQ(run.next.due[8], MonoTime{1h + 1s});
    EXPECT_EQ(run.next.due[9], MonoTime{1h + 1s});
    EXPECT_EQ(run.next.due[10], MonoTime{1h + 1s});
}

TEST(Reorder, HoldsTheShareBack) {
    Trial run;
    Reorder stage(0.1, 50ms, seed, run.counter);
    run.take_numbered(stage, many, 1ms);
    std::uint64_t held = 0;
    for (std::size_t i = 0; i < many; ++i) {
        const Nanoseconds late = run.next.due[i] - MonoTime{1h + static_cast<int>(i) * 1ms};
        ASSERT_TRUE(late == 0ms || late == 50ms);
        held += late == 0ms ? 0 : 1;
    }
    EXPECT_EQ(held, run.counter.value());
    EXPECT_NEAR(static_cast<double>(held), 0.1 * many, tolerance(0.1));
}

// 1000 bytes a second: a piece of 40 bytes takes 40 ms. The queue of 400 bytes holds 10 of them.
TEST(Narrow, IsAsFastAsTheLineAndDropsWhatTheQueueCannotHold) {
    Trial run;
    Narrow stage(1000, 400, run.counter);
    run.take_numbered(stage, 25);
    EXPECT_THAT(run.numbers(), ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9));
    EXPECT_EQ(run.counter.value(), 15u);
    for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(run.next.due[i], MonoTime{1h + static_cast<int>(i + 1) * 40ms});

    run.next.now = MonoTime{1h + 100ms};  // 300 bytes wait
    run.take_numbered(stage, 4);
    EXPECT_EQ(run.counter.value(), 17u);
    EXPECT_EQ(run.next.due.back(), MonoTime{1h + 480ms});

    run.next.now = MonoTime{1h + 10s};
    run.take(stage, Bytes(1000));
    EXPECT_EQ(run.counter.value(), 17u) << "an empty line takes any piece";
    EXPECT_EQ(run.next.due.back(), MonoTime{1h + 11s});
}

TEST(CutIntoFrames, MakesAPieceOfEachFrameHoweverTheyAreRead) {
    Bytes stream;
    std::vector<Bytes> expected;
    for (std::uint8_t i = 0; i < 20; ++i) {
        expected.push_back(i % 2 == 0 ? heartbeat(i) : attitude(i));
        stream = std::move(stream) + expected.back();
    }
    for (const std::size_t read : {1u, 7u, 30u, 5000u}) {
        Trial run;
        CutIntoFrames stage(table());
        for (std::size_t at = 0; at < stream.size(); at += read)
            run.take(stage, {stream.begin() + static_cast<std::ptrdiff_t>(at),
                             stream.begin() + static_cast<std::ptrdiff_t>(std::min(at + read, stream.size()))});
        EXPECT_THAT(run.next.pieces, ElementsAreArray(expected)) << read;
    }
}

// A message that the table lacks.
Bytes unknown_frame() {
    constexpr wire::MessageInfo info{MessageId{9999}, 1, 9, 9};
    wire::FrameBuffer buffer;
    const auto frame = wire::write_frame(buffer, {wire::Version::v2, 0, {SystemId{1}, ComponentId{1}}}, info,
                                         Bytes(9, 7));
    return {frame.bytes().begin(), frame.bytes().end()};
}

TEST(CutIntoFrames, InSilencePassesWhatAFalseStartHoldsBack) {
    Trial run;
    CutIntoFrames stage(table());
    run.take(stage, Bytes{0xFD} + heartbeat(0));
    EXPECT_THAT(run.next.pieces, IsEmpty()) << "the start byte claims more bytes";
    ASSERT_TRUE(stage.tick_due());
    run.next.now = *stage.tick_due();
    stage.tick(run.next.now, {}, run.next);
    EXPECT_THAT(run.next.pieces, ElementsAre(Bytes{0xFD}, heartbeat(0)));
    EXPECT_FALSE(stage.tick_due());
}

TEST(CutIntoFrames, InSilenceAFrameOfAnUnknownMessageWaitsNoLonger) {
    Trial run;
    CutIntoFrames stage(table());
    run.take(stage, unknown_frame());
    EXPECT_THAT(run.next.pieces, IsEmpty());
    ASSERT_TRUE(stage.tick_due());
    stage.tick(*stage.tick_due(), {}, run.next);
    EXPECT_THAT(run.next.pieces, ElementsAre(unknown_frame()));
}

TEST(CutIntoFrames, InSilenceHalfAFrameWaitsForItsRest) {
    Trial run;
    CutIntoFrames stage(table());
    const Bytes frame = heartbeat(0);
    run.take(stage, {frame.begin(), frame.begin() + 10});
    ASSERT_TRUE(stage.tick_due());
    stage.tick(*stage.tick_due(), {}, run.next);
    EXPECT_FALSE(stage.tick_due());
    run.take(stage, {frame.begin() + 10, frame.end()});
    EXPECT_THAT(run.next.pieces, ElementsAre(frame));
}

TEST(CutIntoFrames, KeepsNoByteForItself) {
    Bytes damaged = heartbeat(1);
    damaged.back() ^= 1;
    Bytes half = attitude(3);
    half.resize(half.size() / 2);
    const Bytes stream = Bytes{1, 2, 3} + heartbeat(0) + damaged + Bytes{0xFD, 0xFE} + heartbeat(4) + half;
    for (const std::size_t read : {1u, 5u, 1000u}) {
        Trial run;
        CutIntoFrames stage(table());
        for (std::size_t at = 0; at < stream.size(); at += read)
            run.take(stage, {stream.begin() + static_cast<std::ptrdiff_t>(at),
                             stream.begin() + static_cast<std::ptrdiff_t>(std::min(at + read, stream.size()))});
        stage.finish({}, run.next);
        Bytes all;
        for (const Bytes& piece : run.next.pieces) all = std::move(all) + piece;
        EXPECT_EQ(all, stream) << read;
        EXPECT_THAT(run.next.pieces, ::testing::Contains(heartbeat(0)));
    }
}

TEST(Draws, AreTheSameOnEveryMachine) {
    Draws draws(Seed(0));
    const std::uint64_t first = draws.next(), second = draws.next();
    Draws again(Seed(0)), other(Seed(1));
    EXPECT_EQ(again.next(), first);
    EXPECT_EQ(again.next(), second);
    EXPECT_NE(other.next(), first);
    // The first outputs of SplitMix64 for the state 0, from the reference implementation (prng.di.unimi.it).
    EXPECT_EQ(mixed(0x9e3779b97f4a7c15), 0xe220a8397b1dcdafu);
    EXPECT_EQ(mixed(2 * 0x9e3779b97f4a7c15), 0x6e789e6aa1b965f4u);
}

TEST(Draws, OfFaultsDirectionsAndLinksDiffer) {
    std::set<std::uint64_t> values;
    for (const char* label : {"a", "b", "ab"})
        for (const std::uint64_t ordinal : {0u, 1u, 256u})
            for (const char* way : {"in", "out"})
                for (const char* fault : {"loss", "delay"})
                    values.insert(Seed(1).with(label).with(ordinal).with(way).with(fault).value());
    EXPECT_THAT(values, SizeIs(3 * 3 * 2 * 2));
}

}  // namespace
}  // namespace mavloom::fault::detail
