// SPDX-License-Identifier: MIT
#include "mavloom/record/tlog_writer.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <thread>

#include "mavloom/record/tlog_reader.hpp"
#include "support/bytes.hpp"
#include "support/file_size_limit.hpp"
#include "support/golden_frames.hpp"
#include "support/golden_table.hpp"
#include "support/temp_dir.hpp"

namespace mavloom::record {
namespace {

using test::content_of;
using test::TempDir;

wire::FrameView view(const test::Bytes& bytes) { return wire::FrameView::unchecked(bytes); }

const test::Bytes heartbeat_record = test::hex("00060a24181e4003fd09000007010100000000000402020c5104033de7");
constexpr WallTime heartbeat_time = wall_from_us(1'700'000'000'000'003);  // 0x00060a24181e4003

TlogWriter created(const std::filesystem::path& path, std::size_t buffer_bytes = TlogWriter::default_buffer_bytes) {
    auto writer = TlogWriter::create(path, buffer_bytes);
    if (!writer) throw std::runtime_error(writer.error().text);
    return std::move(*writer);
}

TEST(TlogWriter, WritesTheTimeBigEndianThenTheFrame) {
    const TempDir dir;
    auto writer = created(dir / "x.tlog");

    ASSERT_TRUE(writer.write(heartbeat_time, view(test::heartbeat_v2)).has_value());
    ASSERT_TRUE(writer.close().has_value());

    EXPECT_EQ(content_of(dir / "x.tlog"), heartbeat_record);
    EXPECT_EQ(writer.records(), 1u);
    EXPECT_EQ(writer.size(), 29u);
    EXPECT_TRUE(writer.renamed_to().empty());
}

TEST(TlogWriter, CopiesARecordingByteForByte) {
    const TempDir dir;
    const std::filesystem::path source = MAVLOOM_TEST_DATA "/px4_gcs_flight.tlog";
    auto reader = TlogReader::open(source, test::golden_table());
    auto writer = created(dir / "copy.tlog", 1000);

    while (const auto record = reader->next()) ASSERT_TRUE(writer.write(record->time, record->frame).has_value());
    ASSERT_TRUE(writer.close().has_value());

    EXPECT_TRUE(content_of(dir / "copy.tlog") == content_of(source));
}

TEST(TlogWriter, MovesTimesThatTheFormatCannotSay) {
    const TempDir dir;
    auto writer = created(dir / "x.tlog");

    ASSERT_TRUE(writer.write(WallTime{std::chrono::seconds{-5}}, view(test::heartbeat_v2)).has_value());
    ASSERT_TRUE(writer.write(WallTime::max(), view(test::heartbeat_v2)).has_value());
    ASSERT_TRUE(writer.close().has_value());

    const auto content = content_of(dir / "x.tlog");
    EXPECT_EQ(load_be64(content.data()), 0u);
    EXPECT_EQ(load_be64(content.data() + 29), 9'007'199'254'740'991u);
}

TEST(TlogWriter, FlushShowsTheRecordsToOthers) {
    const TempDir dir;
    auto writer = created(dir / "x.tlog");
    ASSERT_TRUE(writer.write(heartbeat_time, view(test::heartbeat_v2)).has_value());
    EXPECT_EQ(content_of(dir / "x.tlog").size(), 0u);

    ASSERT_TRUE(writer.flush().has_value());

    EXPECT_EQ(content_of(dir / "x.tlog"), heartbeat_record);
    EXPECT_EQ(writer.buffered_bytes(), 0u);
}

TEST(TlogWriter, DestructionWritesWhatIsBuffered) {
    const TempDir dir;
    {
        auto writer = created(dir / "x.tlog");
        ASSERT_TRUE(writer.write(heartbeat_time, view(test::heartbeat_v2)).has_value());
    }

    EXPECT_EQ(content_of(dir / "x.tlog"), heartbeat_record);
}

TEST(TlogWriter, NeverOverwritesARecording) {
    const TempDir dir;
    for (const unsigned mark : {1u, 2u, 3u}) {
        auto writer = created(dir / "x.tlog");
        const auto expected = mark == 1 ? std::filesystem::path{} : dir / ("x.tlog." + std::to_string(mark - 1));
        EXPECT_EQ(writer.renamed_to(), expected);
        ASSERT_TRUE(writer.write(wall_from_us(mark), view(test::heartbeat_v2)).has_value());
        ASSERT_TRUE(writer.close().has_value());
    }

    EXPECT_EQ(content_of(dir / "x.tlog.1")[7], 1);
    EXPECT_EQ(content_of(dir / "x.tlog.2")[7], 2);
    EXPECT_EQ(content_of(dir / "x.tlog")[7], 3);
}

TEST(TlogWriter, LeavesAFileAloneThatIsNoRecording) {
    const TempDir dir;
    const test::Bytes program = test::hex("7f454c4602010100000000000000000003003e0001000000100b00000000000040");
    const test::Bytes stream = test::heartbeat_v2;  // frames without times
    const std::string text = "127.0.0.1 localhost\n";
    for (const test::Bytes& other : {program, stream, test::Bytes(text.begin(), text.end()), test::Bytes(3, 0xfd)}) {
        test::write_file(dir / "x", other);

        const auto refused = TlogWriter::create(dir / "x");

        ASSERT_FALSE(refused.has_value());
        EXPECT_EQ(refused.error().code, SetupCode::in_use);
        EXPECT_EQ(refused.error().text, (dir / "x").string() +
                                            " exists and is not a tlog recording, so it is left alone: "
                                            "choose another name, or move the file away");
        EXPECT_EQ(content_of(dir / "x"), other);
    }
}

TEST(TlogWriter, MovesDamagedRecordingsAway) {
    const TempDir dir;
    const test::Bytes whole = test::join({heartbeat_record, heartbeat_record});
    std::vector<test::Bytes> all{
        {}, test::Bytes(100, 0), test::join({test::Bytes(50, 0x55), whole}), test::join({whole, test::Bytes(9, 0x55)})};
    for (std::size_t cut = 1; cut <= whole.size(); ++cut) all.push_back(test::copy(ByteView(whole).first(cut)));
    int number = 0;
    for (const test::Bytes& damaged : all) {
        test::write_file(dir / "x.tlog", damaged);

        const auto writer = created(dir / "x.tlog");

        EXPECT_EQ(writer.renamed_to(), dir / ("x.tlog." + std::to_string(++number)));
        EXPECT_EQ(content_of(writer.renamed_to()), damaged);
    }
}

TEST(TlogWriter, AFullDiskIsAnErrorAtTheLatestAtClose) {
    auto writer = created("/dev/full");  // a device is not renamed
    ASSERT_TRUE(writer.write(heartbeat_time, view(test::heartbeat_v2)).has_value());

    const auto closed = writer.close();

    ASSERT_FALSE(closed.has_value());
    EXPECT_EQ(closed.error().code, SetupCode::no_space);
    EXPECT_EQ(closed.error().text, "cannot write /dev/full: No space left on device");
    EXPECT_EQ(writer.buffered_bytes(), 29u);
}

TEST(TlogWriter, AShortWriteIsCutBackToTheLastWholeRecordAndCanBeTriedAgain) {
    const TempDir dir;
    auto writer = created(dir / "x.tlog");
    for (int i = 0; i < 10; ++i) ASSERT_TRUE(writer.write(heartbeat_time, view(test::heartbeat_v2)).has_value());
    {
        const test::FileSizeLimit limit(100);  // three records of 29 bytes, and a piece of the fourth

        const auto flushed = writer.flush();

        ASSERT_FALSE(flushed.has_value());
        EXPECT_EQ(flushed.error().code, SetupCode::no_space);
        EXPECT_EQ(content_of(dir / "x.tlog").size(), 87u);
        EXPECT_EQ(writer.buffered_bytes(), 203u);
        EXPECT_EQ(writer.written_records(), 3u);
        EXPECT_EQ(writer.written_bytes(), 87u);
        EXPECT_EQ(writer.records(), 10u);
    }

    ASSERT_TRUE(writer.close().has_value());

    EXPECT_EQ(content_of(dir / "x.tlog").size(), 290u);
    auto reader = TlogReader::open(dir / "x.tlog", test::golden_table());
    int records = 0;
    while (reader->next()) ++records;
    EXPECT_EQ(records, 10);
    EXPECT_EQ(reader->counters().lost_bytes.value(), 0u);
}

TEST(TlogWriter, RefusesRecordsWhileItsBufferCannotBeWritten) {
    const TempDir dir;
    auto writer = created(dir / "x.tlog", 300);
    const test::FileSizeLimit limit(100);
    int taken = 0;
    while (writer.write(heartbeat_time, view(test::heartbeat_v2))) ++taken;

    EXPECT_EQ(taken, 10);  // three in the file, seven in the buffer: one try to write them, then no room
    EXPECT_FALSE(writer.close().has_value());
    EXPECT_EQ(content_of(dir / "x.tlog").size(), 87u);
    EXPECT_EQ(writer.written_records(), 3u);
}

TEST(TlogWriter, WritesToAPipe) {
    const TempDir dir;
    ASSERT_EQ(::mkfifo((dir / "pipe").c_str(), 0600), 0);
    std::vector<std::uint8_t> received;
    std::thread reader([&] { received = content_of(dir / "pipe"); });
    {
        auto writer = created(dir / "pipe");
        ASSERT_TRUE(writer.write(heartbeat_time, view(test::heartbeat_v2)).has_value());
        ASSERT_TRUE(writer.close().has_value());
    }
    reader.join();

    EXPECT_EQ(received, heartbeat_record);
}

TEST(TlogWriter, StatesWhyAFileCannotBeMade) {
    const TempDir dir;

    const auto no_folder = TlogWriter::create(dir / "none" / "x.tlog");
    const auto folder = TlogWriter::create(dir.path());

    ASSERT_FALSE(no_folder.has_value());
    EXPECT_EQ(no_folder.error().code, SetupCode::not_found);
    EXPECT_THAT(no_folder.error().text, testing::HasSubstr("x.tlog: No such file or directory"));
    ASSERT_FALSE(folder.has_value());
    EXPECT_THAT(folder.error().text, testing::HasSubstr("Is a directory"));
}

}  // namespace
}  // namespace mavloom::record
