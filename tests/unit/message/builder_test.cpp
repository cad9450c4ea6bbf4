// SPDX-License-Identifier: MIT
#include "mavloom/message/builder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "mavloom/message/view.hpp"
#include "unit/message/sample_messages.hpp"

namespace mavloom::message {
namespace {

using namespace mavloom::testing;  // NOLINT: the sample definitions
using ::testing::HasSubstr;

const Field& field(const Message& message, std::string_view name) {
    for (const auto& f : message.fields)
        if (f.name == name) return f;
    ADD_FAILURE() << "no field " << name;
    return message.fields.front();
}

std::string error_of(const SetupResult<void>& result) { return result ? "no error" : result.error().text; }

TEST(MessageBuilder, StartsWithZeros) {
    const MessageBuilder sut(attitude);
    EXPECT_EQ(sut.payload().size(), 28u);
    for (const auto byte : sut.payload()) EXPECT_EQ(byte, 0);
}

TEST(MessageBuilder, KeepsAReceivedPayloadAndFillsWhatWasCut) {
    const auto full = bytes_of(std::uint32_t{0x04030201}, 0.5f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 9.0f);
    for (std::size_t length = 0; length <= full.size(); ++length) {
        const MessageBuilder sut(attitude, ByteView(full).first(length));
        ASSERT_EQ(sut.payload().size(), 28u);
        for (std::size_t i = 0; i < 28; ++i) ASSERT_EQ(sut.payload()[i], i < length ? full[i] : 0);
    }
}

TEST(MessageBuilder, WritesLittleEndianAtTheFieldsOffset) {
    MessageBuilder sut(heartbeat);
    sut.put(field(heartbeat, "custom_mode"), std::uint32_t{0x01020304});
    ASSERT_TRUE(sut.set_integer(field(heartbeat, "type"), 2));

    EXPECT_EQ(sut.payload()[0], 4);
    EXPECT_EQ(sut.payload()[3], 1);
    EXPECT_EQ(sut.payload()[4], 2);
}

TEST(MessageBuilder, RefusesIntegersOutOfRange) {
    MessageBuilder sut(sample);
    EXPECT_TRUE(sut.set_integer(field(sample, "i8"), -128));
    EXPECT_TRUE(sut.set_integer(field(sample, "i8"), 127));
    EXPECT_EQ(error_of(sut.set_integer(field(sample, "i8"), 128)), "SAMPLE.i8: 128 is out of range, -128 to 127");
    EXPECT_EQ(error_of(sut.set_integer(field(sample, "i8"), -129)), "SAMPLE.i8: -129 is out of range, -128 to 127");
    EXPECT_EQ(error_of(sut.set_integer(field(sample, "eph"), -1)), "SAMPLE.eph: -1 is out of range, 0 to 65535");
    EXPECT_EQ(error_of(sut.set_unsigned(field(sample, "i64"), 9223372036854775808u)),
              "SAMPLE.i64: 9223372036854775808 is out of range, -9223372036854775808 to 9223372036854775807");
    EXPECT_TRUE(sut.set_integer(field(sample, "i64"), std::numeric_limits<std::int64_t>::min()));
    EXPECT_TRUE(sut.set_unsigned(field(sample, "u64"), std::numeric_limits<std::uint64_t>::max()));
    const MessageView view(sample, sut.payload());
    EXPECT_EQ(view.integer(field(sample, "i64")), std::numeric_limits<std::int64_t>::min());
    EXPECT_EQ(view.unsigned_integer(field(sample, "u64")), std::numeric_limits<std::uint64_t>::max());
    EXPECT_EQ(view.integer(field(sample, "i8")), 127);
}

TEST(MessageBuilder, RefusesNumbersThatAreNotWholeOrTooLarge) {
    MessageBuilder sut(sample);
    EXPECT_TRUE(sut.set_number(field(sample, "eph"), 65535.0));
    EXPECT_EQ(error_of(sut.set_number(field(sample, "eph"), 1.5)),
              "SAMPLE.eph: 1.5 is not a whole number in 0 to 65535");
    EXPECT_THAT(error_of(sut.set_number(field(sample, "eph"), std::nan(""))), HasSubstr("not a whole number"));
    EXPECT_THAT(error_of(sut.set_number(field(sample, "eph"), 1e300)), HasSubstr("not a whole number"));
    EXPECT_THAT(error_of(sut.set_number(field(sample, "eph"), 65536.0)), HasSubstr("out of range"));
    EXPECT_TRUE(sut.set_number(field(sample, "covariance"), std::nan(""), 1));
    EXPECT_TRUE(sut.set_number(field(sample, "covariance"), -HUGE_VAL, 0));
    EXPECT_EQ(error_of(sut.set_number(field(sample, "covariance"), 1e39)),
              "SAMPLE.covariance: 1e+39 is out of range of a 32-bit float");
    EXPECT_TRUE(sut.set_number(field(sample, "f64"), 1e300));
    const MessageView view(sample, sut.payload());
    EXPECT_TRUE(std::isnan(view.get<float>(field(sample, "covariance"), 1)));
    EXPECT_EQ(view.get<double>(field(sample, "f64")), 1e300);
}

TEST(MessageBuilder, WritesTextAndClearsTheRest) {
    MessageBuilder sut(statustext);
    const auto& text = field(statustext, "text");
    EXPECT_TRUE(sut.set_text(text, std::string(50, 'x')));
    EXPECT_TRUE(sut.set_text(text, "Höhe"));
    EXPECT_EQ(MessageView(statustext, sut.payload()).text(text), "Höhe");
    EXPECT_EQ(error_of(sut.set_text(text, std::string(51, 'x'))),
              "STATUSTEXT.text: a text of 51 bytes is too long; at most 50 fit");
    EXPECT_EQ(error_of(sut.set_text(field(statustext, "severity"), "x")), "STATUSTEXT.severity: is not a text field");
    EXPECT_EQ(MessageView(statustext, sut.payload()).text(text), "Höhe");
}

TEST(MessageBuilder, ReadsNumbersAsPeopleTypeThem) {
    MessageBuilder sut(sample);
    EXPECT_TRUE(sut.set_from_text(field(sample, "eph"), " 0xFFFF "));
    EXPECT_TRUE(sut.set_from_text(field(sample, "lat"), "-473977418"));
    EXPECT_TRUE(sut.set_from_text(field(sample, "f64"), "-1.5e-3"));
    EXPECT_TRUE(sut.set_from_text(field(sample, "u64"), "18446744073709551615"));
    EXPECT_TRUE(sut.set_from_text(field(sample, "covariance"), "[nan, -Inf]"));
    EXPECT_TRUE(sut.set_from_text(field(sample, "small"), "[1,2,0x03]"));
    EXPECT_TRUE(sut.set_from_text(field(sample, "c"), "x"));
    const MessageView view(sample, sut.payload());
    EXPECT_EQ(view.integer(field(sample, "eph")), 65535);
    EXPECT_EQ(view.integer(field(sample, "lat")), -473977418);
    EXPECT_EQ(view.number(field(sample, "f64")), -0.0015);
    EXPECT_EQ(view.unsigned_integer(field(sample, "u64")), 18446744073709551615u);
    EXPECT_TRUE(std::isnan(view.number(field(sample, "covariance"), 0)));
    EXPECT_EQ(view.number(field(sample, "covariance"), 1), -HUGE_VAL);
    EXPECT_EQ(view.integer(field(sample, "small"), 2), 3);
    EXPECT_EQ(view.get<char>(field(sample, "c")), 'x');
}

TEST(MessageBuilder, KeepsTheSignOfZero) {
    MessageBuilder sut(attitude);
    ASSERT_TRUE(sut.set_from_text(field(attitude, "roll"), "-0"));
    EXPECT_TRUE(std::signbit(MessageView(attitude, sut.payload()).get<float>(field(attitude, "roll"))));
}

TEST(MessageBuilder, ReadsEnumNamesAndFlags) {
    MessageBuilder sut(heartbeat);
    EXPECT_TRUE(sut.set_from_text(field(heartbeat, "type"), "MAV_TYPE_QUADROTOR"));
    EXPECT_TRUE(sut.set_from_text(field(heartbeat, "base_mode"), "SAFETY_ARMED|TEST | 0x10"));
    const MessageView view(heartbeat, sut.payload());
    EXPECT_EQ(view.integer(field(heartbeat, "type")), 2);
    EXPECT_EQ(view.integer(field(heartbeat, "base_mode")), 0x92);
    EXPECT_EQ(error_of(sut.set_from_text(field(heartbeat, "type"), "MAV_TYPE_QUADROTER")),
              "HEARTBEAT.type: 'MAV_TYPE_QUADROTER' is neither a number nor an entry of MAV_TYPE, did you mean "
              "'MAV_TYPE_QUADROTOR'?");
}

TEST(MessageBuilder, StatesWhatWasExpected) {
    MessageBuilder sut(sample);
    EXPECT_EQ(error_of(sut.set_from_text(field(sample, "eph"), "abc")), "SAMPLE.eph: 'abc' is not a whole number");
    EXPECT_EQ(error_of(sut.set_from_text(field(sample, "eph"), "1.5")), "SAMPLE.eph: '1.5' is not a whole number");
    EXPECT_EQ(error_of(sut.set_from_text(field(sample, "eph"), "")), "SAMPLE.eph: '' is not a whole number");
    EXPECT_EQ(error_of(sut.set_from_text(field(sample, "eph"), "12 3")), "SAMPLE.eph: '12 3' is not a whole number");
    EXPECT_EQ(error_of(sut.set_from_text(field(sample, "eph"), "65536")),
              "SAMPLE.eph: 65536 is out of range, 0 to 65535");
    EXPECT_EQ(error_of(sut.set_from_text(field(sample, "f64"), "1,5")), "SAMPLE.f64: '1,5' is not a number");
    EXPECT_EQ(error_of(sut.set_from_text(field(sample, "small"), "1,2,3")),
              "SAMPLE.small: expected [a,b,...] with 3 elements");
    EXPECT_EQ(error_of(sut.set_from_text(field(sample, "small"), "[1,2]")),
              "SAMPLE.small: expected [a,b,...] with 3 elements, not 2");
    EXPECT_EQ(error_of(sut.set_from_text(field(sample, "small"), "[1,2,x]")),
              "SAMPLE.small: 'x' is not a whole number");
    EXPECT_EQ(error_of(sut.set_from_text(field(sample, "c"), "xy")),
              "SAMPLE.c: a text of 2 bytes is too long; at most 1 fit");
}

}  // namespace
}  // namespace mavloom::message
