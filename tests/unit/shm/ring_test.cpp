// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>
#include <thread>

#include "mavloom/shm/ring_info.hpp"
#include "mavloom/shm/ring_reader.hpp"
#include "mavloom/shm/ring_writer.hpp"
#include "support/ring_name.hpp"
#include "support/temp_dir.hpp"

namespace mavloom::shm {
namespace {

using namespace std::chrono_literals;
using test::RingName;
using ::testing::HasSubstr;

constexpr std::uint64_t small = 64 << 10;

ByteView bytes_of(std::string_view text) { return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}; }
std::string text_of(const RingRecord& record) {
    return {reinterpret_cast<const char*>(record.data.data()), record.data.size()};
}

RingWriter open_writer(const RingName& name, WhenFull when_full = WhenFull::wait, std::uint64_t capacity = small) {
    auto writer = RingWriter::open(name.text(), {.capacity = capacity, .when_full = when_full});
    if (!writer) throw std::runtime_error(writer.error().text);
    return std::move(*writer);
}

RingReader open_reader(const RingName& name, const ReaderOptions& options = {}) {
    auto reader = RingReader::open(name.text(), options);
    if (!reader) throw std::runtime_error(reader.error().text);
    return std::move(*reader);
}

constexpr ReaderOptions lossless{.lossless = true};
constexpr ReaderOptions lossy_oldest{.from = ReaderOptions::From::oldest};
constexpr ReaderOptions lossless_oldest{.lossless = true, .from = ReaderOptions::From::oldest};
constexpr ReaderOptions read_only{.from = ReaderOptions::From::oldest, .read_only = true};

MonoTime soon() { return mono_now() + 60s; }  // ends a hang, judges no speed

void write(RingWriter& writer, std::string_view text, const RecordInfo& info = {}) {
    const auto written = writer.write(bytes_of(text), info, soon());
    ASSERT_TRUE(written) << to_text(written.error());
}

// Fills the ring once and more: `count` records of 1,000 bytes, each with its number.
void write_many(RingWriter& writer, int count, int first = 0) {
    for (int i = first; i < first + count; ++i) {
        std::string text = std::to_string(i);
        text.resize(1000, '.');
        write(writer, text);
    }
}

// Runs `body` in a forked child and gives its exit status.
template <class Body>
int in_child(Body&& body) {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(body());
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

class RingKinds : public ::testing::TestWithParam<ReaderOptions> {};
INSTANTIATE_TEST_SUITE_P(Ring, RingKinds, ::testing::Values(lossy_oldest, lossless_oldest, read_only));

TEST_P(RingKinds, GivesWhatWasWrittenWithItsTags) {
    const RingName name;
    auto writer = open_writer(name);
    auto reader = open_reader(name, GetParam());
    const RecordInfo info{
        .time = WallTime{1'700'000'000'000'000'123ns}, .link = LinkId{0xfedcba98}, .kind = 0xabcd, .verdict = 200};
    write(writer, "hello", info);
    write(writer, "");
    write(writer, "12345678");

    const auto first = reader.read(soon());
    ASSERT_TRUE(first);
    EXPECT_EQ(text_of(*first), "hello");
    EXPECT_EQ(first->info.time, info.time);
    EXPECT_EQ(first->info.link, info.link);
    EXPECT_EQ(first->info.kind, info.kind);
    EXPECT_EQ(first->info.verdict, info.verdict);
    EXPECT_EQ(first->position, 0u);
    EXPECT_EQ(first->sequence, 0u);
    EXPECT_EQ(first->missed, 0u);
    const auto second = reader.read(soon());
    ASSERT_TRUE(second);
    EXPECT_EQ(second->data.size(), 0u);
    EXPECT_EQ(second->position, 32u) << "24 bytes of header, 5 of payload, 3 to the next multiple of 8";
    const auto third = reader.read(soon());
    ASSERT_TRUE(third);
    EXPECT_EQ(text_of(*third), "12345678");
    EXPECT_EQ(third->position, 56u);
    EXPECT_EQ(reader.try_read().error(), ReadError::empty);
    EXPECT_EQ(reader.read(mono_now()).error(), ReadError::empty);
}

TEST_P(RingKinds, GoesRoundManyTimes) {
    const RingName name;
    auto writer = open_writer(name);
    auto reader = open_reader(name, GetParam());
    std::uint64_t expected = 0;
    for (int i = 0; i < 20'000; ++i) {
        std::string text = std::to_string(i);
        text.resize(static_cast<std::size_t>(i * 7919 % 700), 'x');
        write(writer, text);
        if (i % 20 != 0) continue;
        for (auto record = reader.try_read(); record; record = reader.try_read()) {
            ASSERT_EQ(record->sequence, expected++);
            ASSERT_EQ(record->data.size(), record->sequence * 7919 % 700);
            ASSERT_EQ(record->missed, 0u);
        }
    }
    EXPECT_GT(expected, 19'000u);
}

TEST(Ring, AReaderOfTheNewestSeesOnlyWhatComes) {
    const RingName name;
    auto writer = open_writer(name);
    write_many(writer, 100);
    auto reader = open_reader(name);
    write(writer, "new");
    const auto record = reader.read(soon());
    ASSERT_TRUE(record);
    EXPECT_EQ(text_of(*record), "new");
    EXPECT_EQ(record->sequence, 100u);
}

TEST(Ring, TheOldestIsOlderThanTheNewestByNearlyTheCapacity) {
    const RingName name;
    auto writer = open_writer(name);
    write_many(writer, 500);  // of 1,024 bytes each: eight laps
    auto reader = open_reader(name, lossy_oldest);
    const auto record = reader.read(soon());
    ASSERT_TRUE(record);
    EXPECT_LE(record->sequence, 500u - 60u);
    EXPECT_GE(record->sequence, 500u - 64u);
}

TEST(Ring, ALappedReaderLearnsHowManyRecordsItMissed) {
    const RingName name;
    auto writer = open_writer(name, WhenFull::evict);
    auto reader = open_reader(name, lossy_oldest);
    write_many(writer, 3);
    ASSERT_TRUE(reader.read(soon()));
    write_many(writer, 1000, 3);
    const auto record = reader.read(soon());
    ASSERT_TRUE(record);
    EXPECT_GT(record->missed, 900u);
    EXPECT_EQ(record->sequence, 1 + record->missed);
    EXPECT_EQ(std::stoul(text_of(*record)), record->sequence);
    EXPECT_EQ(reader.missed(), record->missed);
    std::uint64_t last = record->sequence;
    for (auto next = reader.try_read(); next; next = reader.try_read()) {
        EXPECT_EQ(next->missed, 0u);
        last = next->sequence;
    }
    EXPECT_EQ(last, 1002u);
}

TEST(Ring, AViewOfALosslessReaderStays) {
    const RingName name;
    auto writer = open_writer(name, WhenFull::drop_newest);
    auto reader = open_reader(name, lossless);
    write(writer, "stays");
    const auto record = reader.read(soon());
    ASSERT_TRUE(record);
    std::string text(1000, 'x');
    int taken = 0;
    while (writer.write(bytes_of(text), {})) ++taken;
    EXPECT_EQ(taken, 63) << "of 1,024 bytes each: 64 KiB less the 32 bytes that are held";
    EXPECT_TRUE(writer.write(bytes_of(text.substr(0, 968)), {})) << "up to the end of the lap";
    EXPECT_EQ(writer.write(bytes_of("8 bytes."), {}).error(), WriteError::full);
    EXPECT_EQ(writer.dropped(), 2u);
    EXPECT_EQ(text_of(*record), "stays");
    EXPECT_TRUE(reader.holds());
    reader.release();
    EXPECT_TRUE(writer.write(bytes_of("8 bytes."), {})) << "where the record was that took 32 bytes";
    EXPECT_EQ(writer.write(bytes_of("8 bytes."), {}).error(), WriteError::full);
}

TEST(Ring, ABatchStaysInViewUntilTheNextCall) {
    const RingName name;
    auto writer = open_writer(name, WhenFull::drop_newest);
    auto reader = open_reader(name, lossless);
    std::vector<RingRecord> batch(5);
    EXPECT_EQ(reader.try_read_batch(batch).error(), ReadError::empty);
    write_many(writer, 63);
    ASSERT_EQ(reader.try_read_batch(batch), 5u);
    EXPECT_FALSE(writer.write(bytes_of(std::string(1100, 'x')), {}));
    for (std::size_t i = 0; i < batch.size(); ++i) {
        EXPECT_EQ(std::stoul(text_of(batch[i])), i);
        EXPECT_EQ(batch[i].sequence, i);
    }
    std::vector<RingRecord> large(100);
    ASSERT_EQ(reader.try_read_batch(large), 8u) << "of 1,024 bytes each: an eighth of the ring";
    EXPECT_EQ(std::stoul(text_of(large[0])), 5u);
    EXPECT_TRUE(writer.write(bytes_of(std::string(1100, 'x')), {})) << "the first five are released";
    EXPECT_EQ(std::stoul(text_of(large[7])), 12u);
    EXPECT_EQ(std::stoul(text_of(*reader.try_read())), 13u);
    std::size_t rest = 0;
    for (auto more = reader.try_read_batch(large); more; more = reader.try_read_batch(large)) rest += *more;
    EXPECT_EQ(rest, 50u) << "of 64";
    EXPECT_EQ(open_reader(name).try_read_batch(large).error(), ReadError::empty);
}

TEST(Ring, ABatchThatIsEvictedIsNotHeldAnyLonger) {
    const RingName name;
    auto writer = open_writer(name, WhenFull::evict);
    auto reader = open_reader(name, lossless);
    write_many(writer, 5);
    std::vector<RingRecord> batch(100);
    ASSERT_EQ(reader.try_read_batch(batch), 5u);
    EXPECT_TRUE(reader.holds());
    write_many(writer, 200, 5);
    EXPECT_FALSE(reader.holds());
    ASSERT_TRUE(reader.try_read_batch(batch));
    EXPECT_EQ(batch[0].sequence, 5 + batch[0].missed);
    EXPECT_EQ(std::stoul(text_of(batch[0])), batch[0].sequence);
}

TEST(Ring, AVisitorGetsWhatABatchHolds) {
    const RingName name;
    auto writer = open_writer(name, WhenFull::evict);
    auto reader = open_reader(name, lossless);
    std::vector<std::string> seen;
    const auto look = [&](const RingRecord& record) { seen.push_back(text_of(record)); };
    EXPECT_EQ(reader.try_visit(100, look).error(), ReadError::empty);
    for (std::size_t length = 0; length <= 40; ++length)
        ASSERT_TRUE(writer.write(bytes_of(std::string(length, static_cast<char>('A' + length))), {}));
    EXPECT_EQ(reader.try_visit(0, look).error(), ReadError::empty);
    ASSERT_EQ(reader.try_visit(3, look), 3u);
    ASSERT_EQ(reader.try_visit(100, look), 38u);
    ASSERT_EQ(seen.size(), 41u);
    for (std::size_t length = 0; length <= 40; ++length)
        EXPECT_EQ(seen[length], std::string(length, static_cast<char>('A' + length)));
    EXPECT_EQ(open_reader(name).try_visit(100, look).error(), ReadError::empty)
        << "a lossy reader has one record at a time";
}

TEST(Ring, AVisitorGetsNothingBehindAHoldThatWasRemoved) {
    const RingName name;
    auto writer = open_writer(name, WhenFull::evict);
    auto reader = open_reader(name, lossless);
    write_many(writer, 5);
    std::size_t seen = 0;
    ASSERT_EQ(reader.try_visit(100,
                               [&](const RingRecord& record) {
                                   EXPECT_EQ(std::stoul(text_of(record)), seen);
                                   if (++seen == 2)
                                       for (int i = 5; reader.holds(); ++i) write_many(writer, 1, i);
                               }),
              2u);
    EXPECT_FALSE(reader.holds());
    const auto record = reader.try_read();
    ASSERT_TRUE(record);
    EXPECT_EQ(record->sequence, 2 + record->missed);
}

TEST(Ring, AWaitingWriterContinuesWhenTheReaderReleases) {
    const RingName name;
    auto writer = open_writer(name, WhenFull::wait);
    std::jthread other;
    auto reader = open_reader(
        name, lossless);  // ends before the thread is joined: a test that fails does not hold the writer
    other = std::jthread([&] { write_many(writer, 1000); });
    for (int i = 0; i < 1000; ++i) {
        const auto record = reader.read(soon());
        ASSERT_TRUE(record) << to_text(record.error());
        ASSERT_EQ(std::stoi(text_of(*record)), i);
    }
    EXPECT_EQ(reader.missed(), 0u);
}

TEST(Ring, AReaderThatDetachesHoldsNobodyAndKeepsTheRingMapped) {
    const RingName name;
    auto writer = open_writer(name);
    auto reader = open_reader(name, lossless);
    write(writer, "in view");
    const auto record = reader.try_read();
    ASSERT_TRUE(record);
    reader.detach();
    reader.detach();
    EXPECT_TRUE(ring_status(name.text())->readers.empty());
    EXPECT_EQ(text_of(*record), "in view");
    write_many(writer, 100);              // passes it: nobody waits
    EXPECT_EQ(record->data.back(), '.');  // newer bytes, and no crash
}

TEST(Ring, AWaitThatEndsWroteNothingAndTheCallerCountsTheRecord) {
    const RingName name;
    auto writer = open_writer(name, WhenFull::wait);
    auto reader = open_reader(name, lossless);
    const std::string text(10'000, 'x');
    while (writer.write(bytes_of(text), {}, mono_now() + 5ms)) continue;
    const auto records = writer.records();
    EXPECT_EQ(writer.write(bytes_of(text), {}, mono_now()).error(), WriteError::full);
    EXPECT_EQ(writer.records(), records);
    EXPECT_EQ(writer.dropped(), 0u);
    writer.count_dropped();
    EXPECT_EQ(ring_status(name.text())->dropped, 1u);
}

TEST(Ring, EvictingTakesTheHoldAndTheReaderLearnsWhatItMissed) {
    const RingName name;
    auto writer = open_writer(name, WhenFull::evict);
    auto reader = open_reader(name, lossless);
    write(writer, "first");
    ASSERT_TRUE(reader.read(soon()));
    write_many(writer, 500);
    EXPECT_FALSE(reader.holds());
    const auto record = reader.read(soon());
    ASSERT_TRUE(record);
    EXPECT_TRUE(reader.holds());
    EXPECT_EQ(record->sequence, 1 + record->missed);
    EXPECT_EQ(std::stoul(text_of(*record)), record->sequence - 1);
    EXPECT_EQ(ring_status(name.text())->evictions, 1u);
}

TEST(Ring, ClaimedBytesAreNotSeenUntilTheyAreCommitted) {
    const RingName name;
    auto writer = open_writer(name);
    auto reader = open_reader(name);
    auto claim = writer.claim(100);
    ASSERT_TRUE(claim);
    ASSERT_EQ(claim->size(), 100u);
    std::fill(claim->begin(), claim->end(), std::uint8_t{'c'});
    EXPECT_EQ(reader.try_read().error(), ReadError::empty);
    writer.commit({.link = LinkId{9}}, 40);
    const auto record = reader.try_read();
    ASSERT_TRUE(record);
    EXPECT_EQ(text_of(*record), std::string(40, 'c'));
    EXPECT_EQ(record->info.link, LinkId{9});
}

TEST(Ring, AClaimThatIsNotCommittedLeavesNothing) {
    const RingName name;
    auto writer = open_writer(name);
    auto reader = open_reader(name);
    ASSERT_TRUE(writer.claim(1000));
    ASSERT_TRUE(writer.claim(10));
    write(writer, "kept");
    const auto record = reader.try_read();
    ASSERT_TRUE(record);
    EXPECT_EQ(text_of(*record), "kept");
    EXPECT_EQ(record->sequence, 0u);
}

TEST(Ring, TakesRecordsUpToItsLongestAndRefusesLongerOnes) {
    const RingName name;
    auto writer = open_writer(name);
    EXPECT_EQ(writer.longest(), 16'360u) << "a quarter of 64 KiB less the header";
    auto reader = open_reader(name, lossless);
    const std::string longest(16'360, 'l');
    for (int i = 0; i < 10; ++i) {
        write(writer, longest);
        const auto record = reader.try_read();
        ASSERT_TRUE(record);
        ASSERT_EQ(text_of(*record), longest);
        reader.release();
    }
    EXPECT_EQ(writer.write(bytes_of(longest + "x"), {}).error(), WriteError::too_long);
    const RingName large;
    EXPECT_EQ(open_writer(large, WhenFull::wait, 1 << 20).longest(), 65'536u);
}

TEST(Ring, ASecondWriterIsRefusedWithTheFirstOnesPid) {
    const RingName name;
    const auto writer = open_writer(name);
    const auto second = RingWriter::open(name.text(), {.capacity = small});
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, SetupCode::in_use);
    EXPECT_THAT(second.error().text, HasSubstr("process " + std::to_string(::getpid())));
}

TEST(Ring, TheNextWriterCarriesOnInPlace) {
    const RingName name;
    {
        auto writer = open_writer(name);
        write_many(writer, 100);
    }
    auto reader = open_reader(name);
    EXPECT_FALSE(reader.writer_alive());
    EXPECT_EQ(reader.read(soon()).error(), ReadError::no_writer);
    auto writer = open_writer(name);
    EXPECT_TRUE(reader.writer_alive());
    write(writer, "again");
    const auto record = reader.read(soon());
    ASSERT_TRUE(record);
    EXPECT_EQ(record->sequence, 100u);
    EXPECT_EQ(ring_status(name.text())->writers, 2u);
}

TEST(Ring, TheLastLinkIsThatOfAllRecordsThatTheRingHolds) {
    const RingName name;
    auto writer = open_writer(name);
    EXPECT_EQ(writer.last_link(), LinkId{0});
    const std::string text(1000, 'x');
    write(writer, text, {.link = LinkId{4000}});
    write(writer, text, {.link = LinkId{0xffffffff}});
    write(writer, text, {.link = LinkId{7}});
    EXPECT_EQ(open_reader(name, lossy_oldest).try_read()->info.link, LinkId{4000});
    EXPECT_EQ(writer.last_link(), LinkId{4000}) << "0xffffffff leaves no number behind it";
    write_many(writer, 100);
    write(writer, text, {.link = LinkId{9}});
    EXPECT_EQ(writer.last_link(), LinkId{9});
    ASSERT_TRUE(writer.close());
    EXPECT_EQ(open_writer(name).last_link(), LinkId{9});
}

TEST(Ring, AWriterKnowsWhetherItMadeTheRing) {
    const RingName name;
    EXPECT_TRUE(open_writer(name).created());
    auto second = open_writer(name);
    EXPECT_FALSE(second.created());
    ASSERT_TRUE(remove_ring(name.text()));
    ASSERT_TRUE(second.reopen());
    EXPECT_TRUE(second.created());
}

TEST(Ring, AWriterOfAnotherCapacityMakesAnotherFile) {
    const RingName name;
    {
        auto writer = open_writer(name);
        write(writer, "old");
    }
    auto reader = open_reader(name, lossless_oldest);
    auto writer = open_writer(name, WhenFull::wait, 2 * small);
    write(writer, "new");
    const auto old = reader.read(soon());
    ASSERT_TRUE(old);
    EXPECT_EQ(text_of(*old), "old") << "what it holds is drained first";
    EXPECT_EQ(reader.read(soon()).error(), ReadError::retired);
    EXPECT_FALSE(reader.is_named());
    auto again = open_reader(name, lossless_oldest);
    EXPECT_EQ(text_of(*again.read(soon())), "new");
}

TEST(Ring, RemovalInUseIsReportedToBothSides) {
    const RingName name;
    auto writer = open_writer(name);
    auto reader = open_reader(name, lossless);
    write(writer, "last");
    ASSERT_TRUE(remove_ring(name.text()));
    EXPECT_EQ(text_of(*reader.read(soon())), "last");
    EXPECT_EQ(reader.read(soon()).error(), ReadError::retired);
    EXPECT_EQ(writer.write(bytes_of("lost"), {}).error(), WriteError::removed);
    EXPECT_TRUE(writer.is_removed());
    ASSERT_TRUE(writer.reopen());
    write(writer, "anew");
    EXPECT_EQ(text_of(*open_reader(name, lossless_oldest).read(soon())), "anew");
    const auto gone = remove_ring("no-" + name.text());
    ASSERT_FALSE(gone);
    EXPECT_EQ(gone.error().code, SetupCode::not_found);
}

TEST(Ring, ANameThatIsRemovedByHandIsNoticedByBothSides) {
    const RingName name;
    auto writer = open_writer(name);
    auto reader = open_reader(name);
    ::unlink(name.path().c_str());
    EXPECT_TRUE(writer.is_removed());
    EXPECT_FALSE(reader.is_named());
    write(writer, "still");
    EXPECT_EQ(text_of(*reader.read(soon())), "still");
}

TEST(Ring, ClosingWithLeaveNothingRemovesIt) {
    const RingName name;
    auto writer = open_writer(name);
    auto reader = open_reader(name);
    ASSERT_TRUE(writer.close(RingWriter::Leave::nothing));
    EXPECT_NE(::access(name.path().c_str(), F_OK), 0);
    EXPECT_EQ(reader.read(soon()).error(), ReadError::retired);
    EXPECT_EQ(writer.write(bytes_of("x"), {}).error(), WriteError::removed);
}

TEST(Ring, AClosingWriterWakesReadersAtOnce) {
    const RingName name;
    auto writer = open_writer(name);
    auto reader = open_reader(name);
    std::thread other([&] {
        while (!ring_status(name.text())->readers.at(0).asleep) std::this_thread::yield();
        static_cast<void>(writer.close());
    });
    EXPECT_EQ(reader.read(soon()).error(), ReadError::no_writer);
    other.join();
}

TEST(Ring, SixtyFourReadersRegisterAndTheSlotOfOneThatWentIsTakenAgain) {
    const RingName name;
    auto writer = open_writer(name);
    std::vector<RingReader> readers;
    for (int i = 0; i < 64; ++i) readers.push_back(open_reader(name, lossless));
    const auto refused = RingReader::open(name.text(), lossless);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, SetupCode::in_use);
    EXPECT_FALSE(open_reader(name).is_registered()) << "a lossy one reads without a slot";
    EXPECT_EQ(ring_status(name.text())->readers.size(), 64u);
    readers.erase(readers.begin() + 30);
    readers.push_back(open_reader(name, lossless));
    write(writer, "for all");
    for (auto& reader : readers) EXPECT_EQ(text_of(*reader.read(soon())), "for all");
}

// A wake word or a view may keep the ring of such a reader mapped for long.
TEST(Ring, TheSlotOfAReaderThatDetachesIsTakenAgain) {
    const RingName name;
    const auto writer = open_writer(name);
    std::vector<RingReader> readers;
    for (std::size_t i = 0; i < reader_slots; ++i) readers.push_back(open_reader(name, lossless));
    readers[30].detach();
    EXPECT_TRUE(RingReader::open(name.text(), lossless));
}

TEST(Ring, AReadOnlyReaderTakesNoSlotAndHoldsNobody) {
    const RingName name;
    auto writer = open_writer(name, WhenFull::drop_newest);
    const auto reader = open_reader(name, read_only);
    EXPECT_FALSE(reader.is_registered());
    EXPECT_TRUE(reader.writer_alive());
    EXPECT_TRUE(ring_status(name.text())->readers.empty());
    write_many(writer, 1000);
    EXPECT_EQ(writer.dropped(), 0u);
    EXPECT_EQ(RingReader::open(name.text(), {.lossless = true, .read_only = true}).error().code, SetupCode::usage);
}

TEST(Ring, StatusShowsWhoIsAttachedAndHowFarBehind) {
    const RingName name;
    auto writer = open_writer(name, WhenFull::evict);
    const auto reader = open_reader(name, lossless);
    write_many(writer, 10);
    const auto status = ring_status(name.text());
    ASSERT_TRUE(status);
    EXPECT_EQ(status->name, name.text());
    EXPECT_EQ(status->path, name.path());
    EXPECT_EQ(status->mode, 0600u);
    EXPECT_EQ(status->capacity, small);
    EXPECT_TRUE(status->writer_alive);
    EXPECT_EQ(status->writer_pid, static_cast<std::uint32_t>(::getpid()));
    EXPECT_EQ(status->when_full, WhenFull::evict);
    EXPECT_EQ(status->records, 10u);
    EXPECT_EQ(status->bytes, 10'240u);
    ASSERT_EQ(status->readers.size(), 1u);
    EXPECT_EQ(status->readers[0].pid, static_cast<std::uint32_t>(::getpid()));
    EXPECT_EQ(status->readers[0].program, "shm_test");
    EXPECT_TRUE(status->readers[0].lossless);
    EXPECT_TRUE(status->readers[0].holds);
    EXPECT_EQ(status->readers[0].behind_bytes, 10'240u);
    EXPECT_EQ(status->readers[0].behind_records, 10u);
    EXPECT_THAT(ring_names(), ::testing::Contains(name.text()));
}

// Once a reader is listed, it gets every record that is written from then on.
TEST(Ring, AReaderIsListedOnceItHasItsPlace) {
    const RingName name;
    const auto writer = open_writer(name);
    const int opening = ::open(name.path().c_str(), O_RDWR | O_CLOEXEC);
    struct flock first_slot {};
    first_slot.l_type = F_WRLCK;
    first_slot.l_start = 1;
    first_slot.l_len = 1;
    ASSERT_EQ(::fcntl(opening, F_OFD_SETLK, &first_slot), 0);
    EXPECT_TRUE(ring_status(name.text())->readers.empty());
    const auto reader = open_reader(name);
    ASSERT_EQ(ring_status(name.text())->readers.size(), 1u);
    EXPECT_EQ(ring_status(name.text())->readers[0].slot, 1u);
    ::close(opening);
}

TEST(Ring, TheModeCountsAndTheUmaskDoesNot) {
    const RingName name;
    const mode_t before = ::umask(077);
    const auto writer = RingWriter::open(name.text(), {.capacity = small, .mode = 0640});
    ::umask(before);
    ASSERT_TRUE(writer);
    struct stat status {};
    ASSERT_EQ(::stat(name.path().c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777u, 0640u);
}

TEST(Ring, AWriterRefusesAFileOfAnotherUser) {
    if (::geteuid() != 0) GTEST_SKIP() << "giving files away needs root";
    const RingName name;
    open_writer(name);
    ASSERT_EQ(::chown(name.path().c_str(), 65534, 65534), 0);
    const auto writer = RingWriter::open(name.text(), {.capacity = small});
    ASSERT_FALSE(writer);
    EXPECT_EQ(writer.error().code, SetupCode::permission);
    EXPECT_THAT(writer.error().text, HasSubstr("; remove it or choose another name"));
}

// Its owner could shorten it between any two of these steps, which would end a program without a handler for SIGBUS.
TEST(Ring, AFileOfAnotherUserIsRefusedBeforeAnythingInItIsRead) {
    if (::geteuid() != 0) GTEST_SKIP() << "giving files away needs root";
    const RingName name;
    test::write_file(name.path(), bytes_of("no ring"));
    ASSERT_EQ(::chown(name.path().c_str(), 65534, 65534), 0);
    EXPECT_EQ(RingReader::open(name.text()).error().code, SetupCode::permission);
    EXPECT_EQ(RingReader::open(name.text(), read_only).error().code, SetupCode::permission);
    EXPECT_EQ(RingWriter::open(name.text(), {.capacity = small}).error().code, SetupCode::permission);
    EXPECT_EQ(ring_status(name.text()).error().code, SetupCode::permission);
    EXPECT_EQ(RingReader::open(name.text(), {.trust = {.foreign = true}}).error().code, SetupCode::bad_input);
}

TEST(Ring, AReaderRefusesRingsThatItMustNotTrust) {
    if (::geteuid() != 0) GTEST_SKIP() << "giving files away needs root";
    const RingName name;
    open_writer(name);
    ASSERT_EQ(::chown(name.path().c_str(), 65534, 65534), 0);
    const auto of_another = RingReader::open(name.text());
    ASSERT_FALSE(of_another);
    EXPECT_EQ(of_another.error().code, SetupCode::permission);
    EXPECT_THAT(of_another.error().text, HasSubstr("foreign=true reads it"));
    EXPECT_TRUE(RingReader::open(name.text(), {.trust = {.foreign = true}}));
    EXPECT_TRUE(RingReader::open(name.text(), {.trust = {.user = 65534}}));
    EXPECT_FALSE(RingReader::open(name.text(), {.trust = {.user = 65533}}));

    ASSERT_EQ(::chmod(name.path().c_str(), 0660), 0);
    const auto shared = RingReader::open(name.text(), {.trust = {.user = 65534}});
    ASSERT_FALSE(shared);
    EXPECT_THAT(shared.error().text, HasSubstr("users other than its owner may write"));
    EXPECT_TRUE(RingReader::open(name.text(), {.trust = {.foreign = true}}));
}

TEST(Ring, ClosingSparesTheCounterPageOfAnotherUser) {
    if (::geteuid() != 0) GTEST_SKIP() << "giving files away needs root";
    const RingName name;
    auto writer = open_writer(name);
    const std::string page = name.path() + ".stat";
    test::write_file(page, bytes_of("page"));
    ASSERT_EQ(::chown(page.c_str(), 65534, 65534), 0);
    ASSERT_TRUE(writer.close(RingWriter::Leave::nothing));
    EXPECT_EQ(::unlink(page.c_str()), 0);
}

TEST(Ring, ClosingSparesTheCounterPageOfTheNextOwnerOfTheName) {
    const RingName name;
    auto writer = open_writer(name);
    ::unlink(name.path().c_str());
    const auto next = open_writer(name);
    const std::string page = name.path() + ".stat";
    test::write_file(page, bytes_of("page"));
    ASSERT_TRUE(writer.close(RingWriter::Leave::nothing));
    EXPECT_EQ(::unlink(page.c_str()), 0);
    EXPECT_FALSE(next.is_removed());
}

TEST(Ring, WrongNamesAndSizesAreUsageErrors) {
    for (const std::string name : {"", "a/b", "../x", "a b", "a.stat", "\x1b[31m"}) {
        const auto writer = RingWriter::open(name);
        ASSERT_FALSE(writer) << name;
        EXPECT_EQ(writer.error().code, SetupCode::usage);
        EXPECT_EQ(RingReader::open(name).error().code, SetupCode::usage);
        EXPECT_EQ(remove_ring(name).error().code, SetupCode::usage);
    }
    EXPECT_EQ(RingWriter::open(std::string(65, 'a')).error().code, SetupCode::usage);
    const RingName name;
    for (const std::uint64_t capacity :
         {std::uint64_t{0}, std::uint64_t{1000}, small / 2, small + 1, std::uint64_t{1} << 37})
        EXPECT_EQ(RingWriter::open(name.text(), {.capacity = capacity}).error().code, SetupCode::usage) << capacity;
    EXPECT_EQ(RingWriter::open(name.text(), {.mode = 0400}).error().code, SetupCode::usage);
    EXPECT_NE(::access(name.path().c_str(), F_OK), 0);
}

TEST(Ring, AnAbsentOneListsThoseThatThereAre) {
    const RingName name, other;
    const auto writer = open_writer(other);
    const auto reader = RingReader::open(name.text());
    ASSERT_FALSE(reader);
    EXPECT_EQ(reader.error().code, SetupCode::not_found);
    EXPECT_THAT(reader.error().text, HasSubstr("there is no ring " + name.text()));
    EXPECT_THAT(reader.error().text, HasSubstr(other.text()));
}

// ---- files that are no rings, or no longer

class RingDamage : public ::testing::Test {
protected:
    RingDamage() {
        auto writer = open_writer(name_);
        write_many(writer, 10);
    }
    void put(off_t offset, const std::vector<std::uint8_t>& bytes) const {
        const int fd = ::open(name_.path().c_str(), O_RDWR);
        ASSERT_EQ(::pwrite(fd, bytes.data(), bytes.size(), offset), static_cast<ssize_t>(bytes.size()));
        ::close(fd);
    }
    void expect_refused(std::string_view text) const {
        for (const auto& reader :
             {RingReader::open(name_.text(), lossy_oldest), RingReader::open(name_.text(), read_only)}) {
            ASSERT_FALSE(reader);
            EXPECT_EQ(reader.error().code, SetupCode::bad_input);
            EXPECT_THAT(reader.error().text, HasSubstr(text));
        }
        const auto before = test::content_of(name_.path());
        const auto writer = RingWriter::open(name_.text(), {.capacity = small});
        ASSERT_FALSE(writer);
        EXPECT_EQ(writer.error().code, SetupCode::bad_input);
        EXPECT_THAT(writer.error().text, HasSubstr(text));
        EXPECT_EQ(test::content_of(name_.path()), before) << "left as it is";
    }
    RingName name_;
};

TEST_F(RingDamage, AnotherMagicIsNoRing) {
    put(0, {'X'});
    expect_refused("is not a Mavloom ring");
}
TEST_F(RingDamage, AnotherVersionNamesBoth) {
    put(8, {2, 0, 7, 0});
    expect_refused("is a ring of version 2.7; this program supports 1.0");
}
TEST_F(RingDamage, AHigherMinorVersionIsRead) {
    put(10, {9, 0});
    EXPECT_EQ(std::stoi(text_of(*open_reader(name_, lossy_oldest).try_read())), 0);
}
TEST_F(RingDamage, AHigherMinorVersionIsWrittenToAndKeptAsItIs) {
    put(10, {9, 0});
    put(44, {1, 2, 3});  // what is reserved for this program
    auto writer = open_writer(name_);
    EXPECT_FALSE(writer.created());
    write(writer, "from an older one");
    auto reader = open_reader(name_, lossless_oldest);
    for (int i = 0; i < 10; ++i) ASSERT_EQ(std::stoi(text_of(*reader.try_read())), i);
    EXPECT_EQ(text_of(*reader.try_read()), "from an older one");
    EXPECT_EQ(test::content_of(name_.path()).at(10), 9u);
    EXPECT_EQ(test::content_of(name_.path()).at(44), 1u);
}
TEST_F(RingDamage, AnotherByteOrderIsNamed) {
    put(12, {1, 2, 3, 4});
    expect_refused("another byte order");
}
TEST_F(RingDamage, OtherSizesAreDamage) {
    put(16, {0, 0, 2});
    expect_refused("truncated");
    put(16, {0, 0, 3});
    expect_refused("damaged");
    put(16, {0, 0, 1});
    put(24, {1});
    expect_refused("damaged");
}
TEST_F(RingDamage, ATruncatedFileIsNamed) {
    ASSERT_EQ(::truncate(name_.path().c_str(), 70'000), 0);
    expect_refused("truncated");
    ASSERT_EQ(::truncate(name_.path().c_str(), 100), 0);
    expect_refused("truncated");
    ASSERT_EQ(::truncate(name_.path().c_str(), 0), 0);
    expect_refused("truncated");
}
TEST_F(RingDamage, AFolderIsNoRing) {
    const RingName folder;
    ASSERT_EQ(::mkdir(folder.path().c_str(), 0700), 0);
    EXPECT_FALSE(RingReader::open(folder.text()));
    EXPECT_FALSE(RingReader::open(folder.text(), read_only));
    EXPECT_FALSE(RingWriter::open(folder.text()));
    ::rmdir(folder.path().c_str());
}
TEST_F(RingDamage, ALengthThatCannotBeEndsReadingWithDamaged) {
    for (const std::vector<std::uint8_t>& length : {std::vector<std::uint8_t>{0xff, 0xff, 0xff, 0x7f},
                                                    {0xff, 0xff, 0xff, 0xff},
                                                    {0, 0, 0, 0x80},
                                                    {0xe9, 0x3f, 0, 0}}) {
        put(16384 + 1024, length);  // of the second record
        for (const auto& options : {lossy_oldest, lossless_oldest, read_only}) {
            auto reader = open_reader(name_, options);
            EXPECT_TRUE(reader.try_read());
            EXPECT_EQ(reader.try_read().error(), ReadError::damaged);
            EXPECT_EQ(reader.try_read().error(), ReadError::damaged);
        }
    }
}
TEST_F(RingDamage, WhatCannotBeCountedThroughIsRefusedAtOnce) {
    {
        auto writer = open_writer(name_);
        write(writer, "short");
    }
    put(16384 + 10 * 1024, {0xff, 0xff, 0xff, 0x7f});  // behind the newest mark
    for (const auto& options : {ReaderOptions{}, lossless}) {
        const auto reader = RingReader::open(name_.text(), options);
        ASSERT_FALSE(reader);
        EXPECT_EQ(reader.error().code, SetupCode::bad_input);
    }
}
TEST_F(RingDamage, ARecordOutOfSequenceIsDamage) {
    put(16384 + 1024 + 12, {9});
    auto reader = open_reader(name_, lossy_oldest);
    EXPECT_TRUE(reader.try_read());
    EXPECT_EQ(reader.try_read().error(), ReadError::damaged);
}
TEST_F(RingDamage, TheStatusOfADamagedRingReportsIt) {
    EXPECT_FALSE(ring_status(name_.text())->damaged);
    put(128, {0, 0x28, 0, 0, 0, 0, 0, 0x80});  // a tail far beyond the intent
    EXPECT_TRUE(ring_status(name_.text())->damaged);
}
TEST_F(RingDamage, PositionsThatCannotBeAreDamage) {
    put(128, {1});  // a tail that is no multiple of 8
    EXPECT_FALSE(RingWriter::open(name_.text(), {.capacity = small}));
    put(128, {0, 0x28, 0, 0, 0, 0, 0, 0x80});  // far beyond the intent
    expect_refused("damaged");
}

// ---- processes

TEST(RingProcess, AForkedChildHoldsNothingAndGetsAnError) {
    const RingName name;
    auto writer = open_writer(name);
    auto reader = open_reader(name, lossless);
    write(writer, "parent's");
    EXPECT_EQ(in_child([&] {
                  const bool told = reader.try_read().error() == ReadError::forked &&
                                    writer.write(bytes_of("x"), {}).error() == WriteError::forked &&
                                    writer.claim(1).error() == WriteError::forked;
                  { auto dropped = std::move(reader); }
                  return told ? 7 : 1;
              }),
              7);
    EXPECT_EQ(ring_status(name.text())->readers.size(), 1u);
    EXPECT_TRUE(ring_status(name.text())->readers[0].holds);
    EXPECT_EQ(text_of(*reader.read(soon())), "parent's");
    write(writer, "and more");
    EXPECT_EQ(text_of(*reader.read(soon())), "and more");
}

// A grandchild outlives the child that opened the ring: its lock must not.
TEST(RingProcess, ALockEndsWithItsOwnerEvenIfAChildLives) {
    const RingName name;
    int pipe_ends[2], runs[2];
    ASSERT_EQ(::pipe(pipe_ends), 0);
    ASSERT_EQ(::pipe(runs), 0);
    EXPECT_EQ(in_child([&] {
                  auto writer = open_writer(name);
                  write(writer, "before");
                  if (::fork() == 0) {
                      char byte = 'r';
                      ::close(pipe_ends[1]);
                      bool done = ::write(runs[1], &byte, 1) == 1;
                      done = ::read(pipe_ends[0], &byte, 1) >= 0 && done;  // until the test ends
                      ::_exit(done ? 0 : 1);
                  }
                  char byte;
                  if (::read(runs[0], &byte, 1) != 1) return 1;  // until fork() is over on the other side too
                  ::kill(::getpid(), SIGKILL);
                  return 0;
              }),
              128 + SIGKILL);
    auto writer = open_writer(name);
    write(writer, "after");
    auto reader = open_reader(name, lossless_oldest);
    EXPECT_EQ(text_of(*reader.read(soon())), "before");
    EXPECT_EQ(text_of(*reader.read(soon())), "after");
    for (const int fd : {pipe_ends[0], pipe_ends[1], runs[0], runs[1]}) ::close(fd);
}

TEST(RingProcess, TheHoldOfAReaderThatWasKilledIsGivenUp) {
    const RingName name;
    auto writer = open_writer(name, WhenFull::wait);
    EXPECT_EQ(in_child([&] {
                  auto reader = open_reader(name, lossless);
                  ::kill(::getpid(), SIGKILL);
                  return 0;
              }),
              128 + SIGKILL);
    write_many(writer, 500);  // each waits at most a minute
    EXPECT_EQ(writer.dropped(), 0u);
    EXPECT_TRUE(ring_status(name.text())->readers.empty());
}

TEST(RingProcess, TheNextReaderInTheSlotOfOneThatWasKilledHoldsNobody) {
    const RingName name;
    auto writer = open_writer(name, WhenFull::drop_newest);
    EXPECT_EQ(in_child([&] {
                  auto reader = open_reader(name, lossless);
                  ::kill(::getpid(), SIGKILL);
                  return 0;
              }),
              128 + SIGKILL);
    const auto reader = open_reader(name);
    ASSERT_EQ(ring_status(name.text())->readers.size(), 1u);
    EXPECT_FALSE(ring_status(name.text())->readers[0].holds);
    write_many(writer, 500);
    EXPECT_EQ(writer.dropped(), 0u);
}

TEST(RingProcess, AStoppedReaderIsNotTakenForDead) {
    const RingName name;
    auto writer = open_writer(name, WhenFull::drop_newest);
    const pid_t child = ::fork();
    if (child == 0) {
        const auto reader = open_reader(name, lossless);
        ::raise(SIGSTOP);
        ::_exit(reader.holds() ? 0 : 1);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, WUNTRACED), child);
    ASSERT_TRUE(WIFSTOPPED(status));
    const std::string text(1000, 'x');
    for (int i = 0; i < 1000; ++i) static_cast<void>(writer.write(bytes_of(text), {}));
    EXPECT_EQ(writer.records(), 64u);
    EXPECT_EQ(writer.dropped(), 936u);
    ::kill(child, SIGCONT);
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(RingProcess, ReadersAndWriterOfDifferentProcessesWakeEachOther) {
    const RingName name;
    auto writer = open_writer(name, WhenFull::wait);
    const pid_t child = ::fork();
    if (child == 0) {
        auto reader = open_reader(name, lossless);
        int expected = 0;
        for (;;) {
            const auto record = reader.read(soon());
            if (!record) ::_exit(record.error() == ReadError::no_writer && expected == 5000 ? 0 : 1);
            if (std::stoi(text_of(*record)) != expected++) ::_exit(2);
        }
    }
    while (ring_status(name.text())->readers.empty()) std::this_thread::yield();
    while (!ring_status(name.text())->readers.at(0).holds) std::this_thread::yield();
    write_many(writer, 5000);
    ASSERT_TRUE(writer.close());
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace mavloom::shm
