// SPDX-License-Identifier: MIT
#include "mavloom/record/tlog_reader.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <pthread.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <map>
#include <thread>

#include "support/bytes.hpp"
#include "support/golden_frames.hpp"
#include "support/golden_table.hpp"
#include "support/temp_dir.hpp"

namespace mavloom::record {
namespace {

using test::Bytes;
using test::golden_table;
using test::TempDir;
using testing::ElementsAre;

// One record as the format has it: eight bytes of big-endian microseconds, then the frame.
Bytes record(std::uint64_t time_us, const Bytes& frame) {
    Bytes bytes(8);
    for (int i = 7; i >= 0; --i, time_us >>= 8) bytes[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(time_us);
    bytes.insert(bytes.end(), frame.begin(), frame.end());
    return bytes;
}

Bytes operator+(Bytes a, const Bytes& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

struct Outcome {
    std::vector<Bytes> frames;
    std::vector<std::int64_t> times_us;
    std::vector<std::uint64_t> offsets, lost_before;
    std::uint64_t lost_bytes = 0, damaged_places = 0, unknown_ids = 0, unknown_flags = 0, flagged_bytes = 0,
                  record_bytes = 0;
};

Outcome read_file(const std::filesystem::path& path) {
    auto reader = TlogReader::open(path, golden_table());
    if (!reader) throw std::runtime_error(reader.error().text);
    Outcome outcome;
    while (const auto record = reader->next()) {
        outcome.frames.emplace_back(record->frame.bytes().begin(), record->frame.bytes().end());
        outcome.times_us.push_back(unix_us(record->time));
        outcome.offsets.push_back(record->offset);
        outcome.lost_before.push_back(record->lost_bytes);
    }
    EXPECT_EQ(reader->next().error(), TlogReader::Stop::end);
    const auto& counters = reader->counters();
    EXPECT_EQ(counters.record_bytes.value() + counters.flagged_bytes.value() + counters.lost_bytes.value(),
              reader->size());
    EXPECT_EQ(counters.records.value(), outcome.frames.size());
    outcome.lost_bytes = counters.lost_bytes.value();
    outcome.damaged_places = counters.damaged_places.value();
    outcome.unknown_ids = counters.unknown_ids.value();
    outcome.unknown_flags = counters.unknown_flags.value();
    outcome.flagged_bytes = counters.flagged_bytes.value();
    outcome.record_bytes = counters.record_bytes.value();
    return outcome;
}

Outcome read_bytes(const Bytes& content) {
    const TempDir dir;
    test::write_file(dir / "x.tlog", content);
    return read_file(dir / "x.tlog");
}

constexpr std::uint64_t t0 = 1'700'000'000'000'000;  // 2023-11-14

// tests/data/README.md: counts of an independent walk over the file, and of pymavlink's reader.
TEST(TlogReader, FindsEveryRecordOfARecordedFlight) {
    auto reader = TlogReader::open(MAVLOOM_TEST_DATA "/px4_gcs_flight.tlog", golden_table());
    ASSERT_TRUE(reader.has_value()) << reader.error().text;
    std::map<std::uint32_t, int> ids;
    std::map<int, int> systems;
    std::vector<WallTime> times;
    while (const auto record = reader->next()) {
        ++ids[record->frame.id().value];
        ++systems[record->frame.system().value];
        times.push_back(record->time);
        EXPECT_NE(record->info, nullptr);
    }

    EXPECT_EQ(times.size(), 40087u);
    EXPECT_EQ(systems[1], 39974);
    EXPECT_EQ(systems[255], 113);
    EXPECT_EQ(ids.size(), 37u);
    EXPECT_EQ(std::chrono::duration_cast<std::chrono::microseconds>(times.back() - times.front()).count(), 108265991);
    EXPECT_EQ(reader->counters().lost_bytes.value(), 0u);
    EXPECT_EQ(reader->counters().record_bytes.value(), 2155595u);
    EXPECT_EQ(reader->position(), 2155595u);
}

TEST(TlogReader, TakesBothVersionsSignedFramesAndAllEightTimeBytes) {
    const auto outcome = read_bytes(record(t0, test::heartbeat_v1) + record(t0 + 3, test::heartbeat_signed_1) +
                                    record(0, test::attitude_v2) +
                                    record((std::uint64_t{1} << 53) - 1, test::ping_zero_v2));

    EXPECT_THAT(outcome.frames,
                ElementsAre(test::heartbeat_v1, test::heartbeat_signed_1, test::attitude_v2, test::ping_zero_v2));
    EXPECT_THAT(outcome.times_us, ElementsAre(1'700'000'000'000'000, 1'700'000'000'000'003, 0, 9'007'199'254'740'991));
    EXPECT_THAT(outcome.offsets, ElementsAre(0, 25, 67, 103));
}

TEST(TlogReader, AnEmptyFileHoldsNothing) {
    const auto outcome = read_bytes({});

    EXPECT_TRUE(outcome.frames.empty());
    EXPECT_EQ(outcome.damaged_places, 0u);
}

TEST(TlogReader, ContinuesBehindJunkAndReportsHowMuchWasLost) {
    const Bytes junk(1000, 0xfd);
    const auto outcome = read_bytes(record(t0, test::heartbeat_v2) + junk + record(t0 + 1, test::attitude_v2) +
                                    Bytes{1, 2, 3});

    EXPECT_THAT(outcome.frames, ElementsAre(test::heartbeat_v2, test::attitude_v2));
    EXPECT_THAT(outcome.lost_before, ElementsAre(0, 1000));
    EXPECT_EQ(outcome.lost_bytes, 1003u);
    EXPECT_EQ(outcome.damaged_places, 2u);
}

TEST(TlogReader, LosesOnlyTheRecordThatIsDamaged) {
    for (std::size_t at = 8; at < 8 + test::attitude_v2.size(); ++at) {
        Bytes damaged = record(t0 + 1, test::attitude_v2);
        damaged[at] ^= 0x40;
        const auto outcome = read_bytes(record(t0, test::heartbeat_v2) + damaged + record(t0 + 2, test::ping_zero_v2));

        EXPECT_THAT(outcome.frames, ElementsAre(test::heartbeat_v2, test::ping_zero_v2)) << "byte " << at;
        EXPECT_EQ(outcome.lost_bytes, damaged.size()) << "byte " << at;
    }
}

TEST(TlogReader, LosesARecordWhoseTimeIsImpossible) {
    const auto outcome = read_bytes(record(std::uint64_t{1} << 53, test::heartbeat_v2) + record(t0, test::attitude_v2));

    EXPECT_THAT(outcome.frames, ElementsAre(test::attitude_v2));
    EXPECT_THAT(outcome.lost_before, ElementsAre(29));
}

TEST(TlogReader, ACutFileLosesItsLastRecordOnly) {
    const Bytes whole = record(t0, test::heartbeat_v2) + record(t0 + 1, test::attitude_v2);
    const std::size_t first = record(t0, test::heartbeat_v2).size();
    for (std::size_t cut = 0; cut < whole.size(); ++cut) {
        const auto outcome = read_bytes(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(cut)));

        EXPECT_EQ(outcome.frames.size(), cut < first ? 0u : 1u) << cut;
        EXPECT_EQ(outcome.lost_bytes, cut < first ? cut : cut - first) << cut;
    }
}

// Id 50000, which no dialect here has; its checksum by pymavlink's x25crc with CRC_EXTRA 77.
Bytes frame_of_unknown_id() { return test::hex("fd03000009010150c300010203e4d4"); }

TEST(TlogReader, TakesAnUnknownIdWhereItsEndIsAnotherRecordOrTheEndOfTheFile) {
    const auto unknown = record(t0 + 1, frame_of_unknown_id());
    const auto outcome = read_bytes(record(t0, test::heartbeat_v2) + unknown + unknown +
                                    record(t0 + 2, test::attitude_v2) + unknown);

    EXPECT_EQ(outcome.frames.size(), 5u);
    EXPECT_EQ(outcome.unknown_ids, 3u);
    EXPECT_EQ(outcome.lost_bytes, 0u);
}

TEST(TlogReader, RefusesAnUnknownIdThatEndsNowhere) {
    const auto outcome = read_bytes(record(t0 + 1, frame_of_unknown_id()) + Bytes{9, 9, 9} +
                                    record(t0, test::heartbeat_v2));

    EXPECT_THAT(outcome.frames, ElementsAre(test::heartbeat_v2));
    EXPECT_EQ(outcome.unknown_ids, 0u);
    EXPECT_EQ(outcome.lost_bytes, 26u);
}

TEST(TlogReader, SkipsAndCountsFramesWithAnUndefinedFlag) {
    // heartbeat_v2 with incompatibility flag 0x04 and its checksum by pymavlink's x25crc.
    const Bytes flagged = test::hex("fd09040007010100000000000402020c510403921c");
    const auto outcome = read_bytes(record(t0, flagged) + record(t0 + 1, test::attitude_v2));

    EXPECT_THAT(outcome.frames, ElementsAre(test::attitude_v2));
    EXPECT_EQ(outcome.unknown_flags, 1u);
    EXPECT_EQ(outcome.flagged_bytes, 29u);
    EXPECT_EQ(outcome.lost_bytes, 0u);
}

TEST(TlogReader, ContinuesBehindDamageLongerThanItsBuffer) {
    for (const std::uint8_t fill : {std::uint8_t{0}, std::uint8_t{0xfd}, std::uint8_t{0xfe}, std::uint8_t{0xff}}) {
        const Bytes junk(700'001, fill);
        const auto outcome = read_bytes(record(t0, test::heartbeat_v2) + junk + record(t0, test::attitude_v2));

        EXPECT_EQ(outcome.frames.size(), 2u) << int{fill};
        EXPECT_EQ(outcome.lost_bytes, 700'001u) << int{fill};
        EXPECT_EQ(outcome.damaged_places, 1u) << int{fill};
    }
}

TEST(TlogReader, ReadsEndlessZerosInConstantMemory) {
    const off_t size = std::getenv("MAVLOOM_LONG") != nullptr ? 2'000'000'000 : 200'000'000;
    const TempDir dir;
    const auto path = dir / "zeros.tlog";
    test::write_file(path, record(t0, test::heartbeat_v2));
    ASSERT_EQ(::truncate(path.c_str(), size), 0);  // sparse: takes no disk
    rusage before{}, after{};
    ::getrusage(RUSAGE_SELF, &before);

    const auto outcome = read_file(path);

    ::getrusage(RUSAGE_SELF, &after);
    EXPECT_EQ(outcome.frames.size(), 1u);
    EXPECT_EQ(outcome.lost_bytes, static_cast<std::uint64_t>(size) - 29u);
    EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 8 * 1024) << "KiB";
}

TEST(TlogReader, AFileThatIsShortenedMeanwhileIsAnError) {
    const TempDir dir;
    const auto path = dir / "x.tlog";
    Bytes content;
    while (content.size() < 1'000'000) content = content + record(t0, test::tunnel_v2);
    test::write_file(path, content);
    auto reader = TlogReader::open(path, golden_table());
    ASSERT_TRUE(reader->next().has_value());
    ASSERT_EQ(::truncate(path.c_str(), 300'000), 0);

    auto last = reader->next();
    while (last) last = reader->next();

    EXPECT_EQ(last.error(), TlogReader::Stop::failed);
    EXPECT_EQ(reader->error().code, SetupCode::bad_input);
    EXPECT_THAT(reader->error().text, testing::HasSubstr("shortened while it was read"));
}

TEST(TlogReader, ReadsAPipe) {
    const TempDir dir;
    const auto path = dir / "pipe";
    ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
    std::thread sender([&] { test::write_file(path, record(t0, test::heartbeat_v2) + record(t0, test::attitude_v2)); });

    auto reader = TlogReader::open(path, golden_table());
    int frames = 0;
    while (reader->next()) ++frames;
    sender.join();

    EXPECT_EQ(frames, 2);
    EXPECT_EQ(reader->size(), 0u);
}

// A reader that fills its buffer first would wait here for ever.
TEST(TlogReader, HandsOnWhatASlowWriterHasWritten) {
    const TempDir dir;
    const auto path = dir / "pipe";
    ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
    const int writer = ::open(path.c_str(), O_RDWR);
    ASSERT_GE(writer, 0);
    auto reader = TlogReader::open(path, golden_table());
    const auto whole = record(t0, test::heartbeat_v2);
    const auto next = record(t0 + 1, test::attitude_v2);

    ASSERT_EQ(::write(writer, whole.data(), whole.size()), static_cast<ssize_t>(whole.size()));
    ASSERT_TRUE(reader->next().has_value());
    ASSERT_EQ(::write(writer, next.data(), 10), 10);
    std::thread slow([&] { (void)!::write(writer, next.data() + 10, next.size() - 10); });
    const auto second = reader->next();
    slow.join();

    ASSERT_TRUE(second.has_value());
    EXPECT_EQ(second->frame.id().value, 30u);
    ::close(writer);
    EXPECT_EQ(reader->next().error(), TlogReader::Stop::end);
    EXPECT_EQ(reader->counters().lost_bytes.value(), 0u);
}

TEST(TlogReader, ReportsThatAPipeHasNothingYet) {
    const TempDir dir;
    const auto path = dir / "pipe";
    ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
    auto reader = TlogReader::open(path, golden_table(), File::Empty::report);  // no writer: open() would wait for one
    ASSERT_TRUE(reader.has_value());
    EXPECT_FALSE(reader->is_file());
    EXPECT_EQ(reader->next().error(), TlogReader::Stop::nothing_yet);

    const int writer = ::open(path.c_str(), O_WRONLY);
    ASSERT_GE(writer, 0);
    EXPECT_EQ(reader->next().error(), TlogReader::Stop::nothing_yet);
    const auto whole = record(t0, test::heartbeat_v2);
    ASSERT_EQ(::write(writer, whole.data(), 10), 10);
    EXPECT_EQ(reader->next().error(), TlogReader::Stop::nothing_yet);
    ASSERT_EQ(::write(writer, whole.data() + 10, whole.size() - 10), static_cast<ssize_t>(whole.size() - 10));
    EXPECT_TRUE(reader->next().has_value());
    EXPECT_EQ(reader->next().error(), TlogReader::Stop::nothing_yet);
    ::close(writer);
    EXPECT_EQ(reader->next().error(), TlogReader::Stop::end);
}

// A signal without SA_RESTART, as Ctrl-C is, ends the waiting, not the recording.
TEST(TlogReader, ASignalEndsTheWaitForAPipe) {
    const TempDir dir;
    const auto path = dir / "pipe";
    ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
    const int writer = ::open(path.c_str(), O_RDWR);
    ASSERT_GE(writer, 0);
    struct sigaction action {};
    action.sa_handler = [](int) {};
    struct sigaction before {};
    ASSERT_EQ(::sigaction(SIGUSR1, &action, &before), 0);
    auto reader = TlogReader::open(path, golden_table());
    std::atomic<bool> done = false;
    const auto waiting = ::pthread_self();
    std::thread sender([&] {
        while (!done) {  // the first ones may come before it waits
            ::pthread_kill(waiting, SIGUSR1);
            std::this_thread::sleep_for(std::chrono::milliseconds{1});
        }
    });

    const auto stop = reader->next();
    done = true;
    sender.join();
    ::sigaction(SIGUSR1, &before, nullptr);
    const auto whole = record(t0, test::heartbeat_v2);
    ASSERT_EQ(::write(writer, whole.data(), whole.size()), static_cast<ssize_t>(whole.size()));
    const auto later = reader->next();

    ASSERT_FALSE(stop.has_value());
    EXPECT_EQ(stop.error(), TlogReader::Stop::nothing_yet);
    EXPECT_TRUE(later.has_value());
    ::close(writer);
}

TEST(TlogReader, StatesWhyAFileCannotBeOpened) {
    const TempDir dir;

    const auto missing = TlogReader::open(dir / "none.tlog", golden_table());
    const auto folder = TlogReader::open(dir.path(), golden_table());

    EXPECT_EQ(missing.error().code, SetupCode::not_found);
    EXPECT_THAT(missing.error().text, testing::HasSubstr("none.tlog: No such file"));
    EXPECT_THAT(folder.error().text, testing::HasSubstr("Is a directory"));
}

TEST(TlogReader, StopsWhereThereIsNothingButDamage) {
    const TempDir dir;
    for (const auto byte : std::initializer_list<std::uint8_t>{0x00, 0xfd, 0xfe}) {
        const test::Bytes junk(1'000'000, byte);
        test::write_file(dir / "x.tlog", record(t0, test::heartbeat_v2) + junk + record(t0 + 1, test::attitude_v2));
        auto reader = TlogReader::open(dir / "x.tlog", golden_table());
        ASSERT_TRUE(reader->next(1000).has_value());

        int stopped = 0;
        auto found = reader->next(1000);
        for (; !found && found.error() == TlogReader::Stop::damage; found = reader->next(1000)) ++stopped;

        ASSERT_TRUE(found.has_value());
        EXPECT_EQ(found->frame.id().value, 30u);
        EXPECT_EQ(found->lost_bytes, 1'000'000u);
        EXPECT_GE(stopped, 1);
        EXPECT_EQ(reader->counters().damaged_places.value(), 1u);
    }
}

// A program that reads one message of a long recording handles signals although the message does not occur.
TEST(TlogReader, StopsWhereOnlyOtherMessagesAre) {
    const TempDir dir;
    Bytes content;
    for (int i = 0; i < 1000; ++i) content = std::move(content) + record(t0, test::heartbeat_v2);
    test::write_file(dir / "x.tlog", content + record(t0, test::attitude_v2));
    auto reader = TlogReader::open(dir / "x.tlog", golden_table());

    int stopped = 0;
    auto found = reader->next_of(MessageId{30}, 1000);
    for (; !found && found.error() == TlogReader::Stop::damage; found = reader->next_of(MessageId{30}, 1000)) ++stopped;

    ASSERT_TRUE(found.has_value());
    EXPECT_GE(stopped, 1);
    EXPECT_EQ(found->offset, content.size());
}

// The position in a file is the reader's own, which a forked child could not move.
TEST(TlogReader, TwoThatShareADescriptionReadAllOfIt) {
    const TempDir dir;
    test::write_file(dir / "x.tlog", record(t0, test::heartbeat_v2));
    auto file = File::open_to_read(dir / "x.tlog");
    ASSERT_TRUE(file.has_value());
    const pid_t child = ::fork();
    Bytes bytes(100);
    const auto got = file->read(bytes);
    if (child == 0) ::_exit(got && *got == 29 ? 0 : 1);
    int status = 1;
    ASSERT_EQ(::waitpid(child, &status, 0), child);

    EXPECT_EQ(status, 0);
    EXPECT_EQ(*got, 29u);
}

TEST(TlogReader, SeeksToARecord) {
    const TempDir dir;
    test::write_file(dir / "x.tlog", record(t0, test::heartbeat_v2) + record(t0 + 1, test::attitude_v2));
    auto reader = TlogReader::open(dir / "x.tlog", golden_table());
    while (reader->next()) {}

    ASSERT_TRUE(reader->seek(29).has_value());
    const auto record = reader->next();

    ASSERT_TRUE(record.has_value());
    EXPECT_EQ(record->offset, 29u);
    EXPECT_EQ(record->frame.id().value, 30u);
    EXPECT_EQ(reader->next().error(), TlogReader::Stop::end);
}

}  // namespace
}  // namespace mavloom::record
