// SPDX-License-Identifier: MIT
#include "mavloom/message/view.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/message/sample_messages.hpp"

namespace mavloom::message {
namespace {

using namespace mavloom::testing;  // NOLINT: the sample definitions

TEST(MessageView, ReadsFieldsInTheirTypes) {
    const auto payload = bytes_of(std::uint32_t{12345}, 0.5f, -0.25f, 3.0f, 0.0f, 0.0f, -1.5f);
    const MessageView sut(attitude, payload);

    EXPECT_EQ(sut.get<std::uint32_t>(attitude_fields[0]), 12345u);
    EXPECT_EQ(sut.get<float>(attitude_fields[1]), 0.5f);
    EXPECT_EQ(sut.get<float>(attitude_fields[6]), -1.5f);
    EXPECT_EQ(sut.number(attitude_fields[2]), -0.25);
    EXPECT_EQ(sut.integer(attitude_fields[0]), 12345);
    EXPECT_EQ(sut.unsigned_integer(attitude_fields[0]), 12345u);
}

TEST(MessageView, ReadsCutBytesAsZero) {
    const auto full = bytes_of(std::uint32_t{0x04030201}, 0.5f, -0.25f, 3.0f, 1.0f, 1.0f, -1.5f);
    for (std::size_t length = 0; length <= full.size(); ++length) {
        auto extended = full;
        std::fill(extended.begin() + static_cast<std::ptrdiff_t>(length), extended.end(), std::uint8_t{0});

        const MessageView sut(attitude, ByteView(full).first(length));

        EXPECT_EQ(sut.get<std::uint32_t>(attitude_fields[0]), load_le<std::uint32_t>(extended.data()));
        for (std::size_t i = 1; i < 7; ++i)
            EXPECT_EQ(sut.get<float>(attitude_fields[i]), load_le<float>(extended.data() + 4 * i))
                << i << " at " << length;
    }
}

TEST(MessageView, ReadsIntegersOfEverySignAndWidth) {
    std::vector<std::uint8_t> payload(61, 0xff);
    const MessageView sut(sample, payload);

    EXPECT_EQ(sut.unsigned_integer(sample_fields[0]), 18446744073709551615u);
    EXPECT_EQ(sut.integer(sample_fields[1]), -1);
    EXPECT_EQ(sut.integer(sample_fields[3]), -1);
    EXPECT_EQ(sut.integer(sample_fields[4], 2), -1);
    EXPECT_EQ(sut.integer(sample_fields[5]), 65535);
    EXPECT_EQ(sut.integer(sample_fields[7]), -1);
    EXPECT_EQ(sut.number(sample_fields[7]), -1.0);
    EXPECT_EQ(sut.integer(sample_fields[8]), 255);
}

TEST(MessageView, FloatsAsIntegersStayWithinBounds) {
    const auto integer_of = [](double value) {
        const auto payload = bytes_of(std::uint64_t{0}, std::int64_t{0}, value);
        return MessageView(sample, payload).integer(sample_fields[2]);
    };
    EXPECT_EQ(integer_of(-2.75), -2);
    EXPECT_EQ(integer_of(1e300), std::numeric_limits<std::int64_t>::max());
    EXPECT_EQ(integer_of(-1e300), std::numeric_limits<std::int64_t>::min());
    EXPECT_EQ(integer_of(std::nan("")), 0);
    EXPECT_EQ(integer_of(9223372036854775808.0), std::numeric_limits<std::int64_t>::max());
    const auto negative = bytes_of(std::uint64_t{0}, std::int64_t{0}, -5.0);
    EXPECT_EQ(MessageView(sample, negative).unsigned_integer(sample_fields[2]), 0u);
}

TEST(MessageView, TextEndsAtItsTrailingNuls) {
    const auto text_of = [](std::string_view text, std::size_t size) {
        const auto payload = statustext_payload(6, text, size);
        return std::string(MessageView(statustext, payload).text(statustext_fields[1]));
    };
    EXPECT_EQ(text_of("armed", 51), "armed");
    EXPECT_EQ(text_of("armed", 6), "armed");
    EXPECT_EQ(text_of("arm", 3), "ar");
    EXPECT_EQ(text_of("", 1), "");
    EXPECT_EQ(text_of(std::string_view("a\0b\0", 4), 51), std::string("a\0b", 3));
    EXPECT_EQ(text_of(std::string(50, 'x'), 54), std::string(50, 'x'));
}

}  // namespace
}  // namespace mavloom::message
