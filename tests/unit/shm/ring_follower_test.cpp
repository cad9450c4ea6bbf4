// SPDX-License-Identifier: MIT
#include "mavloom/shm/ring_follower.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <string>
#include <string_view>

#include "mavloom/shm/ring_info.hpp"
#include "mavloom/shm/ring_writer.hpp"
#include "support/ring_name.hpp"
#include "support/temp_dir.hpp"

namespace mavloom::shm {
namespace {

using namespace std::chrono_literals;
using test::RingName;

RingWriter open_followed(const RingName& name, std::uint64_t capacity = 64 << 10) {
    auto writer = RingWriter::open(name.text(), {.capacity = capacity});
    if (!writer) throw std::runtime_error(writer.error().text);
    return std::move(*writer);
}

void write_followed(RingWriter& writer, std::string_view text) {
    ASSERT_TRUE(writer.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, {}, mono_now() + 60s));
}

std::string read(RingFollower& follower) {
    const auto record = follower.read(mono_now() + 60s);
    if (!record) return std::string("error: ").append(to_text(record.error()));
    return {reinterpret_cast<const char*>(record->data.data()), record->data.size()};
}

class RingFollowing : public ::testing::TestWithParam<bool> {
protected:
    RingName name_;
    RingFollower follower_{name_.text(), {.lossless = GetParam(), .from = ReaderOptions::From::oldest}};
};
INSTANTIATE_TEST_SUITE_P(Ring, RingFollowing, ::testing::Bool());

TEST_P(RingFollowing, WaitsForARingThatIsNotThereYet) {
    EXPECT_FALSE(follower_.try_open());
    ASSERT_NE(follower_.error(), nullptr);
    EXPECT_EQ(follower_.error()->code, SetupCode::not_found);
    EXPECT_EQ(follower_.read(mono_now() + 1ms).error(), ReadError::no_writer);
    auto writer = open_followed(name_);
    write_followed(writer, "first");
    EXPECT_EQ(read(follower_), "first");
    EXPECT_EQ(follower_.error(), nullptr);
    EXPECT_EQ(follower_.read(mono_now()).error(), ReadError::empty);
}

TEST_P(RingFollowing, CarriesOnWithTheNextWriterOfTheSameRing) {
    {
        auto writer = open_followed(name_);
        write_followed(writer, "one");
    }
    EXPECT_EQ(read(follower_), "one");
    EXPECT_EQ(follower_.read(mono_now() + 1ms).error(), ReadError::no_writer);
    auto writer = open_followed(name_);
    write_followed(writer, "two");
    EXPECT_EQ(read(follower_), "two");
    EXPECT_EQ(follower_.opened(), 1u);
}

TEST_P(RingFollowing, DrainsARemovedRingAndContinuesWithTheNext) {
    auto writer = open_followed(name_);
    ASSERT_TRUE(follower_.try_open());
    write_followed(writer, "old 1");
    write_followed(writer, "old 2");
    ASSERT_TRUE(writer.close(RingWriter::Leave::nothing));
    auto next = open_followed(name_);
    write_followed(next, "new");
    EXPECT_EQ(read(follower_), "old 1");
    EXPECT_EQ(read(follower_), "old 2");
    EXPECT_EQ(read(follower_), "new");
    EXPECT_EQ(follower_.opened(), 2u);
}

TEST_P(RingFollowing, ContinuesWithARingOfAnotherCapacity) {
    {
        auto writer = open_followed(name_);
        write_followed(writer, "small");
    }
    EXPECT_EQ(read(follower_), "small");
    auto writer = open_followed(name_, 128 << 10);
    write_followed(writer, "large");
    EXPECT_EQ(read(follower_), "large");
}

TEST_P(RingFollowing, SurvivesANameTakenAwayByHand) {
    {
        auto writer = open_followed(name_);
        write_followed(writer, "one");
    }
    EXPECT_EQ(read(follower_), "one");
    ::unlink(name_.path().c_str());
    EXPECT_EQ(follower_.read(mono_now() + 1ms).error(), ReadError::no_writer);
    EXPECT_FALSE(follower_.is_open());
    auto writer = open_followed(name_);
    write_followed(writer, "two");
    EXPECT_EQ(read(follower_), "two");
}

TEST_P(RingFollowing, ReadsARetiredRingThatKeepsItsNameOnce) {
    {
        auto writer = open_followed(name_);
        write_followed(writer, "one");
        write_followed(writer, "two");
    }
    const int fd = ::open(name_.path().c_str(), O_RDWR);
    const std::uint32_t retired = 1;
    ASSERT_EQ(::pwrite(fd, &retired, sizeof retired, 396), static_cast<ssize_t>(sizeof retired));
    ::close(fd);
    EXPECT_EQ(read(follower_), "one");
    EXPECT_EQ(read(follower_), "two");
    EXPECT_EQ(follower_.read(mono_now() + 50ms).error(), ReadError::no_writer);
    EXPECT_EQ(follower_.opened(), 1u);
    auto writer = open_followed(name_);
    write_followed(writer, "three");
    EXPECT_EQ(read(follower_), "three");
    EXPECT_EQ(follower_.opened(), 2u);
}

TEST_P(RingFollowing, StatesWhyWhatIsThereCannotBeRead) {
    test::write_file(name_.path(), std::vector<std::uint8_t>(20'000, 'x'));
    EXPECT_EQ(follower_.read(mono_now() + 1ms).error(), ReadError::no_writer);
    ASSERT_NE(follower_.error(), nullptr);
    EXPECT_EQ(follower_.error()->code, SetupCode::bad_input);
}

}  // namespace
}  // namespace mavloom::shm
