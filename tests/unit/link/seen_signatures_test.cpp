// SPDX-License-Identifier: MIT
// Expected values: docs/guide/route.md (a frame may be half a second behind those of another link), by hand.
#include "link/signing/seen_signatures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/golden_frames.hpp"

namespace mavloom::link::detail {
namespace {

using std::chrono::milliseconds;
using Verdict = SeenSignatures::Verdict;

constexpr MonoTime first_time{std::chrono::hours{1}};

// A sender with a frame every 10 ms, one tick apart: its signing clock does not run with ours.
struct Flight {
    MonoTime now = first_time;
    std::uint64_t newest = 1000;
    SeenSignatures::Sender sender{{newest}, now};

    bool takes(std::uint64_t ticks) { return sender.accepts({ticks}, now); }
    void fly(milliseconds time) {
        for (const MonoTime end = now + time; now < end; now += milliseconds{10}) EXPECT_TRUE(takes(++newest));
    }
};

TEST(LateFrames, AFrameNewerThanAllOthersIsTaken) { EXPECT_TRUE(Flight().takes(1001)); }

TEST(LateFrames, HalfASecondMayPass) {
    Flight flight;
    flight.fly(milliseconds{5000});
    EXPECT_TRUE(flight.takes(flight.newest - 50));
}

// Whatever the pace: a frame that was taken as long ago as its bytes are remembered, and any older one.
TEST(LateFrames, NothingIsTakenTwiceAfterItsBytesAreForgotten) {
    for (milliseconds period{10}; period < milliseconds{3000}; period += milliseconds{10}) {
        Flight flight;
        std::vector<MonoTime> taken;
        for (int i = 0; i < 12; ++i, flight.now += period) {
            for (milliseconds later{0}; later < period; later += milliseconds{100}) {
                Flight copy = flight;
                copy.now += later;
                const auto forgotten = std::ranges::count_if(
                    taken, [&](MonoTime t) { return t <= copy.now - SeenSignatures::max_late; });
                if (forgotten != 0) {
                    ASSERT_FALSE(copy.takes(1000 + static_cast<std::uint64_t>(forgotten))) << period.count();
                }
            }
            ASSERT_TRUE(flight.takes(++flight.newest));
            taken.push_back(flight.now);
        }
    }
}

TEST(LateFrames, BehindAsLongAsBytesAreRememberedIsTooLate) {
    Flight flight;
    for (int i = 0; i < 200; ++i) {
        flight.fly(milliseconds{20});
        if (flight.newest > 1200) {
            EXPECT_FALSE(flight.takes(flight.newest - 181)) << i;
        }
    }
}

// A late frame from the slower link does not make older ones acceptable.
TEST(LateFrames, ALateFrameThatIsTakenChangesNothing) {
    Flight flight;
    flight.fly(milliseconds{5000});
    const std::uint64_t newest = flight.newest;
    EXPECT_TRUE(flight.takes(newest - 50));
    for (int i = 0; i < 2; ++i) {
        flight.now += SeenSignatures::step;
        EXPECT_TRUE(flight.takes(++flight.newest));
    }
    EXPECT_FALSE(flight.takes(newest));
}

TEST(LateFrames, ASilentSenderMakesNoExceptions) {
    Flight flight;
    flight.fly(milliseconds{3000});
    flight.now += milliseconds{1800};
    EXPECT_FALSE(flight.takes(flight.newest));
    EXPECT_TRUE(flight.takes(flight.newest + 1));
}

// A frame with this link id and signing time, and a hash that no other has. SeenSignatures does not check it.
class Signed {
public:
    Signed(std::uint8_t link_id, std::uint64_t ticks, std::uint8_t system = 1) : bytes_(heartbeat) {
        bytes_[5] = system;
        std::uint8_t* const signature = bytes_.data() + bytes_.size() - wire::signature_length;
        signature[0] = link_id;
        for (int i = 0; i < 6; ++i) signature[1 + i] = static_cast<std::uint8_t>(ticks >> (8 * i));
        store_le(signature + 7, static_cast<std::uint32_t>(ticks * 2654435761u) + link_id);
    }
    [[nodiscard]] wire::FrameView view() const { return wire::FrameView::unchecked(bytes_); }

private:
    static inline const test::Bytes heartbeat = test::hex(
        "fd090100000101000000000000000203000403ad2f0000203d88792dcb8d7240623f");
    test::Bytes bytes_;
};

TEST(SeenSignatures, AFrameIsNewOnce) {
    SeenSignatures sut;
    EXPECT_EQ(sut.hear(Signed(5, 1001).view(), first_time), Verdict::is_new);
    EXPECT_EQ(sut.hear(Signed(5, 1002).view(), first_time), Verdict::is_new);
    EXPECT_EQ(sut.hear(Signed(5, 1001).view(), first_time), Verdict::repeated);
}

TEST(SeenSignatures, SendersAreJudgedApart) {
    SeenSignatures sut;
    EXPECT_EQ(sut.hear(Signed(5, 9000).view(), first_time), Verdict::is_new);
    EXPECT_EQ(sut.hear(Signed(5, 5, 2).view(), first_time + std::chrono::seconds{3}, {4}), Verdict::is_new);
    EXPECT_EQ(sut.hear(Signed(5, 5, 3).view(), first_time, {5}), Verdict::too_late);
}

TEST(SeenSignatures, AFrameOfOursIsKnownEvenIfTheSetHasForgottenIt) {
    SeenSignatures sut;
    sut.sign_as(255);
    for (std::uint64_t ticks = 1; ticks <= 100'000; ++ticks) sut.note_signed(Signed(255, ticks).view());
    for (std::uint64_t ticks = 1; ticks <= 100'000; ticks += 100)
        ASSERT_TRUE(sut.is_own(Signed(255, ticks).view())) << ticks;
    EXPECT_FALSE(sut.is_own(Signed(255, 100'001).view()));
    EXPECT_FALSE(sut.is_own(Signed(254, 1).view())) << "a link id that we do not sign with";
}

// Two routers in a row choose the same link ids. A group hears the other one's frames on two links.
TEST(SeenSignatures, WhatWasHeardWithOurLinkIdIsNotOurs) {
    SeenSignatures sut;
    sut.sign_as(255);
    sut.note_signed(Signed(255, 1000).view());
    EXPECT_EQ(sut.hear(Signed(255, 999).view(), first_time), Verdict::is_new);
    for (std::uint64_t ticks = 2000; ticks < 100'000; ++ticks) (void)sut.hear(Signed(5, ticks).view(), first_time);

    EXPECT_FALSE(sut.is_own(Signed(255, 1001).view()));
    EXPECT_TRUE(sut.is_own(Signed(255, 1000).view()));
}

}  // namespace
}  // namespace mavloom::link::detail
