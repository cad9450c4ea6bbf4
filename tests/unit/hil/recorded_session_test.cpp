// SPDX-License-Identifier: MIT
// A recorded lock-step flight of a real PX4 (v1.18 in development): boot, take-off, hold, landing. The bytes that PX4
// sent go through our parser, each answer comes after the time that PX4 took, and the rules of time must agree with all
// of it.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "mavloom/hil/pair.hpp"
#include "mavloom/msg/command_long.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/hil_actuator_controls.hpp"
#include "mavloom/msg/hil_sensor.hpp"
#include "mavloom/wire/stream_parser.hpp"
#include "mavloom/wire/struct_frame.hpp"

namespace mavloom::hil {
namespace {

using namespace std::chrono_literals;
using Bytes = std::vector<std::uint8_t>;

struct Recorded {
    std::uint64_t time_us;
    Bytes frame;
};

// A record of a tlog file is eight bytes of time, big-endian, and a frame.
std::vector<Recorded> recording(const std::string& name) {
    std::ifstream file(std::string(MAVLOOM_TEST_DATA) + "/" + name, std::ios::binary);
    const Bytes all(std::istreambuf_iterator<char>(file), {});
    std::vector<Recorded> records;
    for (std::size_t at = 0; at + 8 < all.size();) {
        std::uint64_t time = 0;
        for (int i = 0; i < 8; ++i) time = time << 8 | all[at++];
        const std::size_t length = wire::frame_length(ByteView(all).subspan(at));
        if (length == 0) break;
        const auto begin = all.begin() + static_cast<std::ptrdiff_t>(at);
        records.push_back({time, Bytes(begin, begin + static_cast<std::ptrdiff_t>(length))});
        at += length;
    }
    return records;
}

std::uint64_t time_of(const Recorded& record) { return load_le<std::uint64_t>(record.frame.data() + 10); }
std::uint32_t id_of(const Recorded& record) { return wire::FrameView::unchecked(record.frame).id().value; }

// The frames of PX4, as the parser finds them in the stream.
std::vector<Bytes> parsed(const std::vector<Recorded>& records, std::size_t chunk) {
    Bytes stream;
    for (const auto& record : records) stream.insert(stream.end(), record.frame.begin(), record.frame.end());
    const std::array infos{wire::info_of<msg::HilActuatorControls>, wire::info_of<msg::Heartbeat>,
                           wire::info_of<msg::CommandLong>};
    const wire::MessageTable table(infos);
    wire::StreamParser parser(table);
    std::vector<Bytes> frames;
    for (std::size_t at = 0; at < stream.size(); at += chunk)
        parser.feed(ByteView(stream).subspan(at, std::min(chunk, stream.size() - at)), MonoTime{},
                    [&](const auto& event) {
                        ASSERT_EQ(event.kind, wire::ParseEvent::Kind::frame);
                        frames.emplace_back(event.frame.bytes().begin(), event.frame.bytes().end());
                    });
    return frames;
}

class RecordedSessionTest : public ::testing::Test {
protected:
    const std::vector<Recorded> to_px4 = recording("px4_hil_to_px4.tlog"),
                                from_px4 = recording("px4_hil_from_px4.tlog");
};

TEST_F(RecordedSessionTest, TheParserFindsEachFrameHoweverTheStreamIsCut) {
    ASSERT_EQ(from_px4.size(), 11'340u);
    for (const std::size_t chunk : {7u, 93u, 1448u}) {
        const auto frames = parsed(from_px4, chunk);
        ASSERT_EQ(frames.size(), from_px4.size());
        for (std::size_t i = 0; i < frames.size(); ++i) ASSERT_EQ(frames[i], from_px4[i].frame);
    }
}

TEST_F(RecordedSessionTest, EachStepIsAnsweredAsPx4AnsweredIt) {
    std::map<std::uint64_t, std::uint64_t> sent;  // when a step left
    for (const auto& record : to_px4)
        if (id_of(record) == msg::HilSensor::id.value) sent[time_of(record)] = record.time_us;
    std::map<std::uint64_t, const Recorded*> answers;
    for (const auto& record : from_px4)
        if (id_of(record) == msg::HilActuatorControls::id.value) answers[time_of(record)] = &record;
    ASSERT_EQ(sent.size(), 11'373u);
    ASSERT_EQ(answers.size(), 11'338u);

    MonoTime now{1h};
    Pair pair({.speed = any_speed});
    pair.begin(now);
    EXPECT_EQ(pair.receive(wire::FrameView::unchecked(from_px4[0].frame), now), Heard::request);
    EXPECT_EQ(pair.receive(wire::FrameView::unchecked(from_px4[1].frame), now), Heard::autopilot);
    bool was_armed = false;
    for (std::size_t i = 0; i < sent.size(); ++i) {
        now = std::max(now, pair.due());
        const auto frames = pair.step(now);
        const auto time = msg::HilSensor::decode(frames.front().payload()).time_usec;
        ASSERT_TRUE(sent.contains(time));
        const auto answer = answers.find(time);
        ASSERT_EQ(pair.lock_step().state(), i < 36 ? State::booting : State::lock_step);
        if (answer == answers.end()) continue;  // PX4 boots
        // The recorder noted both directions on threads of their own.
        now += std::chrono::microseconds{std::max(answer->second->time_us, sent[time]) - sent[time]};
        EXPECT_EQ(pair.receive(wire::FrameView::unchecked(answer->second->frame), now), Heard::controls);
        was_armed |= pair.status().is_armed;
        ASSERT_LE(pair.due(), i < 36 ? now + 4ms : now);
    }

    const StepCounters& counters = pair.lock_step().counters();
    EXPECT_EQ(counters.answered, answers.size());
    EXPECT_EQ(counters.unanswered + counters.late + counters.repeated + counters.foreign + counters.losses, 0u);
    EXPECT_EQ(pair.counters().clamped + pair.counters().not_numbers, 0u);
    EXPECT_TRUE(was_armed);
    EXPECT_FALSE(pair.status().is_armed);
}

}  // namespace
}  // namespace mavloom::hil
