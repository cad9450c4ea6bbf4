// SPDX-License-Identifier: MIT
#include "mavloom/record/tlog_index.hpp"

#include <gtest/gtest.h>

#include "mavloom/record/tlog_writer.hpp"
#include "support/bytes.hpp"
#include "support/golden_frames.hpp"
#include "support/golden_table.hpp"
#include "support/temp_dir.hpp"

namespace mavloom::record {
namespace {

using test::TempDir;

constexpr std::uint64_t record_bytes = 29;  // a heartbeat

// A recording of heartbeats at these microseconds.
std::filesystem::path recording(const TempDir& dir, const std::vector<std::uint64_t>& times_us) {
    auto writer = TlogWriter::create(dir / "x.tlog");
    for (const auto time_us : times_us)
        (void)writer->write(wall_from_us(time_us), wire::FrameView::unchecked(test::heartbeat_v2));
    (void)writer->close();
    return dir / "x.tlog";
}

// The number of the record that `seek` finds.
std::uint64_t sought(const TlogIndex& index, TlogReader& reader, std::uint64_t time_us) {
    EXPECT_TRUE(index.seek(reader, wall_from_us(time_us)).has_value());
    return reader.position() / record_bytes;
}

TEST(TlogIndex, FindsTheFirstRecordAtOrAfterAMoment) {
    const TempDir dir;
    auto reader = TlogReader::open(recording(dir, {10, 20, 20, 30, 40, 50, 60}), test::golden_table());
    const auto index = TlogIndex::build(*reader, 2);
    ASSERT_TRUE(index.has_value());

    EXPECT_EQ(index->records(), 7u);
    EXPECT_EQ(index->entries(), 4u);
    EXPECT_EQ(sought(*index, *reader, 0), 0u);
    EXPECT_EQ(sought(*index, *reader, 10), 0u);
    EXPECT_EQ(sought(*index, *reader, 11), 1u);
    EXPECT_EQ(sought(*index, *reader, 20), 1u);
    EXPECT_EQ(sought(*index, *reader, 21), 3u);
    EXPECT_EQ(sought(*index, *reader, 60), 6u);
    EXPECT_EQ(sought(*index, *reader, 61), 7u);
}

TEST(TlogIndex, FindsMomentsWhereTimeRunsBackwards) {
    const TempDir dir;
    auto reader = TlogReader::open(recording(dir, {10, 50, 20, 30, 60, 5, 70}), test::golden_table());
    const auto index = TlogIndex::build(*reader, 2);

    EXPECT_EQ(index->backward_steps(), 2u);
    EXPECT_EQ(unix_us(*index->earliest()), 5);
    EXPECT_EQ(unix_us(*index->latest()), 70);
    EXPECT_EQ(sought(*index, *reader, 20), 1u);
    EXPECT_EQ(sought(*index, *reader, 51), 4u);
    EXPECT_EQ(sought(*index, *reader, 61), 6u);
}

TEST(TlogIndex, OfAnEmptyFileHasNoTimes) {
    const TempDir dir;
    auto reader = TlogReader::open(recording(dir, {}), test::golden_table());
    const auto index = TlogIndex::build(*reader);

    EXPECT_EQ(index->records(), 0u);
    EXPECT_FALSE(index->earliest().has_value());
    EXPECT_TRUE(index->seek(*reader, WallTime{}).has_value());
}

TEST(TlogIndex, SkipsToTheMiddleOfARecordedFlight) {
    auto reader = TlogReader::open(MAVLOOM_TEST_DATA "/px4_gcs_flight.tlog", test::golden_table());
    const auto index = TlogIndex::build(*reader);
    const auto middle = *index->earliest() + std::chrono::seconds{50};

    ASSERT_TRUE(index->seek(*reader, middle).has_value());
    const auto record = reader->next();

    EXPECT_EQ(index->records(), 40087u);
    EXPECT_EQ(index->backward_steps(), 0u);
    EXPECT_GE(record->time, middle);
    EXPECT_LT(record->time - middle, std::chrono::microseconds{55864});  // the longest gap
    EXPECT_GT(record->offset - index->offset_before(middle), 0u);
    EXPECT_LT(record->offset - index->offset_before(middle), 1024u * 288u);
}

}  // namespace
}  // namespace mavloom::record
