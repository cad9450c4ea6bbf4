// SPDX-License-Identifier: MIT
// Finding frames, tracking their sequence and writing them allocates nothing once the objects exist, for good bytes and
// bad.
#include <gtest/gtest.h>

#include "mavloom/wire/datagram_parser.hpp"
#include "mavloom/wire/frame_writer.hpp"
#include "mavloom/wire/sequence.hpp"
#include "mavloom/wire/stream_parser.hpp"
#include "support/count_allocations.hpp"
#include "support/golden_frames.hpp"

namespace mavloom::wire {

TEST(Wire, AllocatesNothingForAFrameOrForJunk) {
    const MessageTable table{test::golden_messages};
    StreamParser stream{table};
    DatagramParser datagram{table};
    SequenceTracker tracker;
    FrameBuffer out;
    auto damaged = test::attitude_v1;
    damaged[9] ^= 1;
    const auto bytes = test::join(
        {test::heartbeat_v2, {1, 2, 0xfd, 3}, damaged, test::tunnel_v2, test::heartbeat_signed_1, test::attitude_v1});
    std::uint64_t frames = 0;
    const auto sink = [&](const ParseEvent& event) {
        if (event.kind != ParseEvent::Kind::frame) return;
        tracker.update(event.frame);
        frames += !write_frame(out, {Version::v2, 1, event.frame.source(), 0}, *event.info, event.frame.payload()).empty();
    };
    datagram.parse(bytes, sink);  // the first frame of a source makes its entry
    const auto before = test::allocations;

    for (int i = 0; i < 1000; ++i) {
        datagram.parse(bytes, sink);
        for (std::size_t at = 0; at < bytes.size(); at += 11)
            stream.feed(ByteView{bytes}.subspan(at, std::min<std::size_t>(11, bytes.size() - at)), MonoTime{}, sink);
    }

    EXPECT_EQ(test::allocations, before);
    EXPECT_EQ(frames, 2001u * 4);
}

void hear_systems(SequenceTracker& sut, unsigned from, unsigned to) {
    static auto frame = test::heartbeat_v2;
    for (unsigned system = from; system < to; ++system) {
        frame[5] = static_cast<std::uint8_t>(system);
        sut.update(FrameView::unchecked(frame));
    }
}

TEST(Wire, AllocatesNothingForSourcesBeyondTheBudget) {
    SourceBudget budget(0);
    SequenceTracker sut;
    sut.limit_by(budget);
    hear_systems(sut, 0, SequenceTracker::own_sources);
    const auto before = test::allocations;

    hear_systems(sut, SequenceTracker::own_sources, 256);

    EXPECT_EQ(test::allocations, before);
    EXPECT_EQ(sut.untracked(), 256 - SequenceTracker::own_sources);
}

// The budget counts sources, so each must be small, also if each invents a system: about 400 bytes. Tables that grow
// allocate more, and give it back.
TEST(Wire, ASourceOfAnInventedSystemIsSmall) {
    SequenceTracker sut;
    hear_systems(sut, 0, 1);
    const auto before = test::allocated_bytes;

    hear_systems(sut, 1, 256);

    EXPECT_LT(test::allocated_bytes - before, 255u * 1100);
}

}  // namespace mavloom::wire
