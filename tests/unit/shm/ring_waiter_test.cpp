// SPDX-License-Identifier: MIT
#include "mavloom/shm/ring_waiter.hpp"

#include <gtest/gtest.h>

#include <array>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include "mavloom/shm/ring_info.hpp"
#include "mavloom/shm/ring_reader.hpp"
#include "mavloom/shm/ring_writer.hpp"
#include "support/ring_name.hpp"

namespace mavloom::shm {
namespace {

using namespace std::chrono_literals;
using test::RingName;

// A loop that sleeps on something of its own.
class Loop {
public:
    void wake() {
        const std::lock_guard lock(mutex_);
        ++wakes_;
        changed_.notify_all();
    }
    [[nodiscard]] bool woken_within(std::chrono::milliseconds limit) {
        std::unique_lock lock(mutex_);
        return changed_.wait_for(lock, limit, [this] { return std::exchange(wakes_, 0) != 0; });
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    int wakes_ = 0;
};

class RingWaiting : public ::testing::Test {
protected:
    RingWriter writer_of(const RingName& name) {
        auto writer = RingWriter::open(name.text(), {.capacity = 64 << 10});
        EXPECT_TRUE(writer);
        return std::move(*writer);
    }
    RingReader reader_of(const RingName& name) {
        auto reader = RingReader::open(name.text());
        EXPECT_TRUE(reader);
        return std::move(*reader);
    }
    static void write(RingWriter& writer) {
        constexpr std::uint8_t byte = 7;
        ASSERT_TRUE(writer.write({&byte, 1}, {}, mono_now() + 60s));
    }
    // As a loop does: asleep until told, or until the reader wants to look again.
    bool gets_record(RingReader& reader) {
        for (const auto limit = mono_now() + 60s; mono_now() < limit;) {
            if (reader.poll()) return true;
            waiter_.arm();
            if (const auto nap = reader.arm(); nap != Nanoseconds{})
                (void)loop_.woken_within(std::chrono::ceil<std::chrono::milliseconds>(nap));
        }
        return false;
    }

    RingName one_, two_;
    Loop loop_;
    RingWaiter waiter_{[this] { loop_.wake(); }};
};

// The nap after the first one is 100 ms: only the waiter can be what ends a wait of a minute.
TEST_F(RingWaiting, ReportsARecordThatIsWrittenWhileTheLoopSleeps) {
    auto writer = writer_of(one_);
    auto reader = reader_of(one_);
    waiter_.watch({reader.wake_word()});
    for (int i = 0; i < 50; ++i) {
        waiter_.arm();
        ASSERT_GT(reader.arm(), Nanoseconds{});
        while (reader.arm() <= 1ms)
            std::this_thread::sleep_for(100us);  // until the writer is sure to see that it sleeps
        write(writer);
        ASSERT_TRUE(loop_.woken_within(60s)) << "record " << i;
        ASSERT_TRUE(reader.poll());
    }
}

TEST_F(RingWaiting, ReportsAnyOfSeveralRings) {
    auto first = writer_of(one_), second = writer_of(two_);
    auto reader = reader_of(one_), other = reader_of(two_);
    waiter_.watch({reader.wake_word(), other.wake_word()});
    for (int i = 0; i < 20; ++i) {
        write(i % 2 == 0 ? first : second);
        ASSERT_TRUE(gets_record(i % 2 == 0 ? reader : other));
    }
}

TEST_F(RingWaiting, ArmedReaderLooksAgainAtOnceWhereARecordCameMeanwhile) {
    auto writer = writer_of(one_);
    auto reader = reader_of(one_);
    EXPECT_EQ(reader.poll().error(), ReadError::empty);
    write(writer);
    EXPECT_EQ(reader.arm(), Nanoseconds{});
    EXPECT_TRUE(reader.poll());
}

TEST_F(RingWaiting, DoesNothingUnlessArmed) {
    auto writer = writer_of(one_);
    auto reader = reader_of(one_), sleeper = reader_of(one_);
    waiter_.watch({reader.wake_word()});
    ASSERT_GT(reader.arm(), Nanoseconds{});
    write(writer);
    ASSERT_TRUE(gets_record(sleeper));
    EXPECT_FALSE(loop_.woken_within(0ms));
}

TEST_F(RingWaiting, ReportsWhenTheGivenTimeIsOver) {
    auto writer = writer_of(one_);
    auto reader = reader_of(one_);
    waiter_.watch({reader.wake_word()});
    waiter_.arm(10h);
    waiter_.arm(1ms);
    waiter_.arm(10h);  // the earliest counts
    EXPECT_TRUE(loop_.woken_within(60s));
    waiter_.arm(1ms);
    EXPECT_TRUE(loop_.woken_within(60s));
}

TEST_F(RingWaiting, OneWithoutASlotLooksAgainAtOnceToo) {
    auto writer = writer_of(one_);
    auto reader = RingReader::open(one_.text(), {.read_only = true});
    ASSERT_TRUE(reader);
    EXPECT_EQ(reader->arm(), 1ms);
    write(writer);
    EXPECT_EQ(reader->arm(), Nanoseconds{});
}

TEST_F(RingWaiting, ABatchEndsTheWishToBeWoken) {
    auto writer = writer_of(one_);
    auto reader = RingReader::open(one_.text(), {.lossless = true});
    ASSERT_TRUE(reader);
    const auto asleep = [&] { return ring_status(one_.text())->readers.at(0).asleep; };
    (void)reader->arm();
    EXPECT_FALSE(asleep()) << "the first nap is not asked for";
    std::this_thread::sleep_for(2ms);
    (void)reader->arm();
    ASSERT_TRUE(asleep());
    write(writer);
    std::array<RingRecord, 4> records;
    ASSERT_TRUE(reader->try_read_batch(records));
    EXPECT_FALSE(asleep());
    (void)reader->arm();
    EXPECT_FALSE(asleep()) << "the wait starts over";
    EXPECT_EQ(reader->try_read_batch({}).error(), ReadError::empty);
}

TEST_F(RingWaiting, KeepsARingMappedThatItsReaderHasLeft) {
    {
        auto writer = writer_of(one_);
        auto reader = reader_of(one_);
        waiter_.watch({reader.wake_word()});
    }
    auto writer = writer_of(two_);
    auto reader = reader_of(two_);
    waiter_.watch({reader.wake_word()});
    write(writer);
    EXPECT_TRUE(gets_record(reader));
}

TEST_F(RingWaiting, PollReportsAWriterThatWentAndOneThatCameBack) {
    auto reader = [&] {
        auto writer = writer_of(one_);
        auto opened = reader_of(one_);
        write(writer);
        return opened;
    }();
    EXPECT_TRUE(reader.poll());
    EXPECT_EQ(reader.poll().error(), ReadError::no_writer);
    waiter_.watch({reader.wake_word()});
    auto writer = writer_of(one_);
    write(writer);
    EXPECT_TRUE(gets_record(reader));
}

}  // namespace
}  // namespace mavloom::shm
