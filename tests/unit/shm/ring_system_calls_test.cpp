// SPDX-License-Identifier: MIT
// The system calls by which rings are made and locked, defined here once more for this program: they count, and end the
// process where a test asks for it.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "mavloom/shm/ring_info.hpp"
#include "mavloom/shm/ring_reader.hpp"
#include "mavloom/shm/ring_writer.hpp"
#include "support/ring_name.hpp"

namespace {

std::atomic<std::uint64_t> locks_asked{0};
std::atomic<std::uint64_t> steps_left{std::numeric_limits<std::uint64_t>::max()};

// Before and behind each call.
void step() {
    if (steps_left.fetch_sub(1, std::memory_order_relaxed) == 0) ::kill(::getpid(), SIGKILL);
}

template <class... Arguments>
int call(long number, Arguments... arguments) {
    step();
    const auto result = static_cast<int>(::syscall(number, arguments...));
    step();
    return result;
}

}  // namespace

extern "C" {

int fcntl(int fd, int command, ...) {
    va_list arguments;
    va_start(arguments, command);
    void* const argument = va_arg(arguments, void*);
    va_end(arguments);
    if (command == F_OFD_SETLK) ++locks_asked;
    return call(SYS_fcntl, fd, command, argument);
}

int posix_fallocate(int fd, off_t offset, off_t length) {
    return call(SYS_fallocate, fd, 0, offset, length) == 0 ? 0 : errno;
}

int fchmod(int fd, mode_t mode) noexcept { return call(SYS_fchmod, fd, mode); }

int linkat(int from, const char* old_name, int to, const char* new_name, int flags) noexcept {
    return call(SYS_linkat, from, old_name, to, new_name, flags);
}

}  // extern "C"

namespace mavloom::shm {
namespace {

using namespace std::chrono_literals;
using test::RingName;

constexpr std::uint64_t small_ring = 64 << 10;

// Names of files that begin with the ring's, whatever they are.
std::vector<std::string> files_of(const RingName& name) {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator("/dev/shm"))
        if (entry.path().filename().string().find(name.text()) != std::string::npos) files.push_back(entry.path());
    return files;
}

// Whether the ring was made and nothing was left to do.
bool make_and_be_killed(const RingName& name, std::uint64_t step) {
    const pid_t child = ::fork();
    if (child == 0) {
        steps_left = step;
        const auto writer = RingWriter::open(name.text(), {.capacity = small_ring});
        ::_exit(writer ? 0 : 1);
    }
    int status = 0;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    if (WIFSIGNALED(status)) return false;
    EXPECT_EQ(WEXITSTATUS(status), 0);
    return true;
}

TEST(RingCreation, AMakerKilledAtAnyStepLeavesNothingOrAWholeRing) {
    std::uint64_t step = 0, absent = 0;
    for (;; ++step) {
        const RingName name;
        const bool is_done = make_and_be_killed(name, step);
        const auto reader = RingReader::open(name.text());
        if (!reader) {
            ++absent;
            EXPECT_EQ(reader.error().code, SetupCode::not_found) << reader.error().text;
            EXPECT_EQ(files_of(name), std::vector<std::string>{}) << "step " << step;
        }
        auto writer = RingWriter::open(name.text(), {.capacity = small_ring});
        ASSERT_TRUE(writer) << "step " << step << ": " << writer.error().text;
        ASSERT_TRUE(writer->write(std::vector<std::uint8_t>(5), {}));
        auto first = RingReader::open(name.text(), {.from = ReaderOptions::From::oldest});
        ASSERT_TRUE(first);
        EXPECT_EQ(first->try_read()->sequence, 0u);
        EXPECT_EQ(files_of(name), std::vector{name.path()});
        if (is_done) break;
    }
    EXPECT_GE(absent, 7u) << "before and behind what gives space, mode and lock, and before the name";
    EXPECT_GT(step, absent) << "killed behind linkat(), the ring is there";
}

// A full ring may be written to a million times a second.
TEST(RingLocks, AFullRingAsksForLocksOnceAMillisecondAtMost) {
    const RingName name;
    auto writer = RingWriter::open(name.text(), {.capacity = small_ring, .when_full = WhenFull::drop_newest});
    ASSERT_TRUE(writer);
    const auto reader = RingReader::open(name.text(), {.lossless = true});
    ASSERT_TRUE(reader);
    const std::vector<std::uint8_t> data(1000);
    const MonoTime begin = mono_now();
    const std::uint64_t before = locks_asked;
    for (int i = 0; i < 100'000; ++i) static_cast<void>(writer->write(data, {}));
    const auto asked = locks_asked - before;
    const auto passed = std::chrono::duration_cast<std::chrono::milliseconds>(mono_now() - begin);
    EXPECT_EQ(writer->records(), 64u);
    EXPECT_GE(asked, 1u);
    EXPECT_LE(asked, static_cast<std::uint64_t>(passed.count()) + 1);
}

TEST(RingLocks, AFullRingThatDropsTheNewestIsFreeOfADeadReaderSoonAfterItsDeath) {
    const RingName name;
    auto writer = RingWriter::open(name.text(), {.capacity = small_ring, .when_full = WhenFull::drop_newest});
    ASSERT_TRUE(writer);
    const pid_t child = ::fork();
    if (child == 0) {
        const auto reader = RingReader::open(name.text(), {.lossless = true});
        ::raise(SIGSTOP);
        ::_exit(1);
    }
    ASSERT_EQ(::waitpid(child, nullptr, WUNTRACED), child);
    const std::vector<std::uint8_t> data(1000);
    while (writer->write(data, {})) continue;
    ::kill(child, SIGKILL);
    ASSERT_EQ(::waitpid(child, nullptr, 0), child);
    const MonoTime death = mono_now(), give_up = death + 1min;
    while (!writer->write(data, {}) && mono_now() < give_up) continue;
    EXPECT_LT(mono_now(), give_up);
    for (int i = 0; i < 200; ++i) ASSERT_TRUE(writer->write(data, {}));
}

}  // namespace
}  // namespace mavloom::shm
