// SPDX-License-Identifier: MIT
#include "mavloom/record/rotating_writer.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "mavloom/record/tlog_reader.hpp"
#include "support/bytes.hpp"
#include "support/file_size_limit.hpp"
#include "support/golden_frames.hpp"
#include "support/golden_table.hpp"
#include "support/temp_dir.hpp"

namespace mavloom::record {
namespace {

using namespace std::chrono_literals;
using test::content_of;
using test::TempDir;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr WallTime begin = wall_from_us(1'700'000'000'000'000);  // 2023-11-14 22:13:20 UTC
constexpr std::size_t heartbeat_record_bytes = 29;

wire::FrameView heartbeat() { return wire::FrameView::unchecked(test::heartbeat_v2); }

RotatingWriter created(const std::filesystem::path& path, Rotation rotation) {
    auto writer = RotatingWriter::create(path, rotation);
    if (!writer) throw std::runtime_error(writer.error().text);
    return std::move(*writer);
}

std::vector<std::string> names_in(const TempDir& dir) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(dir.path()))
        names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
}

void record(RotatingWriter& writer, std::initializer_list<Nanoseconds> times) {
    for (const auto time : times) ASSERT_TRUE(writer.write(begin + time, heartbeat()).has_value());
    ASSERT_TRUE(writer.close().has_value());
}

TEST(RotatingWriter, WritesExactlyThePathWithoutRotation) {
    const TempDir dir;
    auto writer = created(dir / "x.tlog", {});

    record(writer, {0s, 3600s, 86400s});

    EXPECT_THAT(names_in(dir), ElementsAre("x.tlog"));
    EXPECT_EQ(writer.segments(), 1u);
    EXPECT_EQ(writer.written_bytes(), 3 * heartbeat_record_bytes);
}

TEST(RotatingWriter, TwoFramesElevenTenthsApartWithSegmentsOfASecondAreTwoFiles) {
    const TempDir dir;
    auto writer = created(dir / "x.tlog", {.every = 1s});

    record(writer, {0s, 1100ms});

    EXPECT_THAT(names_in(dir), ElementsAre("x-20231114T221320.000Z.tlog", "x-20231114T221321.100Z.tlog"));
    EXPECT_EQ(content_of(dir / "x-20231114T221320.000Z.tlog").size(), heartbeat_record_bytes);
    EXPECT_EQ(content_of(dir / "x-20231114T221321.100Z.tlog").size(), heartbeat_record_bytes);
    EXPECT_EQ(writer.segments(), 2u);
    EXPECT_EQ(writer.written_records(), 2u);
    EXPECT_EQ(writer.written_bytes(), 2 * heartbeat_record_bytes);
}

TEST(RotatingWriter, AFrameJustBelowTheIntervalStays) {
    const TempDir dir;
    auto writer = created(dir / "x.tlog", {.every = 1s});

    record(writer, {0s, 999'999'999ns});
    EXPECT_EQ(writer.segments(), 1u);
}

TEST(RotatingWriter, AFrameExactlyAtTheIntervalIsTheNextSegmentsFirst) {
    const TempDir dir;
    auto writer = created(dir / "x.tlog", {.every = 1s});

    record(writer, {0s, 1s});
    EXPECT_EQ(writer.segments(), 2u);
}

TEST(RotatingWriter, EarlierFramesStayInTheOpenSegment) {
    const TempDir dir;
    auto writer = created(dir / "x.tlog", {.every = 1s});

    record(writer, {0s, 5s, 1s, -3600s, 5500ms});

    EXPECT_THAT(names_in(dir), ElementsAre("x-20231114T221320.000Z.tlog", "x-20231114T221325.000Z.tlog"));
    EXPECT_EQ(content_of(dir / "x-20231114T221325.000Z.tlog").size(), 4 * heartbeat_record_bytes);
}

TEST(RotatingWriter, NoSegmentIsLargerThanAskedAndNoFrameIsSplit) {
    const TempDir dir;
    const std::filesystem::path source = MAVLOOM_TEST_DATA "/px4_gcs_flight.tlog";
    auto reader = TlogReader::open(source, test::golden_table());
    auto writer = created(dir / "x.tlog", {.bytes = 10'000});
    std::vector<std::filesystem::path> files;

    while (const auto record = reader->next()) {
        ASSERT_TRUE(writer.write(record->time, record->frame).has_value());
        if (files.empty() || files.back() != writer.segment_path()) files.push_back(writer.segment_path());
    }
    ASSERT_TRUE(writer.close().has_value());

    std::vector<std::uint8_t> joined;
    for (const auto& file : files) {
        const auto content = content_of(file);
        EXPECT_LE(content.size(), 10'000u);
        joined.insert(joined.end(), content.begin(), content.end());
        auto segment = TlogReader::open(file, test::golden_table());
        while (segment->next()) {}
        EXPECT_EQ(segment->counters().lost_bytes.value(), 0u);
    }
    EXPECT_TRUE(joined == content_of(source));
    EXPECT_EQ(writer.segments(), files.size());
    EXPECT_EQ(names_in(dir).size(), files.size());
}

TEST(RotatingWriter, ANameThatIsTakenIsLeftAlone) {
    const TempDir dir;
    for (int run = 0; run < 3; ++run) {
        auto writer = created(dir / "x.tlog", {.every = 1h});
        record(writer, {0s});
    }

    EXPECT_THAT(names_in(dir), ElementsAre("x-20231114T221320.000Z.tlog", "x-20231114T221320.000Z_2.tlog",
                                           "x-20231114T221320.000Z_3.tlog"));
}

TEST(RotatingWriter, MakesNoFileWithoutAFrame) {
    const TempDir dir;
    auto writer = created(dir / "x.tlog", {.every = 1h});

    ASSERT_TRUE(writer.flush().has_value());
    ASSERT_TRUE(writer.close().has_value());
    EXPECT_THAT(names_in(dir), ElementsAre());
    EXPECT_TRUE(writer.segment_path().empty());
}

TEST(RotatingWriter, AFolderThatIsMissingIsFoundAtOnce) {
    const TempDir dir;
    const auto writer = RotatingWriter::create(dir / "missing/x.tlog", {.every = 1h});

    ASSERT_FALSE(writer.has_value());
    EXPECT_EQ(writer.error().code, SetupCode::not_found);
    EXPECT_THAT(writer.error().text, HasSubstr("missing"));
}

TEST(RotatingWriter, ADeviceIsNotRotated) {
    const auto writer = RotatingWriter::create("/dev/null", {.bytes = 4096});

    ASSERT_FALSE(writer.has_value());
    EXPECT_EQ(writer.error().code, SetupCode::usage);
}

TEST(RotatingWriter, AFolderThatGoesAwayIsAnErrorAndKeepsTheOpenSegment) {
    const TempDir dir;
    std::filesystem::create_directory(dir / "sub");
    auto writer = created(dir / "sub/x.tlog", {.every = 1s});
    ASSERT_TRUE(writer.write(begin, heartbeat()).has_value());
    std::filesystem::rename(dir / "sub", dir / "other");

    EXPECT_FALSE(writer.write(begin + 2s, heartbeat()).has_value());

    EXPECT_TRUE(writer.close().has_value());
    EXPECT_EQ(writer.written_records(), 1u);
    EXPECT_EQ(content_of(dir / "other/x-20231114T221320.000Z.tlog").size(), heartbeat_record_bytes);
}

struct Lost {
    const char* what;
    void (*lose)(const std::filesystem::path& file);
    const char* continues_in = "x.tlog";
};

class LosesItsFile : public testing::TestWithParam<Lost> {};

INSTANTIATE_TEST_SUITE_P(
    RotatingWriter, LosesItsFile,
    testing::Values(Lost{"Deleted", [](const auto& file) { std::filesystem::remove(file); }},
                    Lost{"Replaced",
                         [](const auto& file) {
                             std::filesystem::remove(file);
                             test::write_file(file, {});
                         },
                         "x_2.tlog"},
                    Lost{"ReplacedByAnotherRecording",
                         [](const auto& file) {
                             std::filesystem::remove(file);
                             auto other = created(file, {});
                             record(other, {0s});
                         },
                         "x_2.tlog"},
                    Lost{"Renamed", [](const auto& file) { std::filesystem::rename(file, file.string() + ".away"); }}),
    [](const auto& given) { return given.param.what; });

TEST_P(LosesItsFile, WhatIsBufferedGoesToTheNewFile) {
    const TempDir dir;
    auto writer = created(dir / "x.tlog", {});
    for (const auto time : {0s, 1s}) ASSERT_TRUE(writer.write(begin + time, heartbeat()).has_value());
    GetParam().lose(dir / "x.tlog");

    EXPECT_EQ(writer.maintain(MonoTime{} + 1s).value(), dir / "x.tlog");
    record(writer, {2s});

    EXPECT_EQ(content_of(dir / GetParam().continues_in).size(), 3 * heartbeat_record_bytes);
    EXPECT_FALSE(std::filesystem::exists(dir / "x.tlog.1")) << "another program's file was renamed";
    EXPECT_EQ(writer.taken_records(), 3u);
    EXPECT_EQ(writer.written_records(), 3u);
    EXPECT_EQ(writer.lost_records(), 0u);
}

TEST_P(LosesItsFile, WhatIsBufferedBeginsTheNextSegment) {
    const TempDir dir;
    auto writer = created(dir / "x.tlog", {.every = 10s});
    ASSERT_TRUE(writer.write(begin, heartbeat()).has_value());
    ASSERT_TRUE(writer.flush().has_value());
    ASSERT_TRUE(writer.write(begin + 2s, heartbeat()).has_value());
    GetParam().lose(dir / "x-20231114T221320.000Z.tlog");

    EXPECT_FALSE(writer.maintain(MonoTime{} + 1s).value().empty());
    record(writer, {11s, 12s});

    EXPECT_EQ(content_of(dir / "x-20231114T221322.000Z.tlog").size(), 2 * heartbeat_record_bytes);
    EXPECT_EQ(content_of(dir / "x-20231114T221332.000Z.tlog").size(), heartbeat_record_bytes);
    EXPECT_EQ(writer.written_records(), 4u);
}

TEST_P(LosesItsFile, WhatIsBufferedAtTheEndIsWritten) {
    const TempDir dir;
    auto writer = created(dir / "x.tlog", {});
    ASSERT_TRUE(writer.write(begin, heartbeat()).has_value());
    GetParam().lose(dir / "x.tlog");

    EXPECT_EQ(writer.close().value(), dir / "x.tlog") << "nobody looks any more, so this reports it";
    EXPECT_EQ(content_of(dir / GetParam().continues_in).size(), heartbeat_record_bytes);
    EXPECT_EQ(writer.written_records(), 1u);
    EXPECT_EQ(writer.close().value(), "");
}

// It was reported only if something was buffered.
TEST_P(LosesItsFile, AtTheEndItIsReportedEvenIfNothingIsBuffered) {
    const TempDir dir;
    auto writer = created(dir / "x.tlog", {});
    ASSERT_TRUE(writer.write(begin, heartbeat()).has_value());
    ASSERT_TRUE(writer.flush().has_value());
    GetParam().lose(dir / "x.tlog");

    const auto removed = writer.close();
    EXPECT_EQ(removed.value(), dir / "x.tlog");
    EXPECT_EQ(writer.removal_notice(*removed),
              (dir / "x.tlog").string() + " was removed or replaced before it was complete");
    EXPECT_FALSE(std::filesystem::exists(dir / "x_2.tlog")) << "there is nothing to write";
    EXPECT_EQ(writer.written_records(), 1u);
}

TEST(RotatingWriter, WithoutAFileNothingCountsAsWritten) {
    const TempDir dir;
    std::filesystem::create_directory(dir / "sub");
    auto writer = created(dir / "sub/x.tlog", {});
    ASSERT_TRUE(writer.write(begin, heartbeat()).has_value());
    std::filesystem::remove_all(dir / "sub");

    EXPECT_FALSE(writer.maintain(MonoTime{} + 1s).has_value());
    EXPECT_FALSE(writer.flush().has_value());
    std::uint64_t taken = 1;
    while (writer.write(begin, heartbeat())) ++taken;
    EXPECT_EQ(writer.written_records(), 0u);
    EXPECT_EQ(writer.lost_records(), 1u) << "the buffer is full";

    std::filesystem::create_directory(dir / "sub");
    EXPECT_EQ(writer.maintain(MonoTime{} + 2s).value(), dir / "sub/x.tlog");
    ASSERT_TRUE(writer.close().has_value());
    EXPECT_EQ(writer.written_records(), taken);
    EXPECT_EQ(content_of(dir / "sub/x.tlog").size(), taken * heartbeat_record_bytes);
}

struct Intruder {
    const char* what;
    void (*put_at)(const std::filesystem::path& path);
};

class FindsAnotherFileInItsPlace : public testing::TestWithParam<Intruder> {};

INSTANTIATE_TEST_SUITE_P(
    RotatingWriter, FindsAnotherFileInItsPlace,
    testing::Values(Intruder{"Text", [](const auto& path) { std::ofstream(path) << "a note"; }},
                    Intruder{"Folder", [](const auto& path) { std::filesystem::create_directory(path); }},
                    Intruder{"Fifo", [](const auto& path) { ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0); }},
                    Intruder{"LinkToDevice",
                             [](const auto& path) { std::filesystem::create_symlink("/dev/null", path); }}),
    [](const auto& given) { return given.param.what; });

// It went nowhere until the other file was gone. (To wait for the reader of a FIFO would hang the test.)
TEST_P(FindsAnotherFileInItsPlace, ContinuesBesideIt) {
    const TempDir dir;
    auto writer = created(dir / "x.tlog", {});
    ASSERT_TRUE(writer.write(begin, heartbeat()).has_value());
    std::filesystem::remove(dir / "x.tlog");
    GetParam().put_at(dir / "x.tlog");
    const auto intruder = std::filesystem::symlink_status(dir / "x.tlog").type();

    EXPECT_EQ(writer.maintain(MonoTime{} + 1s).value(), dir / "x.tlog");
    EXPECT_EQ(writer.segment_path(), dir / "x_2.tlog");
    record(writer, {1s});

    EXPECT_EQ(content_of(dir / "x_2.tlog").size(), 2 * heartbeat_record_bytes);
    EXPECT_EQ(std::filesystem::symlink_status(dir / "x.tlog").type(), intruder);
    EXPECT_EQ(writer.lost_records(), 0u);
}

TEST_P(FindsAnotherFileInItsPlace, EndsBesideIt) {
    const TempDir dir;
    auto writer = created(dir / "x.tlog", {});
    ASSERT_TRUE(writer.write(begin, heartbeat()).has_value());
    std::filesystem::remove(dir / "x.tlog");
    GetParam().put_at(dir / "x.tlog");

    ASSERT_TRUE(writer.close().has_value());
    EXPECT_EQ(content_of(dir / "x_2.tlog").size(), heartbeat_record_bytes);
}

// Between two looks, records went into the deleted file.
TEST(RotatingWriter, NothingIsWrittenToADeletedFile) {
    const TempDir dir;
    auto writer = created(dir / "x.tlog", {});
    std::filesystem::remove(dir / "x.tlog");
    constexpr int count = 3 * TlogWriter::default_buffer_bytes / heartbeat_record_bytes;
    for (int i = 0; i < count; ++i) {
        ASSERT_TRUE(writer.write(begin, heartbeat()).has_value());
        if (i < 3) {
            ASSERT_TRUE(writer.flush().has_value());
        }
    }

    EXPECT_EQ(writer.maintain(MonoTime{} + 1s).value(), dir / "x.tlog");
    ASSERT_TRUE(writer.close().has_value());
    EXPECT_EQ(content_of(dir / "x.tlog").size(), count * heartbeat_record_bytes);
}

// The next segment began before somebody looked, so nobody heard of it, and its last records were lost.
TEST(RotatingWriter, ADeletedSegmentIsReportedIfTheNextOneBeginsFirst) {
    const TempDir dir;
    auto writer = created(dir / "x.tlog", {.every = 10s});
    ASSERT_TRUE(writer.write(begin, heartbeat()).has_value());
    ASSERT_TRUE(writer.flush().has_value());
    std::filesystem::remove(dir / "x-20231114T221320.000Z.tlog");
    ASSERT_TRUE(writer.write(begin + 1s, heartbeat()).has_value());
    ASSERT_TRUE(writer.write(begin + 11s, heartbeat()).has_value());

    EXPECT_EQ(writer.maintain(MonoTime{} + 1s).value(), dir / "x-20231114T221320.000Z.tlog");
    record(writer, {12s});
    EXPECT_EQ(content_of(dir / "x-20231114T221321.000Z.tlog").size(), heartbeat_record_bytes);
    EXPECT_EQ(content_of(dir / "x-20231114T221331.000Z.tlog").size(), 2 * heartbeat_record_bytes);
    EXPECT_EQ(writer.written_records(), 4u);
}

TEST(RotatingWriter, WhatNoNewFileTookIsLostAndCounted) {
    const TempDir dir;
    std::filesystem::create_directory(dir / "sub");
    auto writer = created(dir / "sub/x.tlog", {});
    ASSERT_TRUE(writer.write(begin, heartbeat()).has_value());
    std::filesystem::remove_all(dir / "sub");

    EXPECT_FALSE(writer.close().has_value());
    EXPECT_EQ(writer.written_records(), 0u);
    EXPECT_EQ(writer.lost_records(), 1u);
}

TEST(RotatingWriter, ASegmentThatCannotBeClosedCostsTheNextOneNothing) {
    const TempDir dir;
    auto writer = created(dir / "x.tlog", {.every = 1s});
    for (int i = 0; i < 4; ++i) ASSERT_TRUE(writer.write(begin, heartbeat()).has_value());
    const test::FileSizeLimit limit(100);  // three records

    EXPECT_FALSE(writer.write(begin + 2s, heartbeat()).has_value());
    EXPECT_TRUE(writer.close().has_value());

    EXPECT_EQ(content_of(dir / "x-20231114T221320.000Z.tlog").size(), 3 * heartbeat_record_bytes);
    EXPECT_EQ(content_of(dir / "x-20231114T221322.000Z.tlog").size(), heartbeat_record_bytes);
    EXPECT_EQ(writer.taken_records(), 5u);
    EXPECT_EQ(writer.written_records(), 4u);
    EXPECT_EQ(writer.lost_records(), 1u);
}

TEST(RotatingWriter, CountsWhatADiskThatStaysFullNeverTook) {
    auto writer = created("/dev/full", {});
    ASSERT_TRUE(writer.write(begin, heartbeat()).has_value());

    EXPECT_FALSE(writer.close().has_value());
    EXPECT_FALSE(writer.close().has_value());

    EXPECT_EQ(writer.taken_records(), 1u);
    EXPECT_EQ(writer.written_records(), 0u);
    EXPECT_EQ(writer.written_bytes(), 0u);
    EXPECT_EQ(writer.lost_records(), 1u);
}

}  // namespace
}  // namespace mavloom::record
