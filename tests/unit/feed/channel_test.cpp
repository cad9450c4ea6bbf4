// SPDX-License-Identifier: MIT
#include "mavloom/feed/channel.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mavloom/record/recorder.hpp"
#include "mavloom/record/tlog_reader.hpp"
#include "mavloom/ring/frames.hpp"
#include "support/golden_frames.hpp"
#include "support/temp_dir.hpp"
#include "unit/feed/fixture.hpp"

namespace mavloom::feed {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::uint32_t many = 10'000;  // more frames than the smallest buffer holds

struct ChannelTest : ::testing::Test {
    std::shared_ptr<Channel> channel = make_channel();
    FrameBatch batch;
};

// ---- readers

TEST_F(ChannelTest, EachReaderGetsEveryFrameInOrder) {
    ChannelReader one(channel, {}), two(channel, {});
    receive_numbers(*channel, 1, 500);
    EXPECT_EQ(numbers_in(one), from_to(1, 500));
    EXPECT_EQ(numbers_in(two), from_to(1, 500));
    EXPECT_THAT(numbers_in(one), IsEmpty());
}

TEST_F(ChannelTest, AReaderBeginsWithWhatArrivesAfterIt) {
    receive_numbers(*channel, 1, 2);
    ChannelReader reader(channel, {});
    EXPECT_THAT(numbers_in(reader), IsEmpty());
    receive_numbers(*channel, 3, 3);
    EXPECT_THAT(numbers_in(reader), ElementsAre(3));
    EXPECT_EQ(reader.missed(), 0u);
}

TEST_F(ChannelTest, ASlowReaderMissesTheOldestAndCostsTheOthersNothing) {
    ChannelReader slow(channel, {}), fast(channel, {});
    std::vector<std::uint32_t> heard;
    for (std::uint32_t number = 1; number <= many; number += 100) {
        receive_numbers(*channel, number, number + 99);
        for (const auto one : numbers_in(fast)) heard.push_back(one);
    }
    EXPECT_EQ(heard, from_to(1, many));
    EXPECT_EQ(fast.missed(), 0u);

    const auto missed = static_cast<std::uint32_t>(slow.missed());  // told before it reads on
    EXPECT_GT(missed, 0u);
    EXPECT_EQ(numbers_in(slow), from_to(missed + 1, many));
    EXPECT_EQ(slow.missed(), missed);
}

TEST_F(ChannelTest, AFilterSelectsBySystemComponentAndId) {
    ChannelReader second_system(channel, make_filter({.systems = {2}})),
        heartbeats(channel, make_filter({.messages = {"HEARTBEAT"}})), nothing(channel, dialect::Filter::none()),
        other_component(channel, make_filter({.components = {9}}));
    receive(*channel, numbered(1, 1));
    receive(*channel, numbered(2, 2));
    receive(*channel, frame_of(0, {}, {SystemId{2}, ComponentId{9}}));
    EXPECT_EQ(numbers_in(second_system).size(), 2u);
    EXPECT_EQ(numbers_in(heartbeats).size(), 1u);
    EXPECT_THAT(numbers_in(nothing), IsEmpty());
    EXPECT_EQ(numbers_in(other_component).size(), 1u);
}

TEST_F(ChannelTest, AFrameComesWithItsTimeLinkDefinitionAndVerdict) {
    ChannelReader reader(channel, {});
    const auto bytes = numbered(1);
    auto of_ring = received(bytes, LinkId{7}, WallTime{5ns});
    of_ring.ring_verdict = 33;
    channel->on_frame(of_ring, {});
    receive(*channel, test::heartbeat_signed_1);
    ASSERT_TRUE(reader.take(batch, 10));
    ASSERT_EQ(batch.size(), 2u);
    const auto first = *batch.next(), second = *batch.next();
    EXPECT_EQ(first.link, 7u);
    EXPECT_EQ(first.time_ns, 5);
    EXPECT_EQ(first.definition, dialect::default_dialect().find(MessageId{attitude_id}));
    EXPECT_EQ(first.verdict, 33);
    EXPECT_EQ(second.verdict, ring::ring_verdict(ring::FrameSignature::unchecked));
}

TEST_F(ChannelTest, WhatAVerifyingEndpointLetsPassIsGood) {
    channel = std::make_shared<Channel>(default_dialect(), std::make_shared<LinkNames>(), smallest_buffer, true);
    ChannelReader reader(channel, {});
    receive(*channel, test::heartbeat_signed_1);
    receive(*channel, test::heartbeat_v2);
    ASSERT_TRUE(reader.take(batch, 10));
    EXPECT_EQ(batch.next()->verdict, ring::ring_verdict(ring::FrameSignature::good));
    EXPECT_EQ(batch.next()->verdict, ring::ring_verdict(ring::FrameSignature::none));
}

// So that the loop thread waits for the mutex only shortly, whatever the filter leaves out.
TEST_F(ChannelTest, OneTakeLooksAtALimitedNumberOfFramesAndAsksForAnother) {
    channel = make_channel(1 << 20);
    ChannelReader reader(channel, make_filter({.systems = {2}}));
    receive_numbers(*channel, 1, many);
    receive(*channel, numbered(many + 1, 2));
    const int fd = *reader.event_fd();
    read_count(fd);
    ASSERT_TRUE(reader.take(batch, 256));
    EXPECT_EQ(batch.size(), 0u);
    EXPECT_LT(reader.seen(), reader.newest());
    EXPECT_EQ(read_count(fd), 1u);
    reader.wait(MonoTime::max());  // returns at once, for there is something to look at
    while (batch.size() == 0) ASSERT_TRUE(reader.take(batch, 256));
    EXPECT_EQ(number_of(batch.frame(*batch.next())), many + 1);
}

// ---- waiting

TEST_F(ChannelTest, TheDescriptorReportsOncePerPollThatFoundNothing) {
    ChannelReader reader(channel, make_filter({.systems = {2}}));
    const int fd = *reader.event_fd();
    EXPECT_EQ(read_count(fd), 1u);  // from the start, so that the first poll is made
    receive_numbers(*channel, 1, 1);
    EXPECT_FALSE(is_readable(fd));  // nobody polled

    ASSERT_TRUE(reader.take(batch, 10));
    receive_numbers(*channel, 2, 2);
    EXPECT_FALSE(is_readable(fd));  // of system 1
    receive(*channel, numbered(3, 2));
    EXPECT_FALSE(is_readable(fd));  // not before the end of the turn
    receive(*channel, numbered(4, 2));
    channel->publish();
    receive(*channel, numbered(5, 2));
    channel->publish();
    EXPECT_EQ(read_count(fd), 1u);

    ASSERT_TRUE(reader.take(batch, 10));
    EXPECT_EQ(batch.size(), 3u);
    receive(*channel, numbered(6, 2));
    channel->publish();
    EXPECT_FALSE(is_readable(fd));  // the poll found something: another one is due anyway
}

TEST_F(ChannelTest, ClosingTheChannelWakesEverybodyAndKeepsTheRest) {
    auto reader = std::make_unique<ChannelReader>(channel, dialect::Filter{}),
         other = std::make_unique<ChannelReader>(channel, dialect::Filter{});
    const int fd = *other->event_fd();
    read_count(fd);
    std::atomic<int> ended{0};
    std::vector<std::thread> waiting;
    for (int i = 0; i < 4; ++i)
        waiting.emplace_back([&] {
            for (FrameBatch mine; reader->take(mine, 1) && mine.size() == 0;) reader->wait(MonoTime::max());
            ++ended;
        });
    channel->close();
    for (auto& thread : waiting) thread.join();
    EXPECT_EQ(ended, 4);
    EXPECT_TRUE(is_readable(fd));
    EXPECT_TRUE(reader->closed());
    receive_numbers(*channel, 1, 1);
    EXPECT_FALSE(other->take(batch, 1));
    EXPECT_EQ(channel->peers(), 0u);
}

TEST_F(ChannelTest, ClosingOneReaderLeavesTheOthers) {
    ChannelReader closing(channel, {}), staying(channel, {});
    const int fd = *closing.event_fd();
    read_count(fd);
    std::thread waiting([&] {
        for (FrameBatch mine; closing.take(mine, 1);) closing.wait(MonoTime::max());
    });
    closing.close();
    closing.close();
    waiting.join();
    EXPECT_TRUE(is_readable(fd));
    receive_numbers(*channel, 1, 3);
    EXPECT_FALSE(staying.closed());
    EXPECT_EQ(numbers_in(staying), from_to(1, 3));
}

// Runs the loop thread's part until `last` was received.
void receive_in_turns(Channel& channel, std::uint32_t last, std::uint32_t a_turn) {
    for (std::uint32_t number = 1; number <= last; number += a_turn) {
        receive_numbers(channel, number, std::min(last, number + a_turn - 1));
        std::this_thread::yield();
    }
}

TEST_F(ChannelTest, ThreadsShareAReaderAndEachFrameGoesToOneOfThem) {
    channel = make_channel(1 << 22);
    ChannelReader reader(channel, {});
    std::array<std::vector<std::uint32_t>, 4> heard;
    std::atomic<std::uint32_t> left{many};
    std::vector<std::thread> threads;
    for (auto& mine : heard)
        threads.emplace_back([&] {
            for (FrameBatch some; left != 0; some.clear()) {
                if (!reader.take(some, 16)) break;
                for (const auto* item = some.next(); item != nullptr; item = some.next(), --left)
                    mine.push_back(number_of(some.frame(*item)));
                if (some.size() == 0) reader.wait(mono_now() + 10ms);
            }
        });
    receive_in_turns(*channel, many, 37);
    for (auto& thread : threads) thread.join();

    std::vector<std::uint32_t> all;
    for (const auto& mine : heard) {
        EXPECT_TRUE(std::ranges::is_sorted(mine));
        all.insert(all.end(), mine.begin(), mine.end());
    }
    std::ranges::sort(all);
    EXPECT_EQ(all, from_to(1, many));
    EXPECT_EQ(reader.missed(), 0u);
}

// One reader waits, one sleeps on its descriptor, one comes and goes, and one asks for newest values: none of them may
// hurt another, and what each of the first two gets and misses is all there was.
TEST_F(ChannelTest, ReadersOfAllKindsShareAChannelThatReceives) {
    std::atomic<bool> done{false};
    const auto read_all = [&](ChannelReader& reader, auto&& wait) {
        std::uint64_t count = 0;
        for (std::uint32_t last = 0; last != many;) {
            const auto numbers = numbers_in(reader);
            EXPECT_TRUE(std::ranges::is_sorted(numbers));
            count += numbers.size();
            if (!numbers.empty()) last = numbers.back();
            else wait();
        }
        EXPECT_EQ(count + reader.missed(), many);
    };
    ChannelReader waits(channel, {}), polls(channel, {});
    std::thread waiting([&] { read_all(waits, [&] { waits.wait(MonoTime::max()); }); });
    std::thread polling([&] {
        const int fd = *polls.event_fd();
        read_all(polls, [&] {
            ASSERT_TRUE(is_readable(fd, long_enough));
            read_count(fd);
        });
    });
    std::thread coming([&] {
        while (!done) {
            ChannelReader reader(channel, make_filter({.systems = {1}}));
            EXPECT_TRUE(std::ranges::is_sorted(numbers_in(reader)));
        }
    });
    std::thread looking([&] {
        for (std::uint64_t before = 0; !done;) {
            const auto latest = channel->latest({}, {}, MonoTime::min());
            if (!latest) continue;
            EXPECT_GE(latest->number, before);
            EXPECT_EQ(number_of(latest->frame()), latest->number);
            before = latest->number;
        }
    });
    receive_in_turns(*channel, many, 50);
    waiting.join();
    polling.join();
    done = true;
    coming.join();
    looking.join();
}

TEST_F(ChannelTest, ClosingWhileItReceivesAndIsReadEndsEveryReader) {
    for (int round = 0; round < 20; ++round) {
        const auto closing = make_channel();
        std::vector<std::thread> readers;
        for (int i = 0; i < 3; ++i)
            readers.emplace_back([&] {
                ChannelReader reader(closing, {});
                for (FrameBatch mine; reader.take(mine, 64); mine.clear()) reader.wait(MonoTime::max());
            });
        receive_in_turns(*closing, 200, 5);
        closing->close();
        for (auto& reader : readers) reader.join();
    }
}

// ---- a source that can pause

struct HeldChannelTest : ChannelTest {
    // Receives turns as long as there is room. Returns the number of the last frame.
    std::uint32_t fill() {
        while (channel->has_room()) {
            receive_numbers(*channel, last + 1, last + Channel::frames_a_turn);
            last += Channel::frames_a_turn;
        }
        return last;
    }
    std::uint32_t last = 0;
    int calls = 0;
    std::unique_ptr<ChannelReader> reader = std::make_unique<ChannelReader>(channel, dialect::Filter{});
    HeldChannelTest() {
        channel->hold_for(reader.get(), [this] { ++calls; });
    }
};

TEST_F(HeldChannelTest, ReadingMakesRoomAndReportsItOnce) {
    fill();
    ASSERT_TRUE(reader->take(batch, 1));
    EXPECT_EQ(calls, 0);  // not yet enough
    while (calls == 0) ASSERT_TRUE(reader->take(batch, batch.size() + 1));
    EXPECT_TRUE(channel->has_room());
    while (batch.size() != last) ASSERT_TRUE(reader->take(batch, last));
    EXPECT_EQ(calls, 1);
    EXPECT_EQ(reader->missed(), 0u);
    fill();
    EXPECT_EQ(numbers_in(*reader).back(), last);
    EXPECT_EQ(calls, 2);
    EXPECT_EQ(reader->missed(), 0u);
}

TEST_F(HeldChannelTest, OtherReadersHoldNothing) {
    ChannelReader other(channel, {});
    while (last < many) {
        fill();
        numbers_in(*reader);
    }
    EXPECT_GT(other.missed(), 0u);
    EXPECT_EQ(reader->missed(), 0u);
}

// Otherwise the source would pause for ever.
TEST_F(HeldChannelTest, AReaderThatIsClosedHoldsNothing) {
    fill();
    reader->close();
    EXPECT_EQ(calls, 1);
    EXPECT_TRUE(channel->has_room());
}

TEST_F(HeldChannelTest, AReaderThatIsDestroyedHoldsNothing) {
    fill();
    reader.reset();
    EXPECT_EQ(calls, 1);
    EXPECT_TRUE(channel->has_room());
}

TEST_F(HeldChannelTest, AClosedChannelDoesNotReportRoom) {
    fill();
    channel->close();
    reader->close();
    EXPECT_EQ(calls, 0);
}

TEST_F(HeldChannelTest, NothingIsMissedWhileTheLoopThreadPausesAndContinues) {
    std::atomic<bool> woken{true};
    channel->hold_for(reader.get(), [&] { woken = true; });
    std::thread loop([&] {
        while (last < many) {
            if (channel->has_room()) fill();
            else EXPECT_TRUE(eventually([&] { return woken.exchange(false); }));
        }
    });
    std::vector<std::uint32_t> heard;
    while (heard.size() < many) {
        const auto some = numbers_in(*reader);
        heard.insert(heard.end(), some.begin(), some.end());
        if (some.empty()) reader->wait(MonoTime::max());
    }
    loop.join();
    for (const auto number : numbers_in(*reader)) heard.push_back(number);
    EXPECT_EQ(heard, from_to(1, last));
    EXPECT_EQ(reader->missed(), 0u);
}

// ---- what a channel knows of its endpoint

// ---- recording

struct RecordedChannelTest : ChannelTest {
    std::shared_ptr<record::Recorder> recorder(const char* name) {
        auto made = record::Recorder::create("test", folder.path() / name, {}, {});
        EXPECT_TRUE(made) << made.error().text;
        return std::move(*made);
    }
    std::vector<std::uint32_t> numbers_recorded(const char* name) {
        auto reader = record::TlogReader::open(folder.path() / name, dialect::default_dialect().wire_table());
        std::vector<std::uint32_t> numbers;
        while (const auto found = reader->next(1 << 20)) numbers.push_back(number_of(found->frame));
        return numbers;
    }
    test::TempDir folder;
};

TEST_F(RecordedChannelTest, ARecorderGetsEveryFrameUntilItsEnd) {
    const auto one = recorder("one.tlog"), two = recorder("two.tlog");
    receive_numbers(*channel, 1, 10);
    channel->record_with(one);
    receive_numbers(*channel, 11, 20);
    channel->record_with(two);
    receive_numbers(*channel, 21, 30);
    channel->end_recording(one);
    receive_numbers(*channel, 31, 40);
    one->stop();
    channel->end_recording(two);
    two->stop();
    EXPECT_EQ(numbers_recorded("one.tlog"), from_to(11, 30));
    EXPECT_EQ(numbers_recorded("two.tlog"), from_to(21, 40));
}

TEST_F(RecordedChannelTest, ARecordingEndsWithItsChannel) {
    const auto before = recorder("before.tlog"), after = recorder("after.tlog");
    channel->record_with(before);
    receive_numbers(*channel, 1, 10);
    channel->close();
    channel->record_with(after);
    EXPECT_TRUE(eventually([&] { return before->finished() && after->finished(); }));
    EXPECT_EQ(numbers_recorded("before.tlog"), from_to(1, 10));
    EXPECT_THAT(numbers_recorded("after.tlog"), IsEmpty());
}

TEST_F(ChannelTest, TheFirstVehicleIsTheTarget) {
    EXPECT_EQ(channel->target(), Source{});
    constexpr std::uint8_t ground_station = 6;
    receive(*channel, frame_of(0, {0, 0, 0, 0, ground_station}, {SystemId{255}, ComponentId{190}}));
    receive(*channel, numbered(1, 9));
    EXPECT_EQ(channel->target(), Source{});
    receive(*channel, frame_of(0, {0, 0, 0, 0, 2, 3}, {SystemId{4}, ComponentId{5}}));
    receive(*channel, frame_of(0, {0, 0, 0, 0, 2, 3}, {SystemId{6}, ComponentId{7}}));
    EXPECT_EQ(channel->target(), (Source{SystemId{4}, ComponentId{5}}));
}

TEST_F(ChannelTest, AMessageThatWasNeverReceivedWholeIsNamed) {
    for (int i = 0; i < 3; ++i) channel->on_bad_checksum(MessageId{attitude_id});
    channel->on_bad_checksum(MessageId{0});
    receive(*channel, frame_of(0));
    const auto errors = channel->crc_errors();
    ASSERT_EQ(errors.size(), 2u);
    EXPECT_EQ(errors.at(MessageId{attitude_id}).count, 3u);
    EXPECT_TRUE(errors.at(MessageId{attitude_id}).always);
    EXPECT_EQ(errors.at(MessageId{0}).count, 1u);
    EXPECT_FALSE(errors.at(MessageId{0}).always);
}

// For the thread sanitizer. Each question has a thread of its own, and the flag is relaxed: whatever orders the threads
// would hide a question that takes no lock. The sanitizer reports a race only while it remembers what both threads did,
// so they ask a few times only.
TEST_F(ChannelTest, WhatItKnowsMayBeAskedWhileItReceives) {
    constexpr int times = 10;
    ChannelReader reader(channel, {});
    const std::vector<std::function<void()>> questions{[&] { EXPECT_LE(channel->target().system.value, 4); },
                                                       [&] { EXPECT_LE(channel->losses().size(), 1u); },
                                                       [&] { EXPECT_LE(channel->crc_errors().size(), 1u); },
                                                       [&] { EXPECT_LE(channel->peers(), 1u); },
                                                       [&] { EXPECT_LE(reader.seen(), 10u); },
                                                       [&] { EXPECT_LE(reader.newest(), 10u); },
                                                       [&] { EXPECT_EQ(reader.missed(), 0u); },
                                                       [&] {
                                                           FrameBatch some;
                                                           EXPECT_TRUE(reader.take(some, 10));
                                                       }};
    std::atomic<bool> done{false};
    std::vector<std::thread> threads;
    for (const auto& ask : questions)
        threads.emplace_back([&] {
            for (int i = 0; i < times; ++i) ask();
            while (!done.load(std::memory_order_relaxed)) std::this_thread::sleep_for(1ms);
            for (int i = 0; i < times; ++i) ask();
        });
    const wire::SequenceStats loss{.source = {SystemId{1}, ComponentId{1}}, .received = 1, .lost = 2};
    for (int i = 0; i < times; ++i) {
        channel->on_link_up(LinkId{1}, "peer");
        channel->on_bad_checksum(MessageId{attitude_id});
        receive(*channel, frame_of(0, {0, 0, 0, 0, 2, 3}, {SystemId{4}, ComponentId{5}}));
        channel->on_link_down(LinkId{1}, {&loss, 1});
    }
    done.store(true, std::memory_order_relaxed);
    for (auto& thread : threads) thread.join();
    EXPECT_EQ(channel->target().system.value, 4);
    EXPECT_EQ(channel->crc_errors().at(MessageId{attitude_id}).count, 10u);
    EXPECT_EQ(channel->losses().begin()->second.lost, 20u);
}

TEST_F(ChannelTest, ForgedIdsAndLinksTakeBoundedMemory) {
    for (std::uint32_t id = 0; id < 5000; ++id) channel->on_bad_checksum(MessageId{id});
    EXPECT_EQ(channel->crc_errors().size(), 1024u);
    channel->on_bad_checksum(MessageId{3});
    EXPECT_EQ(channel->crc_errors().at(MessageId{3}).count, 2u);

    const wire::SequenceStats loss{.source = {SystemId{1}, ComponentId{1}}, .received = 1, .lost = 2};
    for (std::uint32_t link = 1; link <= 5000; ++link) {
        channel->name_link(LinkId{link}, fmt::format("link {}", link));
        channel->forget_link(LinkId{link}, {&loss, 1});
    }
    const auto losses = channel->losses();
    EXPECT_LE(losses.size(), 4097u);
    std::uint64_t lost = 0;
    for (const auto& [key, stats] : losses) lost += stats.lost;
    EXPECT_EQ(lost, 2u * 5000);  // the sum stays right
}

TEST_F(ChannelTest, LossesOfLinksOfOneNameAreAdded) {
    const wire::SequenceStats loss{
        .source = {SystemId{1}, ComponentId{1}}, .received = 10, .lost = 2, .late = 3, .duplicate = 4, .resync = 5};
    for (const std::uint32_t link : {1u, 2u}) {
        channel->on_link_up(LinkId{link}, "peer");
        EXPECT_EQ(channel->peers(), 1u);
        channel->on_link_down(LinkId{link}, {&loss, 1});
        EXPECT_EQ(channel->peers(), 0u);
    }
    const auto losses = channel->losses();
    ASSERT_EQ(losses.size(), 1u);
    const auto& sum = losses.at({"peer", loss.source});
    EXPECT_EQ(sum.received, 20u);
    EXPECT_EQ(sum.lost, 4u);
    EXPECT_EQ(sum.late, 6u);
    EXPECT_EQ(sum.duplicate, 8u);
    EXPECT_EQ(sum.resync, 10u);
    EXPECT_EQ(channel->names().find(LinkId{1}), "peer");
}

TEST_F(ChannelTest, AClosedChannelHasNoPeers) {
    channel->on_link_up(LinkId{1}, "peer");
    channel->close();
    EXPECT_EQ(channel->peers(), 0u);
}

}  // namespace
}  // namespace mavloom::feed
