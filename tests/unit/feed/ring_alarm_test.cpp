// SPDX-License-Identifier: MIT
#include "mavloom/feed/ring_alarm.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "mavloom/shm/ring_reader.hpp"
#include "mavloom/shm/ring_writer.hpp"
#include "support/ring_name.hpp"
#include "unit/feed/fixture.hpp"

namespace mavloom::feed {
namespace {

using namespace testing;

// A ring, and a reader with its alarm. The reader belongs to the thread that holds the mutex, as in a program.
class AlarmedRing {
public:
    explicit AlarmedRing(const test::RingName& name)
        : writer_(*shm::RingWriter::open(name.text(), {.capacity = shm::min_capacity})),
          reader_(*shm::RingReader::open(name.text())),
          alarm_(*RingAlarm::make(reader_.wake_word(), [this] { return sleep_time(); })) {}

    void write(std::uint8_t byte = 1) {
        ASSERT_TRUE(writer_.write({&byte, 1}, {}, mono_now() + long_enough));
        writer_.flush();
    }
    [[nodiscard]] bool read() {
        const std::lock_guard lock(mutex_);
        return reader_.try_read().has_value();
    }
    [[nodiscard]] RingAlarm& alarm() { return *alarm_; }
    [[nodiscard]] int fd() const { return alarm_->fd(); }
    [[nodiscard]] int asked() const { return asked_; }
    void destroy_alarm() { alarm_.reset(); }

private:
    Nanoseconds sleep_time() {
        ++asked_;
        const std::unique_lock lock(mutex_, std::try_to_lock);
        return lock.owns_lock() ? reader_.arm() : Nanoseconds{1ms};
    }
    shm::RingWriter writer_;
    std::mutex mutex_;
    shm::RingReader reader_;
    std::atomic<int> asked_{0};
    std::unique_ptr<RingAlarm> alarm_;
};

struct RingAlarmTest : ::testing::Test {
    // As a loop does: asleep on the descriptor until there is a record.
    static bool gets_record(AlarmedRing& ring) {
        for (const auto limit = mono_now() + long_enough; mono_now() < limit;) {
            if (ring.read()) return true;
            read_count(ring.fd());
            ring.alarm().arm();
            if (!is_readable(ring.fd(), long_enough)) return false;
        }
        return false;
    }
    test::RingName name;
};

TEST_F(RingAlarmTest, ItIsReadableFromTheStartSoThatTheFirstLookIsMade) {
    AlarmedRing ring(name);
    EXPECT_EQ(read_count(ring.fd()), 1u);
}

TEST_F(RingAlarmTest, NotifiesOnceForEachArmingAndNeverUnlessArmed) {
    AlarmedRing ring(name);
    read_count(ring.fd());
    ring.write();
    EXPECT_FALSE(is_readable(ring.fd()));  // nobody armed it

    ring.alarm().arm();  // something waits already
    EXPECT_EQ(read_count(ring.fd()), 1u);
    ring.write();
    ring.write();
    EXPECT_FALSE(is_readable(ring.fd()));

    while (ring.read()) continue;
    ring.alarm().arm();
    EXPECT_FALSE(is_readable(ring.fd()));
    ring.write();
    EXPECT_TRUE(is_readable(ring.fd(), long_enough));
    for (int i = 0; i < 10; ++i) ring.write();
    // The alarm thread may finish with the ring before this returns, or later. It must not signal again.
    ring.alarm().signal();
    EXPECT_EQ(read_count(ring.fd()), 2u);
}

TEST_F(RingAlarmTest, ArmingTwiceSignalsOnce) {
    AlarmedRing ring(name);
    read_count(ring.fd());
    ring.alarm().arm();
    ring.alarm().arm();
    ring.write();
    ASSERT_TRUE(is_readable(ring.fd(), long_enough));
    EXPECT_EQ(read_count(ring.fd()), 1u);
}

TEST_F(RingAlarmTest, NoRecordIsSleptThroughWhileAThreadWrites) {
    AlarmedRing ring(name);
    constexpr int records = 300;
    std::thread writing([&] {
        for (int i = 0; i < records; ++i) {
            ring.write();
            if (i % 7 == 0) std::this_thread::yield();
        }
    });
    for (int i = 0; i < records; ++i) ASSERT_TRUE(gets_record(ring));
    writing.join();
}

TEST_F(RingAlarmTest, OneThreadServesManyRingsThatComeAndGo) {
    test::RingName names[5];
    std::vector<std::thread> users;
    for (auto& own : names)
        users.emplace_back([&] {
            for (int round = 0; round < 10; ++round) {
                AlarmedRing ring(own);
                std::thread writing([&] {
                    for (int i = 0; i < 10; ++i) ring.write();
                });
                for (int i = 0; i < 10; ++i) EXPECT_TRUE(gets_record(ring));
                writing.join();
            }
        });
    for (auto& user : users) user.join();
}

// Its `sleep_time` refers to a reader that may end next.
TEST_F(RingAlarmTest, ADestroyedAlarmIsAskedNoMore) {
    AlarmedRing ring(name);
    test::RingName other_name;
    AlarmedRing other(other_name);
    ring.alarm().arm();
    ring.destroy_alarm();
    const int asked = ring.asked();
    ring.write();
    other.write();
    EXPECT_TRUE(gets_record(other));
    EXPECT_EQ(ring.asked(), asked);
}

// In the child the parent's alarm has no thread, and its descriptor is the parent's too.
TEST_F(RingAlarmTest, AForkedChildLeavesTheParentsAlarmAlone) {
    AlarmedRing ring(name);
    read_count(ring.fd());
    const pid_t child = ::fork();
    if (child == 0) {
        ring.alarm().arm();
        ring.alarm().signal();
        const bool is_signalled = is_readable(ring.fd());
        ring.destroy_alarm();
        ::_exit(is_signalled ? 1 : 0);
    }
    int status = -1;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
    EXPECT_FALSE(is_readable(ring.fd()));
    ring.write();
    EXPECT_TRUE(gets_record(ring));
}

// For good: it belongs to the end of a process. So it has a process of its own.
TEST_F(RingAlarmTest, AfterTheEndEveryArmedAlarmIsReadableAtOnce) {
    const auto end = [&] {
        AlarmedRing ring(name);
        read_count(ring.fd());
        ring.alarm().arm();
        RingAlarm::stop_all();
        const bool is_signalled = read_count(ring.fd()) == 1;
        ring.alarm().arm();
        const bool is_signalled_again = read_count(ring.fd()) == 1;
        RingAlarm::stop_all();
        ::unlink(name.path().c_str());  // _exit runs no destructor
        ::_exit(is_signalled && is_signalled_again ? 0 : 1);
    };
    ::testing::GTEST_FLAG(death_test_style) = "threadsafe";
    EXPECT_EXIT(end(), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace mavloom::feed
