// SPDX-License-Identifier: MIT
// The whole recorded flight and frames of every message with random fields, through the stage.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "mavloom/edit/stage.hpp"
#include "mavloom/message/builder.hpp"
#include "mavloom/wire/datagram_parser.hpp"
#include "mavloom/wire/frame_writer.hpp"
#include "support/bytes.hpp"
#include "support/seed.hpp"
#include "support/temp_dir.hpp"

namespace mavloom::edit {
namespace {

using test::Bytes;

std::unique_ptr<Stage> stage(const Options& options) {
    return std::move(*Stage::create(dialect::default_dialect(), options));
}

// One frame with a good checksum and the parser's view of it; empty if `bytes` are not exactly that.
bool is_one_good_frame(ByteView bytes) {
    wire::DatagramParser parser(dialect::default_dialect().wire_table());
    int frames = 0;
    parser.parse(
        bytes, [&](const wire::ParseEvent& event) { frames += event.kind == wire::ParseEvent::Kind::frame ? 1 : 100; });
    return frames == 1;
}

struct Frame {
    const dialect::Message* message = nullptr;
    Bytes bytes;
};

void showValue(const Frame& frame, std::ostream& out) {
    out << frame.message->name << ", " << frame.bytes.size() << " bytes";
}

rc::Gen<Frame> frames() {
    return rc::gen::map(rc::gen::tuple(rc::gen::inRange<std::size_t>(0, dialect::default_dialect().messages().size()),
                                       rc::gen::arbitrary<bool>(), rc::gen::arbitrary<std::array<std::uint8_t, 3>>(),
                                       rc::gen::arbitrary<Bytes>()),
                        [](const auto& parts) {
                            const auto& message = dialect::default_dialect().messages()[std::get<0>(parts)];
                            const auto version = std::get<1>(parts) && wire::fits_v1(message.wire) ? wire::Version::v1
                                                                                                   : wire::Version::v2;
                            const auto& [sequence, system, component] = std::get<2>(parts);
                            Bytes payload = std::get<3>(parts);
                            // The generator's lists are short: repeated, they reach the last field too.
                            for (std::size_t i = 0; !payload.empty() && payload.size() < message.wire.max_length; ++i)
                                payload.push_back(payload[i]);
                            payload.resize(message.wire.max_length);
                            wire::FrameBuffer buffer;
                            const auto frame = wire::write_frame(
                                buffer, {version, sequence, {SystemId{system}, ComponentId{component}}}, message.wire,
                                payload);
                            return Frame{&message, test::copy(frame.bytes())};
                        });
}

wire::FrameView view(const Bytes& bytes) { return wire::FrameView::unchecked(bytes); }

TEST(StageProperty, EveryFrameOfARecordedFlightComesOutByteForByte) {
    const auto recording = test::content_of(MAVLOOM_TEST_DATA "/px4_gcs_flight.tlog");
    const auto sut = stage({});
    std::size_t count = 0;
    for (std::size_t at = 8; at < recording.size(); ++count) {  // MAVLink 2, unsigned: tests/data/README.md
        const Bytes frame(recording.begin() + static_cast<std::ptrdiff_t>(at),
                          recording.begin() + static_cast<std::ptrdiff_t>(at + recording[at + 1] + 12u));
        const auto outcome = sut->forward(view(frame), {}, {});
        ASSERT_TRUE(std::ranges::equal(outcome.frame.bytes(), frame)) << "at byte " << at;
        at += frame.size() + 8;
    }

    EXPECT_EQ(count, 40087u);
    EXPECT_EQ(sut->counters().reencoded.value(), 40087u);
}

RC_GTEST_PROP(StageProperty, EveryCanonicalFrameOfEveryMessageComesOutByteForByte, ()) {
    const auto frame = *frames();
    const auto sut = stage({});

    const auto outcome = sut->forward(view(frame.bytes), {}, {});

    RC_ASSERT(std::ranges::equal(outcome.frame.bytes(), frame.bytes));
    RC_ASSERT(sut->counters().reencoded.value() == 1u);
}

RC_GTEST_PROP(StageProperty, RemappingThereAndBackChangesNothing, ()) {
    const auto frame = *frames();
    const auto from = *rc::gen::inRange(1, 256), to = *rc::gen::inRange(1, 256);
    const auto remap = std::to_string(from) + "=" + std::to_string(to);
    const auto sut = stage(
        {.remap_system = {remap, from == to ? remap : std::to_string(to) + "=" + std::to_string(from)}});

    const Bytes there = test::copy(sut->forward(view(frame.bytes), {}, {}).frame.bytes());
    const Bytes back = test::copy(sut->backward(view(there)).frame.bytes());

    RC_ASSERT(is_one_good_frame(there));
    RC_ASSERT(back == frame.bytes);
}

RC_GTEST_PROP(StageProperty, OnlyTheFieldThatIsSetChanges, ()) {
    const auto frame = *frames();
    const auto& field = *rc::gen::elementOf(
        std::vector<dialect::Field>(frame.message->fields.begin(), frame.message->fields.end()));
    RC_PRE(!field.is_array());
    const auto sut = stage({.set = {std::string(frame.message->name) + "." + std::string(field.name) + "=1"},
                            .as_version = wire::Version::v2});

    const Bytes out = test::copy(sut->forward(view(frame.bytes), {}, {}).frame.bytes());

    RC_ASSERT(is_one_good_frame(out));
    const message::MessageBuilder before(*frame.message, view(frame.bytes).payload()),
        after(*frame.message, view(out).payload());
    for (std::size_t i = 0; i < before.payload().size(); ++i) {
        const bool within = i >= field.offset && i < field.offset + field.size();
        RC_ASSERT(within || before.payload()[i] == after.payload()[i]);
    }
}

RC_GTEST_PROP(StageProperty, Version1AndBackLosesOnlyExtensions, ()) {
    const auto frame = *frames();
    const auto to_v1 = stage({.as_version = wire::Version::v1}), to_v2 = stage({.as_version = wire::Version::v2});

    const auto outcome = to_v1->forward(view(frame.bytes), {}, {});
    RC_ASSERT((outcome.verdict == Verdict::forward) == wire::fits_v1(frame.message->wire));
    if (outcome.verdict != Verdict::forward) return;
    const Bytes v1 = test::copy(outcome.frame.bytes());
    const Bytes v2 = test::copy(to_v2->forward(view(v1), {}, {}).frame.bytes());

    RC_ASSERT(is_one_good_frame(v1));
    RC_ASSERT(is_one_good_frame(v2));
    RC_ASSERT(v1.size() == 8u + frame.message->wire.min_length);
    const message::MessageBuilder before(*frame.message, view(frame.bytes).payload()),
        after(*frame.message, view(v2).payload());
    const auto kept = frame.message->wire.min_length;
    RC_ASSERT(std::ranges::equal(before.payload().first(kept), after.payload().first(kept)));
    RC_ASSERT(std::ranges::all_of(after.payload().subspan(kept), [](std::uint8_t byte) { return byte == 0; }));
}

}  // namespace
}  // namespace mavloom::edit
