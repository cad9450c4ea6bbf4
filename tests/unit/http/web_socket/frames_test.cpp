// SPDX-License-Identifier: MIT
#include "http/web_socket/frames.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "unit/http/raw_client.hpp"

namespace mavloom::http {
namespace {

using namespace std::string_literals;
using ::testing::ElementsAre;

// RFC 6455, section 5.7, without mask.
const std::string hello = "\x81\x05Hello"s, first_part = "\x01\x03Hel"s, last_part = "\x80\x02lo"s,
                  ping = "\x89\x05Hello"s;

struct Log : FrameEvents {
    void take_message(ByteView message, Kind kind) override {
        lines.push_back((kind == Kind::text ? "text " : "binary ") + std::string(message.begin(), message.end()));
    }
    void take_ping(ByteView payload) override {
        lines.push_back("ping " + std::string(payload.begin(), payload.end()));
    }
    void take_close(std::uint16_t code, std::string_view reason) override {
        lines.push_back("close " + std::to_string(code) + " " + std::string(reason));
    }
    void take_fault(Ended, std::uint16_t code) override { lines.push_back("fault " + std::to_string(code)); }

    std::vector<std::string> lines;
};

const SessionOptions both{.accepts = Accepts::both};

// Feeds the bytes in steps, and returns the events.
std::vector<std::string> read(std::string bytes, std::size_t step = 1, const SessionOptions& options = both,
                              bool is_client = true) {
    Log log;
    FrameReader sut(options, is_client, log);
    for (std::size_t i = 0; i < bytes.size(); i += step) {
        const auto size = std::min(step, bytes.size() - i);
        sut.feed({reinterpret_cast<std::uint8_t*>(&bytes[i]), size});
    }
    return log.lines;
}

TEST(FrameReader, ReadsTheExamplesOfTheSpecification) {
    for (const std::size_t step : {1u, 2u, 3u, 1000u}) {
        EXPECT_THAT(read(hello + hello, step), ElementsAre("text Hello", "text Hello"));
        EXPECT_THAT(read(first_part + ping + last_part + ping, step),
                    ElementsAre("ping Hello", "text Hello", "ping Hello"));
        EXPECT_THAT(read(masked_hello + masked_hello, step, both, false), ElementsAre("text Hello", "text Hello"));
        EXPECT_THAT(read("\x82\x00"s + "\x8a\x00"s +
                             "\x88\x05\x03\xe8"
                             "bye"s +
                             hello,
                         step),
                    ElementsAre("binary ", "close 1000 bye"));
        EXPECT_THAT(read("\x88\x00"s, step), ElementsAre("close 0 "));
    }
}

TEST(FrameReader, ReadsAllLengths) {
    const std::string middle(256, 'x'), large(65'536, 'y');
    const auto bytes = "\x82\x7e\x01\x00"s + middle + "\x82\x7f\x00\x00\x00\x00\x00\x01\x00\x00"s + large;
    for (const std::size_t step : {1u, 7u, 100'000u})
        EXPECT_THAT(read(bytes, step), ElementsAre("binary " + middle, "binary " + large));
    EXPECT_THAT(read("\x82\x7f\x00\x00\x00\x00\x00\x01\x00\x01"s), ElementsAre("fault 1009"));
    EXPECT_THAT(read("\x82\x7f\xff\xff\xff\xff\xff\xff\xff\xff"s), ElementsAre("fault 1002"));
}

TEST(FrameReader, BoundsMessages) {
    const SessionOptions small{.max_message = 5, .max_fragments = 3};
    EXPECT_THAT(read("\x82\x05Hello"s, 1, small), ElementsAre("binary Hello"));
    EXPECT_THAT(read("\x82\x06Hello!"s, 1, small), ElementsAre("fault 1009"));
    EXPECT_THAT(read("\x02\x03Hel\x80\x03lo!"s, 1, small), ElementsAre("fault 1009"));
    EXPECT_THAT(read("\x02\x00\x00\x00\x80\x01x"s, 1, small), ElementsAre("binary x"));
    EXPECT_THAT(read("\x02\x00\x00\x00\x00\x00\x80\x01x"s, 1, small), ElementsAre("fault 1008"));
    EXPECT_THAT(read(hello, 1, small), ElementsAre("fault 1003"));
    EXPECT_THAT(read("\x82\x01x"s, 1, {.accepts = Accepts::text}), ElementsAre("fault 1003"));
}

TEST(FrameReader, RefusesWhatBreaksTheProtocol) {
    for (const auto& bad : {"\xc2\x01x"s, "\xa2\x01x"s, "\x83\x01x"s, "\x8b\x01x"s, "\x80\x01x"s, "\x02\x01x\x82\x01x"s,
                            "\x09\x01x"s, "\x89\x7e\x00\x7e"s, "\x88\x01x"s, "\x88\x02\x03\xed"s, "\x88\x02\x00\x00"s,
                            "\x82\x7e\x00\x7d"s, "\x82\x7f\x00\x00\x00\x00\x00\x00\xff\xff"s})
        EXPECT_EQ(read(bad + hello).back(), "fault 1002") << testing::PrintToString(bad);
    EXPECT_THAT(read(masked_hello), ElementsAre("fault 1002"));
    EXPECT_THAT(read(hello, 1, both, false), ElementsAre("fault 1002"));
    EXPECT_THAT(read("\x81\x02\xc3\x28"s + hello), ElementsAre("fault 1007"));
    EXPECT_THAT(read("\x88\x04\x03\xe8\xc3\x28"s), ElementsAre("fault 1007"));
    EXPECT_THAT(read("\x01\x01\xc3\x80\x01\xa4"s), ElementsAre("text \xc3\xa4"));
}

TEST(FrameWriter, WritesWhatTheSpecificationShows) {
    FrameWriter sut(false);
    std::vector<std::uint8_t> bytes;
    sut.append(bytes, Opcode::text, bytes_of("Hello"));
    EXPECT_EQ(std::string(bytes.begin(), bytes.end()), hello);
    bytes.clear();
    sut.append(bytes, Opcode::binary, bytes_of(std::string(256, 'x')));
    EXPECT_EQ(std::string(bytes.begin(), bytes.end()), "\x82\x7e\x01\x00"s + std::string(256, 'x'));
    bytes.clear();
    sut.append(bytes, Opcode::binary, bytes_of(std::string(65'536, 'x')));
    EXPECT_EQ(std::string(bytes.begin(), bytes.begin() + 10), "\x82\x7f\x00\x00\x00\x00\x00\x01\x00\x00"s);
}

TEST(FrameWriter, AClientMasksEachFrameAnew) {
    FrameWriter sut(true);
    std::vector<std::uint8_t> bytes;
    std::vector<std::string> expected;
    for (int i = 0; i < 200; ++i) {
        expected.push_back("binary " + std::string(static_cast<std::size_t>(i), 'm'));
        sut.append(bytes, Opcode::binary, bytes_of(std::string(static_cast<std::size_t>(i), 'm')));
    }
    EXPECT_EQ(read({bytes.begin(), bytes.end()}, 1000, both, false), expected);
    std::vector<std::uint8_t> one, other;
    sut.append(one, Opcode::binary, bytes_of("the same"));
    sut.append(other, Opcode::binary, bytes_of("the same"));
    EXPECT_NE(one, other);
}

}  // namespace
}  // namespace mavloom::http
