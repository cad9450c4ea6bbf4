// SPDX-License-Identifier: MIT
#include "mavloom/shm/counter_page.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <thread>

#include "mavloom/shm/ring_info.hpp"
#include "mavloom/shm/ring_writer.hpp"
#include "support/ring_name.hpp"
#include "support/temp_dir.hpp"

namespace mavloom::shm {
namespace {

using test::RingName;
using ::testing::HasSubstr;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

CounterPage create(const RingName& name, const CounterPageOptions& options = {}) {
    auto page = CounterPage::create(name.text(), options);
    if (!page) throw std::runtime_error(page.error().text);
    return std::move(*page);
}

CounterSnapshot read(const RingName& name) {
    auto snapshot = read_counters(name.text());
    if (!snapshot) throw std::runtime_error(snapshot.error().text);
    return *snapshot;
}

TEST(CounterPage, RemovingNothingOrTwiceIsHarmless) {
    const RingName name;
    auto page = create(name, {.counters = 2});
    page.remove(nullptr);
    Counter* const counter = page.add("a");
    page.remove(counter);
    page.remove(counter);
    EXPECT_NE(page.add("b"), page.add("c"));
    EXPECT_EQ(page.add("d"), nullptr);
}

TEST(CounterPage, GivesLabelsTypesLinksAndValues) {
    const RingName name;
    auto page = create(name);
    page.add("frames")->add(41);
    page.add("queue_bytes", CounterType::gauge, LinkId{3})->set(7);
    page.add("heard", CounterType::time_ns)->set(1'700'000'000'000'000'000);
    EXPECT_TRUE(page.name_link(LinkId{3}, "udpin:127.0.0.1:14550"));

    const auto snapshot = read(name);
    EXPECT_TRUE(snapshot.owner_alive);
    EXPECT_EQ(snapshot.owner_pid, static_cast<std::uint32_t>(::getpid()));
    ASSERT_EQ(snapshot.counters.size(), 3u);
    EXPECT_EQ(snapshot.counters[0].label, "frames");
    EXPECT_EQ(snapshot.counters[0].type, CounterType::counter);
    EXPECT_EQ(snapshot.counters[0].link, std::nullopt);
    EXPECT_EQ(snapshot.counters[0].value, 41u);
    EXPECT_EQ(snapshot.counters[1].type, CounterType::gauge);
    EXPECT_EQ(snapshot.counters[1].link, LinkId{3});
    EXPECT_EQ(snapshot.counters[1].value, 7u);
    EXPECT_EQ(snapshot.counters[2].type, CounterType::time_ns);
    EXPECT_THAT(snapshot.links, UnorderedElementsAre(Pair(LinkId{3}, "udpin:127.0.0.1:14550")));
}

TEST(CounterPage, IsOfFixedSizeAndUsesSlotsAgain) {
    const RingName name;
    auto page = create(name, {.counters = 2, .links = 1});
    Counter* const first = page.add("first");
    ASSERT_NE(first, nullptr);
    ASSERT_NE(page.add("second"), nullptr);
    EXPECT_EQ(page.add("third"), nullptr);
    first->add(5);
    page.remove(first);
    EXPECT_EQ(read(name).counters.size(), 1u);
    Counter* const third = page.add("third");
    ASSERT_NE(third, nullptr);
    EXPECT_EQ(third->value(), 0u);
    EXPECT_TRUE(page.name_link(LinkId{1}, "a"));
    EXPECT_TRUE(page.name_link(LinkId{1}, "b")) << "another name for the same link";
    EXPECT_FALSE(page.name_link(LinkId{2}, "c"));
    page.forget_link(LinkId{1});
    EXPECT_TRUE(page.name_link(LinkId{2}, "c"));
    EXPECT_THAT(read(name).links, UnorderedElementsAre(Pair(LinkId{2}, "c")));
}

TEST(CounterPage, CutsWhatIsTooLong) {
    const RingName name;
    auto page = create(name);
    static_cast<void>(page.add(std::string(200, 'l')));
    page.name_link(LinkId{0}, std::string(200, 'n'));
    EXPECT_EQ(read(name).counters.at(0).label, std::string(96, 'l'));
    EXPECT_EQ(read(name).links.at(LinkId{0}), std::string(104, 'n'));
}

TEST(CounterPage, ALinkWithANameAlsoHasTheUrlThatItSendsTo) {
    const RingName name;
    auto page = create(name);
    const std::string url = "udpout://127.0.0.1:14550", fits(104 - 1 - url.size(), 'n'), full(104, 'n');
    page.name_link(LinkId{1}, "gcs", url);
    page.name_link(LinkId{2}, url);
    page.name_link(LinkId{3}, fits, url);
    page.name_link(LinkId{4}, fits + "n", url);
    page.name_link(LinkId{5}, full, url);
    page.name_link(LinkId{6}, "gcs", url);
    page.name_link(LinkId{6}, "tablet");
    const auto snapshot = read(name);
    EXPECT_THAT(snapshot.links,
                UnorderedElementsAre(Pair(LinkId{1}, "gcs"), Pair(LinkId{2}, url), Pair(LinkId{3}, fits),
                                     Pair(LinkId{4}, fits + "n"), Pair(LinkId{5}, full), Pair(LinkId{6}, "tablet")));
    EXPECT_THAT(snapshot.sends_to, UnorderedElementsAre(Pair(LinkId{1}, url), Pair(LinkId{3}, url)));
}

TEST(CounterPage, GoesWithItsOwner) {
    const RingName name;
    { auto page = create(name); }
    EXPECT_EQ(read_counters(name.text()).error().code, SetupCode::not_found);
}

TEST(CounterPage, OfAnotherUserIsReadOnRequestOnly) {
    if (::geteuid() != 0) GTEST_SKIP() << "giving files away needs root";
    const RingName name;
    const auto page = create(name);
    const std::string path = name.path() + ".stat";
    ASSERT_EQ(::chown(path.c_str(), 65534, 65534), 0);
    const auto refused = read_counters(name.text());
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, SetupCode::permission);
    EXPECT_THAT(refused.error().text, HasSubstr("so anything may be in it"));
    EXPECT_TRUE(read_counters(name.text(), {.user = 65534}));
    EXPECT_FALSE(read_counters(name.text(), {.user = 65533}));
    EXPECT_TRUE(read_counters(name.text(), {.foreign = true}));

    ASSERT_EQ(::chown(path.c_str(), ::geteuid(), ::getegid()), 0);
    ASSERT_EQ(::chmod(path.c_str(), 0660), 0);
    EXPECT_FALSE(read_counters(name.text()));
    EXPECT_TRUE(read_counters(name.text(), {.foreign = true}));
}

TEST(CounterPage, OfALivingOwnerIsRefusedAndOfADeadOneReplaced) {
    const RingName name;
    {
        auto page = create(name);
        const auto second = CounterPage::create(name.text());
        ASSERT_FALSE(second);
        EXPECT_EQ(second.error().code, SetupCode::in_use);
        EXPECT_THAT(second.error().text, HasSubstr("process " + std::to_string(::getpid())));
    }
    const pid_t child = ::fork();
    if (child == 0) {
        auto page = create(name);
        page.add("left")->add(1);
        ::kill(::getpid(), SIGKILL);
    }
    ::waitpid(child, nullptr, 0);
    EXPECT_FALSE(read(name).owner_alive);
    EXPECT_EQ(read(name).counters.at(0).value, 1u) << "what it counted can still be read";
    auto page = create(name);
    EXPECT_TRUE(read(name).counters.empty());
}

TEST(CounterPage, TheNextWriterOfARingRemovesWhatADeadOneLeft) {
    const RingName name;
    const pid_t child = ::fork();
    if (child == 0) {
        const auto writer = RingWriter::open(name.text(), {.capacity = 64 << 10});
        auto page = create(name);
        page.name_link(LinkId{1}, "radio");
        ::kill(::getpid(), SIGKILL);
    }
    ::waitpid(child, nullptr, 0);
    EXPECT_EQ(read(name).links.size(), 1u);
    const auto writer = RingWriter::open(name.text(), {.capacity = 64 << 10});
    EXPECT_EQ(read_counters(name.text()).error().code, SetupCode::not_found) << "its numbers mean other links";

    const RingName other;
    const auto page = create(other);
    ASSERT_TRUE(RingWriter::open(other.text(), {.capacity = 64 << 10}));
    EXPECT_TRUE(read(other).owner_alive) << "whose owner lives stays";
}

TEST(CounterPage, RemovalOfTheRingTakesItAlong) {
    const RingName name;
    const auto writer = RingWriter::open(name.text(), {.capacity = 64 << 10});
    auto page = create(name);
    ASSERT_TRUE(remove_ring(name.text()));
    EXPECT_NE(::access((name.path() + ".stat").c_str(), F_OK), 0);
    page.add("still mine")->add();
    const RingName alone;
    auto second = create(alone);
    EXPECT_TRUE(remove_ring(alone.text())) << "a page whose ring is gone";
}

TEST(CounterPage, DamagedFilesAreErrors) {
    const RingName name;
    const std::string path = name.path() + ".stat";
    auto page = create(name, {.counters = 4, .links = 4});
    static_cast<void>(page.add("x"));
    const auto good = test::content_of(path);
    const auto expect_error = [&](std::size_t offset, std::uint8_t byte, std::string_view text) {
        auto bytes = good;
        bytes[offset] = byte;
        const int fd = ::open(path.c_str(), O_RDWR);
        ASSERT_EQ(::pwrite(fd, bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
        ::close(fd);
        const auto snapshot = read_counters(name.text());
        ASSERT_FALSE(snapshot);
        EXPECT_EQ(snapshot.error().code, SetupCode::bad_input);
        EXPECT_THAT(snapshot.error().text, HasSubstr(text));
    };
    expect_error(0, 'X', "not a Mavloom counter page");
    expect_error(8, 3, "version 3.1");
    expect_error(12, 9, "byte order");
    expect_error(17, 9, "truncated");
    expect_error(23, 9, "truncated");
    auto newer = good;
    newer[10] = 9;  // a higher minor version only adds
    const int fd = ::open(path.c_str(), O_RDWR);
    ASSERT_EQ(::pwrite(fd, newer.data(), newer.size(), 0), static_cast<ssize_t>(newer.size()));
    ::close(fd);
    EXPECT_EQ(read(name).counters.at(0).label, "x");
}

TEST(CounterPage, AReaderNeverSeesALabelOfTwoCounters) {
    const RingName name;
    auto page = create(name, {.counters = 1, .links = 1});
    std::atomic<bool> stop{false};
    std::thread reader([&] {
        while (!stop) {
            const auto snapshot = read_counters(name.text());
            ASSERT_TRUE(snapshot);
            for (const auto& counter : snapshot->counters)
                ASSERT_EQ(counter.label, std::string(counter.label.size(), counter.label.at(0)));
        }
    });
    for (int i = 0; i < 3000; ++i) page.remove(page.add(std::string(1 + i % 96, static_cast<char>('a' + i % 26))));
    stop = true;
    reader.join();
}

}  // namespace
}  // namespace mavloom::shm
