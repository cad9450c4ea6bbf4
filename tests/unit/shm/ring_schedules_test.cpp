// SPDX-License-Identifier: MIT
// The ring's algorithm in every schedule of a few operations (support/schedule.hpp): what each reader gets must be the
// records that were written, whole and in order, and the reported number of missed records must account for the rest.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "mavloom/shm/detail/consumer.hpp"
#include "mavloom/shm/detail/producer.hpp"
#include "support/schedule.hpp"

namespace mavloom::shm {
namespace {

using test::Bounds;
using test::explore;
using test::Schedule;

struct ModelWords {
    using Word32 = test::ModelWord<std::uint32_t>;
    using Word64 = test::ModelWord<std::uint64_t>;

    // Of the two lengths that there are: short, and for ever.
    static bool sleep(const Word32& word, std::uint32_t expected, Nanoseconds longest) {
        if (word.load(std::memory_order_seq_cst) != expected) return false;
        if (longest <= detail::wake_interval) return test::running_schedule->nap(&word);
        test::running_schedule->sleep(&word);
        return false;
    }
    static void wake(Word32& word) {
        if (test::running_schedule != nullptr) test::running_schedule->wake(&word);
    }
    // Never twice within a millisecond.
    static MonoTime now() {
        static MonoTime time{};
        return time += std::chrono::seconds(1);
    }
};

using Producer = detail::Producer<ModelWords>;
using Consumer = detail::Consumer<ModelWords>;
using Found = Consumer::Found;

constexpr std::uint64_t capacity = 512;
constexpr std::size_t payload = 8;  // a record takes 32 bytes, a lap sixteen records
constexpr int lap = 16;

template <std::uint64_t bytes>
struct RingOf {
    RingControl<ModelWords> control{};
    ReaderSlot<ModelWords> slots[reader_slots]{};
    ModelWords::Word64 data[bytes / 8]{};

    [[nodiscard]] RingMemory<ModelWords> memory() { return {&control, slots, data, bytes}; }
};
using Ring = RingOf<capacity>;

// The payload of the record with this number.
std::uint64_t content_of(std::uint64_t sequence) { return 0x0101010101010101u * (sequence % 251 + 1); }

bool write(Producer& producer) {
    if (producer.claim(payload) != Producer::Room::there) return false;
    const std::uint64_t content = content_of(producer.records());
    producer.store_payload({reinterpret_cast<const std::uint8_t*>(&content), sizeof content});
    producer.commit({.time = {}, .link = LinkId{7}, .kind = 3, .verdict = 1}, payload);
    return true;
}

std::uint64_t content_in(const RingRecord& record) {
    std::uint64_t content = 0;
    if (record.data.size() == sizeof content) std::memcpy(&content, record.data.data(), sizeof content);
    return content;
}

// The records that one reader got. Uses no heap, because it lives on an actor's stack or is captured.
struct Log {
    std::uint64_t expected = 0;  // sequence of the next record
    std::uint64_t delivered = 0;
    std::uint64_t missed = 0;
    bool good = true;

    void take(const RingRecord& record) {
        good = good && record.sequence == expected + record.missed &&
               content_in(record) == content_of(record.sequence) && record.info.link == LinkId{7} &&
               record.info.kind == 3 && record.info.verdict == 1;
        expected = record.sequence + 1;
        ++delivered;
        missed += record.missed;
    }
};

// Reads until there is nothing, at most `most` records. False: damaged.
bool read_some(Consumer& consumer, Log& log, int most) {
    RingRecord record;
    for (int i = 0; i < most; ++i) {
        const Found found = consumer.next(record);
        if (found == Found::damaged) return false;
        if (found == Found::empty) return true;
        log.take(record);
    }
    return true;
}

struct Bench {
    Ring ring;
    Producer producer{ring.memory()};
    Bench() { EXPECT_TRUE(producer.recover()); }
    void fill(int records) {
        for (int i = 0; i < records; ++i) ASSERT_TRUE(write(producer));
    }
};

// The sanitizers look for other faults, and take thirty times as long.
Bounds within(int preemptions, int delays = 0) {
#if defined(MAVLOOM_FIBERS_ASAN) || defined(MAVLOOM_FIBERS_TSAN)
    --preemptions;
#endif
    return {.preemptions = preemptions, .delays = delays};
}

bool failed() { return ::testing::Test::HasFailure(); }

// A lossy reader at the oldest record of a ring that is one record short of a lap, while so many more are written.
// Returns the number of schedules.
std::size_t lap_a_lossy_reader(Bounds bounds, unsigned writes) {
    return explore(
        bounds,
        [writes](Schedule& schedule) {
            Bench bench;
            Consumer reader(bench.ring.memory(), 0, false);
            ASSERT_TRUE(reader.start(Consumer::Start::oldest));
            bench.fill(lap - 1);
            Log log;
            bool intact = true;
            schedule.add([&] {
                for (unsigned i = 0; i < writes; ++i) write(bench.producer);
            });
            schedule.add([&] { intact = read_some(reader, log, 2); });
            ASSERT_TRUE(schedule.run());
            intact = intact && read_some(reader, log, 100);
            ASSERT_TRUE(intact && log.good);
            ASSERT_EQ(log.delivered + log.missed, lap - 1 + writes);
        },
        failed);
}

TEST(RingSchedules, ALossyReaderGetsWholeRecordsAndExactCountsWhileItIsLapped) {
    EXPECT_GT(lap_a_lossy_reader(within(3), 3), 500u);
}

TEST(RingSchedules, StoresThatAreDelayedChangeNothingForALossyReader) { lap_a_lossy_reader(within(2, 1), 2); }

// In the small ring each commit sets marks, whose stores order those of the record and that of the tail. Not here.
TEST(RingSchedules, TheTailIsNeverSeenBeforeTheRecord) {
    explore(
        within(2, 1),
        [](Schedule& schedule) {
            RingOf<8 * capacity> ring;
            Producer producer(ring.memory());
            ASSERT_TRUE(producer.recover());
            Consumer reader(ring.memory(), 0, false);
            ASSERT_TRUE(reader.start(Consumer::Start::oldest));
            Log log;
            bool intact = true;
            schedule.add([&] { write(producer); });
            schedule.add([&] { intact = read_some(reader, log, 1); });
            ASSERT_TRUE(schedule.run());
            ASSERT_TRUE(intact && log.good);
        },
        failed);
}

TEST(RingSchedules, ALosslessReaderThatComesWhileTheWriterRunsMissesNothingFromThenOn) {
    for (const int delays : {0, 1})
        explore(
            within(2, delays),
            [](Schedule& schedule) {
                Bench bench;
                bench.fill(lap + 3);
                Consumer reader(bench.ring.memory(), 0, true);
                Log log;
                bool intact = true;
                schedule.add([&] {
                    for (int i = 0; i < 4; ++i) write(bench.producer);
                });
                schedule.add([&] {
                    intact = reader.start(Consumer::Start::oldest);
                    log.expected = reader.sequence();
                    RingRecord record;
                    if (!intact || reader.next(record) != Found::record) return;
                    const std::uint64_t before = content_in(record);
                    test::running_schedule->step();  // the writer may continue, but not over this record
                    intact = content_in(record) == before;
                    log.take(record);
                });
                ASSERT_TRUE(schedule.run());
                intact = intact && read_some(reader, log, 100);
                ASSERT_TRUE(intact && log.good);
                ASSERT_EQ(log.missed, 0u);
                ASSERT_EQ(log.expected, bench.producer.records());
            },
            failed);
}

// A lossless reader at the oldest record of a ring that is one record short of a lap, from which a writer takes the
// hold for so many records. `read(reader, look)`: false for damage.
template <class Read>
void evict_a_lossless_reader(unsigned writes, Read read) {
    explore(
        within(3),
        [writes, read](Schedule& schedule) {
            Bench bench;
            Consumer reader(bench.ring.memory(), 5, true);
            ASSERT_TRUE(reader.start(Consumer::Start::oldest));
            bench.fill(lap - 1);
            Log log;
            bool intact = true;
            const auto look = [&](const RingRecord& record) {
                // Looked at first, asked about afterwards: what was seen is right if the hold is still there.
                const std::uint64_t seen = content_in(record);
                intact = intact && record.sequence == log.expected + record.missed &&
                         (seen == content_of(record.sequence) || !reader.holds());
                log.expected = record.sequence + 1;
                log.missed += record.missed;
                ++log.delivered;
            };
            schedule.add([&] {
                for (unsigned i = 0; i < writes; ++i)
                    while (!write(bench.producer)) bench.producer.drop_holds(bench.producer.blockers(payload));
            });
            schedule.add([&] { intact = read(reader, look) && intact; });
            ASSERT_TRUE(schedule.run());
            intact = intact && read_some(reader, log, 100);
            ASSERT_TRUE(intact && log.good);
            ASSERT_EQ(log.delivered + log.missed, lap - 1 + writes);
        },
        failed);
}

TEST(RingSchedules, AReaderThatIsEvictedLearnsWhatItMissed) {
    evict_a_lossless_reader(3, [](Consumer& reader, const auto& look) {
        RingRecord record;
        for (int i = 0; i < 2; ++i) {
            const Found found = reader.next(record);
            if (found != Found::record) return found != Found::damaged;
            look(record);
        }
        return true;
    });
}

TEST(RingSchedules, AVisitorThatIsEvictedLearnsWhatItMissed) {
    evict_a_lossless_reader(4, [](Consumer& reader, const auto& look) {
        return reader.visit(4, look) != Found::damaged && reader.visit(4, look) != Found::damaged;
    });
}

TEST(RingSchedules, TheNextWriterCarriesOnWhereverTheLastOneWasKilled) {
    for (int steps = 0; steps < 80; ++steps)
        explore(
            within(2),
            [steps](Schedule& schedule) {
                Bench bench;
                Consumer reader(bench.ring.memory(), 0, false);
                ASSERT_TRUE(reader.start(Consumer::Start::oldest));
                bench.fill(lap - 1);
                Log log;
                bool intact = true;
                schedule.add(
                    [&] {
                        for (int i = 0; i < 2; ++i) write(bench.producer);
                    },
                    steps);
                schedule.add([&] { intact = read_some(reader, log, 3); });
                ASSERT_TRUE(schedule.run());
                Producer next(bench.ring.memory());
                ASSERT_TRUE(next.recover());
                const auto committed = next.records();
                ASSERT_TRUE(committed >= lap - 1 && committed <= lap + 1);
                intact = intact && read_some(reader, log, 100);
                ASSERT_EQ(log.expected, committed) << "all that was committed";
                for (int i = 0; i < lap / 2; ++i) ASSERT_TRUE(write(next));
                intact = intact && read_some(reader, log, 100);
                ASSERT_TRUE(intact && log.good);
                ASSERT_EQ(log.delivered + log.missed, committed + lap / 2);
                Consumer late(bench.ring.memory(), 1, true);
                ASSERT_TRUE(late.start(Consumer::Start::oldest));
                Log all{.expected = late.sequence()};
                ASSERT_TRUE(read_some(late, all, 100) && all.good);
                ASSERT_EQ(all.expected, next.records());
            },
            failed);
}

TEST(RingSchedules, AReaderThatIsKilledAnywhereIsOneHoldToDrop) {
    for (int steps = 0; steps < 40; ++steps)
        explore(
            within(2),
            [steps](Schedule& schedule) {
                Bench bench;
                bench.fill(lap);
                Consumer reader(bench.ring.memory(), 3, true);
                schedule.add([&] {
                    for (int i = 0; i < 2; ++i) write(bench.producer);
                });
                schedule.add(
                    [&] {
                        RingRecord record;
                        if (reader.start(Consumer::Start::oldest)) static_cast<void>(reader.next(record));
                    },
                    steps);
                ASSERT_TRUE(schedule.run());
                bench.producer.drop_holds(std::uint64_t{1} << 3);
                for (int i = 0; i < 2 * lap; ++i) ASSERT_TRUE(write(bench.producer));
            },
            failed);
}

TEST(RingSchedules, NobodySleepsWhileThereIsSomethingToRead) {
    for (const int delays : {0, 1})
        explore(
            within(delays == 0 ? 3 : 2, delays),
            [](Schedule& schedule) {
                Bench bench;
                Consumer reader(bench.ring.memory(), 0, true);
                ASSERT_TRUE(reader.start(Consumer::Start::newest));
                Log log;
                schedule.add([&] {
                    for (int i = 0; i < 2; ++i) write(bench.producer);
                    test::running_schedule->step();  // the last commit's tail may still be in the buffer here
                });
                schedule.add([&] {
                    RingRecord record;
                    while (log.delivered < 2) {
                        if (reader.next(record) == Found::record) {
                            reader.awake();
                            log.take(record);
                        } else {
                            reader.sleep(std::chrono::hours(1));
                        }
                    }
                });
                ASSERT_TRUE(schedule.run()) << "somebody sleeps for ever";
                ASSERT_TRUE(log.good);
            },
            failed);
}

TEST(RingSchedules, AWriterDoesNotSleepWhileThereIsRoom) {
    explore(
        within(2),
        [](Schedule& schedule) {
            Bench bench;
            Consumer reader(bench.ring.memory(), 0, true);
            ASSERT_TRUE(reader.start(Consumer::Start::oldest));
            bench.fill(lap);
            Log log;
            bool intact = true;
            schedule.add([&] {
                for (int i = 0; i < 2; ++i)
                    while (!write(bench.producer)) bench.producer.sleep_for_room(payload, std::chrono::hours(1));
            });
            schedule.add([&] {
                RingRecord record;
                while (log.delivered < lap + 2)
                    if (reader.next(record) == Found::record) log.take(record);
                    else reader.sleep(std::chrono::hours(1));
            });
            ASSERT_TRUE(schedule.run()) << "somebody sleeps for ever";
            ASSERT_TRUE(intact && log.good);
            ASSERT_EQ(log.missed, 0u);
        },
        failed);
}

}  // namespace
}  // namespace mavloom::shm
