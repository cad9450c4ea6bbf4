// SPDX-License-Identifier: MIT
#include <filesystem>

#include "link/serial/pacer.hpp"
#include "unit/link/fixture.hpp"
#include "unit/net/pty.hpp"

namespace mavloom::link {
namespace {

namespace fs = std::filesystem;
using namespace testing;
using mavloom::testing::Pty;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::SizeIs;

struct LinksSerial : ::testing::Test {
    LinksSerial() { fs::create_directories(folder); }
    ~LinksSerial() override { fs::remove_all(folder); }
    // A name for the port, as udev would make one.
    std::string named(const Pty& pty) {
        fs::remove(name);
        fs::create_symlink(pty.device(), name);
        return "serial://" + name;
    }
    // All that the far end gets until `condition`.
    template <class Condition>
    bool collect(const Pty& pty, Bytes& got, Condition&& condition) {
        return until(
            [&] {
                got = std::move(got) + pty.read();
                return condition();
            },
            node);
    }

    std::string folder = fmt::format("{}/links_serial_{}", ::testing::TempDir(), ::getpid());
    std::string name = folder + "/autopilot";
    Node node;
};

TEST_F(LinksSerial, FramesPassBothWays) {
    const Pty far;
    const auto port = node.add("serial://" + far.device() + "?baud=921600");
    const Bytes stream = heartbeat(0) + attitude(1) + frame_bytes(131, 2);
    far.write(stream);
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 3; }, node));
    EXPECT_EQ(node.recorder.bytes(), stream);
    ASSERT_THAT(node.recorder.ups, SizeIs(1));
    EXPECT_EQ(node.recorder.ups[0].second, "serial://" + far.device());
    EXPECT_EQ(node.links->send(port, view(attitude(7))), 1u);
    Bytes got;
    ASSERT_TRUE(collect(far, got, [&] { return got == attitude(7); }));
    EXPECT_EQ(far.settings().c_ospeed, 921'600u);
}

TEST_F(LinksSerial, ADeletedByteCostsOneFrame) {
    const Pty far;
    node.add("serial://" + far.device());
    Bytes stream;
    for (std::uint8_t i = 0; i < 10; ++i) stream = std::move(stream) + attitude(i);
    stream.erase(stream.begin() + 5 * 40 + 20);
    far.write(stream);
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 9; }, node));
    const auto& counters = *node.links->links().at(0).counters;
    EXPECT_EQ(counters.crc_error.value(), 1u);
    EXPECT_EQ(counters.lost.value(), 1u);
}

// The link receives the bytes that such a UART sends back, and all other traffic is unaffected.
TEST_F(LinksSerial, AnEchoingUartLosesNothing) {
    const Pty far;
    const auto port = node.add("serial://" + far.device());
    Bytes sent;
    for (std::uint8_t i = 0; i < 200; ++i) {
        EXPECT_EQ(node.links->send(port, view(attitude(i))), 1u);
        sent = std::move(sent) + attitude(i);
    }
    ASSERT_TRUE(until(
        [&] {
            if (const Bytes echo = far.read(); !echo.empty()) far.write(echo);
            return node.recorder.frames.size() == 200;
        },
        node));
    EXPECT_EQ(node.recorder.bytes(), sent);
    EXPECT_FALSE(node.links->pending());
}

TEST_F(LinksSerial, APortThatIsRemovedAndMadeAgainComesBack) {
    Pty first;
    const auto port = node.add(named(first));
    first.write(heartbeat(0));
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 1; }, node));
    const LinkId link = node.recorder.frames[0].link;
    first.unplug();
    fs::remove(name);
    ASSERT_TRUE(until([&] { return node.recorder.downs.size() == 1; }, node));
    EXPECT_EQ(node.recorder.downs[0].second, "unplugged");
    EXPECT_EQ(node.links->send(port, view(heartbeat(1))), 0u);
    ASSERT_TRUE(until([&] { return !node.recorder.notices.empty(); }, node));
    EXPECT_THAT(node.recorder.notices[0], HasSubstr("No such file or directory; trying again"));

    const Pty second;
    named(second);
    ASSERT_TRUE(until([&] { return node.recorder.ups.size() == 2; }, node));
    second.write(heartbeat(2));
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 2; }, node));
    EXPECT_EQ(node.recorder.frames[1].link, link);
    EXPECT_EQ(node.info(port).counters->reconnects.value(), 1u);
    EXPECT_EQ(node.links->send(port, view(heartbeat(3))), 1u);
    Bytes got;
    ASSERT_TRUE(collect(second, got, [&] { return got == heartbeat(3); })) << ::testing::PrintToString(got);
}

TEST_F(LinksSerial, WhileTurnsContinueARequiredPortIsAwaited) {
    node.poll();
    node.add("serial://" + name + "?required=true");
    EXPECT_THAT(node.refused("serial:///dev/null?required=true").text, HasSubstr("is not a serial port"));
}

// By then the back-off alone would wait for three seconds.
TEST_F(LinksSerial, AMissingPortIsOpenedAtOnceWhenItAppears) {
    node.add("serial://" + name);
    const MonoTime later = mono_now() + std::chrono::milliseconds(3200);
    ASSERT_TRUE(until([&] { return mono_now() > later; }, node));
    const Pty far;
    const MonoTime appears = mono_now();
    named(far);
    ASSERT_TRUE(until([&] { return !node.recorder.ups.empty(); }, node));
    EXPECT_LT(mono_now() - appears, std::chrono::milliseconds(2500));
}

TEST_F(LinksSerial, AFullPortGetsWholeFramesWhenItsReaderResumes) {
    const Pty far;
    const auto port = node.add("serial://" + far.device() + "?baud=921600&queue_bytes=64k&queue_age=300ms");
    constexpr std::size_t count = 4000;  // 1.1 MB
    std::size_t sent = 0;
    const MonoTime end = mono_now() + std::chrono::seconds(1);
    ASSERT_TRUE(until(
        [&] {
            for (int i = 0; i < 20 && sent < count; ++i, ++sent)
                node.links->send(port, view(frame_bytes(131, static_cast<std::uint8_t>(sent))));
            return sent == count && mono_now() > end;
        },
        node));
    const auto& counters = *node.links->links().at(0).counters;
    EXPECT_GT(counters.queue_bytes.value() + counters.queue_age.value(), 0u);
    Bytes got;
    ASSERT_TRUE(collect(far, got, [&] { return !node.links->pending() && got.size() == counters.bytes_out.value(); }));
    wire::StreamParser parser(table());
    std::size_t frames = 0, bad = 0;
    parser.feed(got, MonoTime{},
                [&](const wire::ParseEvent& e) { ++(e.kind == wire::ParseEvent::Kind::frame ? frames : bad); });
    EXPECT_EQ(bad, 0u);
    EXPECT_EQ(parser.pending_bytes(), 0u);
    EXPECT_EQ(frames, counters.frames_out.value());
    EXPECT_EQ(frames + counters.queue_bytes.value() + counters.queue_age.value(), sent);
}

TEST_F(LinksSerial, WhatWasCutShortIsSentWholeOnTheNextPort) {
    Pty first;
    const auto port = node.add(named(first) + "?baud=921600&queue_age=60");
    for (int i = 0; i < 1000; ++i) node.links->send(port, view(frame_bytes(131, static_cast<std::uint8_t>(i))));
    const MonoTime later = mono_now() + std::chrono::milliseconds(500);
    ASSERT_TRUE(until([&] { return mono_now() > later; }, node));
    const auto& counters = *node.links->links().at(0).counters;
    const auto before = counters.frames_out.value();
    first.unplug();
    ASSERT_TRUE(until([&] { return node.recorder.downs.size() == 1; }, node));
    const Pty second;
    named(second);
    Bytes got;
    ASSERT_TRUE(collect(second, got, [&] { return node.recorder.ups.size() == 2 && !node.links->pending(); }));
    for (Bytes more = second.read(); !more.empty(); more = second.read()) got = std::move(got) + more;
    const std::size_t frame = frame_bytes(131, 0).size();
    EXPECT_EQ(got.size() % frame, 0u);
    EXPECT_EQ(got.size() / frame, counters.frames_out.value() - before);
    EXPECT_EQ(Bytes(got.begin(), got.begin() + static_cast<std::ptrdiff_t>(frame)),
              frame_bytes(131, static_cast<std::uint8_t>(before)));
}

TEST_F(LinksSerial, AMissingPortThatIsRequiredIsAnError) {
    const auto error = node.refused("serial://" + name + "?required=true");
    EXPECT_EQ(error.code, SetupCode::not_found);
    EXPECT_THAT(error.text, HasSubstr(name));
}

TEST_F(LinksSerial, WhatIsNoPortAndWhatIsInUseIsAnError) {
    EXPECT_EQ(node.refused("serial:///dev/null").code, SetupCode::usage);
    const Pty far;
    node.add("serial://" + far.device());
    Node other;
    EXPECT_EQ(other.refused("serial://" + far.device()).code, SetupCode::in_use);
}

// The far end sends noise except at its own rate, as a UART does.
TEST_F(LinksSerial, FindsTheBaudRate) {
    const Pty far;
    const auto port = node.add("serial://" + far.device() + "?baud=auto");
    EXPECT_EQ(far.settings().c_ospeed, 57'600u);
    std::uint8_t n = 0;
    MonoTime next{};
    ASSERT_TRUE(until(
        [&] {
            if (mono_now() > next) {
                next = mono_now() + std::chrono::milliseconds(100);
                far.write(far.settings().c_ospeed == 115'200 ? heartbeat(n++) : Bytes{0xf8, 0x00, 0x1e, 0xfd, 0x80});
            }
            return node.recorder.frames.size() >= 3;
        },
        node));
    EXPECT_EQ(far.settings().c_ospeed, 115'200u);
    EXPECT_THAT(node.recorder.ups, SizeIs(1));
    EXPECT_THAT(node.recorder.notices, Contains(HasSubstr(": 115200 baud")));
    EXPECT_EQ(node.links->send(port, view(heartbeat(9))), 1u);
}

TEST_F(LinksSerial, SendsNothingBeforeTheBaudRateIsKnown) {
    const Pty far;
    const auto port = node.add("serial://" + far.device() + "?baud=auto");
    node.poll();
    EXPECT_EQ(node.links->send(port, view(heartbeat(0))), 0u);
    EXPECT_THAT(node.recorder.ups, SizeIs(0));
}

TEST_F(LinksSerial, ADriverWithoutLowLatencyIsReported) {
    const Pty far;
    node.add("serial://" + far.device() + "?low_latency=true");
    node.poll();
    EXPECT_THAT(node.recorder.notices, Contains(HasSubstr("does not support low_latency")));
}

// 50 ms of 57600 baud, ten bits a byte, are 288 bytes.
TEST(SerialPacer, KeepsFiftyMillisecondsInTheDriver) {
    detail::SerialPacer pacer(57'600);
    EXPECT_EQ(pacer.room(0), 288u);
    EXPECT_EQ(pacer.room(200), 88u);
    EXPECT_EQ(pacer.room(288), 0u);
    EXPECT_EQ(pacer.room(4096), 0u);
    EXPECT_EQ(detail::SerialPacer(1'200).room(0), 64u);
}

TEST(SerialPacer, LearnsThatADriverEmptiesSoonerAndForgetsIt) {
    detail::SerialPacer pacer(57'600);
    pacer.learn(144);
    EXPECT_EQ(pacer.room(0), 288u);
    pacer.learn(0);
    EXPECT_EQ(pacer.room(0), 576u);
    pacer.learn(300);
    EXPECT_EQ(pacer.room(0), 288u);
    pacer.learn(288);
    EXPECT_EQ(pacer.room(0), 288u);
    for (int i = 0; i < 64; ++i) pacer.learn(0);
    EXPECT_EQ(pacer.room(0), 400'000u);
}

}  // namespace
}  // namespace mavloom::link
