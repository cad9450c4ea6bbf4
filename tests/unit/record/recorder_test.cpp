// SPDX-License-Identifier: MIT
// A recorder over real files. Full disks: tests/system/route/test_route_faults.py.
#include "mavloom/record/recorder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <mutex>

#include "support/bytes.hpp"
#include "support/eventually.hpp"
#include "support/golden_frames.hpp"
#include "support/temp_dir.hpp"

namespace mavloom::record {
namespace {

using namespace std::chrono_literals;
using test::content_of;
using test::eventually;
using test::TempDir;

constexpr std::size_t bytes_of_record = 29;  // of a heartbeat

struct Recording {
    explicit Recording(const std::filesystem::path& path, Rotation rotation = {},
                       std::size_t buffer_bytes = Recorder::default_buffer_bytes) {
        const auto notice = [this](std::string_view text) {
            const std::lock_guard lock(mutex);
            notices += fmt::format("{}\n", text);
        };
        auto recorder = Recorder::create("tape", path, rotation, notice, buffer_bytes);
        if (!recorder) throw std::runtime_error(recorder.error().text);
        sut = std::move(*recorder);
    }
    void record(int count) const {
        for (int i = 0; i < count; ++i)
            sut->record(WallTime{}, LinkId{1}, wire::FrameView::unchecked(test::heartbeat_v2));
        sut->publish();
    }
    [[nodiscard]] bool reports(std::string_view text) {
        sut->maintain();
        const std::lock_guard lock(mutex);
        return notices.find(text) != std::string::npos;
    }

    std::mutex mutex;
    std::string notices;
    std::unique_ptr<Recorder> sut;
};

constexpr std::string_view waits = "counted as queue_full";

TEST(Recorder, WritesAndCountsWhatItGets) {
    const TempDir dir;
    Recording tape(dir / "x.tlog");
    tape.record(3);
    tape.sut->stop();

    EXPECT_EQ(content_of(dir / "x.tlog").size(), 3 * bytes_of_record);
    EXPECT_EQ(tape.sut->counters().frames.value(), 3u);
    EXPECT_EQ(tape.sut->counters().bytes.value(), 3 * test::heartbeat_v2.size());
    EXPECT_TRUE(tape.sut->finished());
}

class RecorderWithoutFolder : public testing::TestWithParam<Rotation> {};

// The writer itself buffers 256 KiB. The rest waits in the queue.
TEST_P(RecorderWithoutFolder, FramesWaitInTheQueue) {
    const TempDir dir;
    std::filesystem::create_directory(dir / "sub");
    Recording tape(dir / "sub/x.tlog", GetParam());
    std::filesystem::remove_all(dir / "sub");
    std::uint64_t sent = 0;  // the first ones go to the deleted file
    ASSERT_TRUE(eventually([&] {
        tape.record(1);
        ++sent;
        return tape.reports(waits);
    }));
    constexpr int many = 40'000;
    static_assert(many * bytes_of_record > 4 * TlogWriter::default_buffer_bytes);
    tape.record(many);
    std::filesystem::create_directory(dir / "sub");

    ASSERT_TRUE(eventually([&] { return tape.sut->counters().frames.value() == sent + many; }));
    tape.sut->stop();
    std::size_t bytes = 0;
    for (const auto& file : std::filesystem::directory_iterator(dir / "sub")) bytes += file.file_size();
    EXPECT_GE(bytes, many * bytes_of_record);
    EXPECT_EQ(tape.sut->counters().queue_full.value(), 0u);
    EXPECT_EQ(tape.sut->counters().write_error.value(), 0u);
    EXPECT_TRUE(tape.reports("records are written again"));
}

INSTANTIATE_TEST_SUITE_P(Rotation, RecorderWithoutFolder,
                         testing::Values(Rotation{}, Rotation{.every = 1h}, Rotation{.bytes = 100'000}));

TEST(Recorder, AFileThatWasDeletedIsReportedAtTheEnd) {
    const TempDir dir;
    Recording tape(dir / "x.tlog");
    std::filesystem::remove(dir / "x.tlog");
    tape.record(1);
    tape.sut->stop();

    EXPECT_TRUE(tape.notices.find("was removed or replaced") != std::string::npos) << tape.notices;
    EXPECT_EQ(content_of(dir / "x.tlog").size(), bytes_of_record);
}

TEST(Recorder, AFileThatWasDeletedAfterTheLastFrameIsReportedAtTheEnd) {
    const TempDir dir;
    Recording tape(dir / "x.tlog");
    tape.record(1);
    ASSERT_TRUE(eventually([&] { return tape.sut->counters().frames.value() == 1; }));
    std::filesystem::remove(dir / "x.tlog");
    tape.sut->stop();

    EXPECT_TRUE(tape.notices.find("was removed or replaced") != std::string::npos) << tape.notices;
}

TEST(Recorder, FramesThatNeverReachAFileAreCounted) {
    const TempDir dir;
    std::filesystem::create_directory(dir / "sub");
    Recording tape(dir / "sub/x.tlog", {}, 64 * 1024);
    std::filesystem::remove_all(dir / "sub");
    ASSERT_TRUE(eventually([&] { return tape.reports(waits); }));
    constexpr std::uint64_t frames = 40'000;
    tape.record(frames);
    tape.sut->stop();

    const auto& counters = tape.sut->counters();
    EXPECT_EQ(counters.frames.value(), 0u);
    EXPECT_GT(counters.queue_full.value(), 0u);
    EXPECT_EQ(counters.queue_full.value() + counters.write_error.value(), frames);
    EXPECT_TRUE(tape.reports("frames not written"));
    EXPECT_FALSE(tape.reports("written again"));
}

}  // namespace
}  // namespace mavloom::record
