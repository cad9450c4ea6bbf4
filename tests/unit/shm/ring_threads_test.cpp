// SPDX-License-Identifier: MIT
// Threads that share one mapping, so that the thread sanitizer sees both sides (two mappings of one file are two places
// to it). Judged by what was read, never by speed.
#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "mavloom/shm/detail/consumer.hpp"
#include "mavloom/shm/detail/producer.hpp"

namespace mavloom::shm {
namespace {

using ThreadProducer = detail::Producer<SharedWords>;
using ThreadConsumer = detail::Consumer<SharedWords>;

constexpr std::uint64_t thread_capacity = 4096;
constexpr std::uint64_t records = 50'000;

struct ThreadRing {
    RingControl<SharedWords> control{};
    ReaderSlot<SharedWords> slots[reader_slots]{};
    SharedWords::Word64 data[thread_capacity / 8]{};
    [[nodiscard]] RingMemory<SharedWords> memory() { return {&control, slots, data, thread_capacity}; }
};

std::vector<std::uint8_t> thread_content_of(std::uint64_t sequence) {
    std::vector<std::uint8_t> bytes(sequence * 31 % 200);
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(sequence * 7 + i);
    return bytes;
}

// Until the last record; gives how many were missed, nothing where a record was wrong.
std::optional<std::uint64_t> read_to_the_end(ThreadConsumer& consumer) {
    std::uint64_t next = consumer.sequence(), missed = 0;
    RingRecord record;
    while (next < records) {
        const auto found = consumer.next(record);
        if (found == ThreadConsumer::Found::damaged) return std::nullopt;
        if (found == ThreadConsumer::Found::empty) {
            consumer.sleep(std::chrono::milliseconds(1));
            continue;
        }
        const auto expected = thread_content_of(record.sequence);
        if (record.sequence != next + record.missed || record.info.link.value != record.sequence) return std::nullopt;
        if (!std::equal(expected.begin(), expected.end(), record.data.begin(), record.data.end())) return std::nullopt;
        missed += record.missed;
        next = record.sequence + 1;
    }
    consumer.release();
    consumer.publish();
    return missed;
}

void write_all(ThreadProducer& producer, bool by_claim) {
    for (std::uint64_t n = 0; n < records; ++n) {
        const auto content = thread_content_of(n);
        while (producer.claim(content.size()) == ThreadProducer::Room::held) {
            producer.wake_readers();
            producer.sleep_for_room(content.size(), std::chrono::milliseconds(10));
        }
        if (!by_claim) producer.store_payload(content);
        else if (!content.empty()) std::memcpy(producer.payload(), content.data(), content.size());
        producer.commit({{}, LinkId{static_cast<std::uint32_t>(n)}, 0, 0}, content.size());
    }
}

TEST(RingThreads, LossyReadersBesideAWriterThatNeverWaits) {
    const auto ring = std::make_unique<ThreadRing>();
    ThreadProducer producer(ring->memory());
    ASSERT_TRUE(producer.recover());
    ThreadConsumer first(ring->memory(), 0, false), second(ring->memory(), std::nullopt, false);
    ASSERT_TRUE(first.start(ThreadConsumer::Start::oldest) && second.start(ThreadConsumer::Start::oldest));
    std::optional<std::uint64_t> missed;
    std::thread reader([&] { missed = read_to_the_end(second); });
    std::thread writer([&] { write_all(producer, false); });
    EXPECT_TRUE(read_to_the_end(first));
    reader.join();
    writer.join();
    EXPECT_TRUE(missed);
    EXPECT_EQ(producer.records(), records);
}

TEST(RingThreads, LosslessReadersOfRecordsThatAreFilledInPlace) {
    const auto ring = std::make_unique<ThreadRing>();
    ThreadProducer producer(ring->memory());
    ASSERT_TRUE(producer.recover());
    ThreadConsumer first(ring->memory(), 3, true), second(ring->memory(), 63, true);
    ASSERT_TRUE(first.start(ThreadConsumer::Start::oldest) && second.start(ThreadConsumer::Start::oldest));
    std::optional<std::uint64_t> missed;
    std::thread reader([&] { missed = read_to_the_end(second); });
    std::thread writer([&] { write_all(producer, true); });
    EXPECT_EQ(read_to_the_end(first), 0u);
    reader.join();
    writer.join();
    EXPECT_EQ(missed, 0u);
}

TEST(RingThreads, LosslessReadersComeAndGo) {
    const auto ring = std::make_unique<ThreadRing>();
    ThreadProducer producer(ring->memory());
    ASSERT_TRUE(producer.recover());
    std::atomic<bool> done{false}, good{true};
    std::thread comer([&] {
        while (!done) {
            ThreadConsumer consumer(ring->memory(), 9, true);
            RingRecord record;
            if (!consumer.start(ThreadConsumer::Start::newest)) good = false;
            for (int i = 0; i < 20; ++i) {
                if (consumer.next(record) != ThreadConsumer::Found::record) continue;
                const auto expected = thread_content_of(record.sequence);
                if (record.missed != 0 ||
                    !std::equal(expected.begin(), expected.end(), record.data.begin(), record.data.end()))
                    good = false;
            }
            consumer.release();
            consumer.publish();
            ring->control.holders.fetch_and(~(std::uint64_t{1} << 9), std::memory_order_release);
        }
    });
    write_all(producer, false);
    done = true;
    comer.join();
    EXPECT_TRUE(good);
}

}  // namespace
}  // namespace mavloom::shm
