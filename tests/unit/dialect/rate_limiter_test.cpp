// SPDX-License-Identifier: MIT
#include "mavloom/dialect/rate_limiter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <random>

#include "mavloom/wire/frame_writer.hpp"

namespace mavloom::dialect {
namespace {

using namespace std::chrono_literals;

using Limiter = RateLimiter<WallTime>;

constexpr WallTime t0{1'700'000'000s};

struct Heartbeat {
    explicit Heartbeat(std::uint8_t system = 1, std::uint32_t id = 0) {
        const wire::MessageInfo info{MessageId{id}, 50, 9, 9};
        frame = wire::write_frame(buffer, {wire::Version::v2, 0, {SystemId{system}, ComponentId{1}}}, info, {});
    }
    wire::FrameBuffer buffer{};
    wire::FrameView frame;
};

Limiter limiter_of(const std::vector<RateTerm>& terms) { return Limiter(*Rates::compile(default_dialect(), terms)); }

int admitted(Limiter& limiter, const Heartbeat& heartbeat, Nanoseconds period, int frames) {
    int count = 0;
    for (int i = 0; i < frames; ++i) count += limiter.admit(heartbeat.frame, t0 + i * period);
    return count;
}

TEST(RateLimiter, WithoutRatesAdmitsEverything) {
    Limiter sut;

    EXPECT_EQ(admitted(sut, Heartbeat(), 0ns, 100), 100);
}

TEST(RateLimiter, KeepsTheRateOfAStreamThatIsALittleFaster) {
    Limiter sut = limiter_of({{"HEARTBEAT", 10}});

    EXPECT_NEAR(admitted(sut, Heartbeat(), 83333333ns, 1200), 1000, 1);  // 12 Hz for 100 s, limited to 10 Hz
}

// Issue 30: 4.60 of 5 Hz and 9.60 of 10 Hz passed a limit of their own rate.
TEST(RateLimiter, AStreamOfTheLimitsRatePassesWholeDespiteJitter) {
    for (const double rate : {0.2, 1.0, 5.0, 10.0, 50.0, 250.0}) {
        Limiter sut = limiter_of({{"HEARTBEAT", rate}});
        const auto interval = std::chrono::duration_cast<Nanoseconds>(std::chrono::duration<double>(1 / rate));
        const auto jitter = std::min<Nanoseconds>(interval, 1s).count() / 1000;
        std::minstd_rand random(1);
        int passed = 0;
        for (int i = 0; i < 1000; ++i) {
            const Nanoseconds late{static_cast<std::int64_t>(random() % 490) * jitter};
            passed += sut.admit(Heartbeat().frame, t0 + i * interval + late);
        }
        EXPECT_EQ(passed, 1000) << rate << " Hz";
    }
}

TEST(RateLimiter, AStreamThatARadioDeliversInBundlesPassesWhole) {
    Limiter sut = limiter_of({{"HEARTBEAT", 50}});
    int passed = 0;
    for (int bundle = 0; bundle < 1000; ++bundle) {  // three frames every 60 ms; every second bundle is late
        const auto arrival = t0 + bundle * 60ms + bundle % 2 * 15ms;
        for (int i = 0; i < 3; ++i) passed += sut.admit(Heartbeat().frame, arrival);
    }
    EXPECT_EQ(passed, 3000);
}

TEST(RateLimiter, JitterDoesNotRaiseTheRate) {
    Limiter sut = limiter_of({{"HEARTBEAT", 10}});
    std::minstd_rand random(1);
    int passed = 0;
    for (int ms = 0; ms < 100'000; ms += static_cast<int>(random() % 30))
        passed += sut.admit(Heartbeat().frame, t0 + ms * 1ms);
    EXPECT_NEAR(passed, 1000, 2);
}

TEST(RateLimiter, LeavesSlowerStreamsAlone) {
    Limiter sut = limiter_of({{"HEARTBEAT", 10}});

    EXPECT_EQ(admitted(sut, Heartbeat(), 100ms, 100), 100);
    EXPECT_TRUE(sut.admit(Heartbeat().frame, t0 + 1h));
    EXPECT_FALSE(sut.admit(Heartbeat().frame, t0 + 1h + 50ms));  // silence earns no burst
    EXPECT_TRUE(sut.admit(Heartbeat().frame, t0 + 1h + 100ms));
}

TEST(RateLimiter, CountsSourcesAndMessagesApart) {
    Limiter sut = limiter_of({{"HEARTBEAT", 1}});

    EXPECT_TRUE(sut.admit(Heartbeat(1).frame, t0));
    EXPECT_TRUE(sut.admit(Heartbeat(2).frame, t0));
    EXPECT_FALSE(sut.admit(Heartbeat(1).frame, t0));
    EXPECT_TRUE(sut.admit(Heartbeat(1, 30).frame, t0));  // no rate given for id 30
    EXPECT_TRUE(sut.admit(Heartbeat(1, 30).frame, t0));
}

TEST(RateLimiter, EachLaneHasTheWholeRate) {
    Limiter sut = limiter_of({{"HEARTBEAT", 1}});
    const Heartbeat heartbeat;

    for (std::uint8_t lane = 0; lane < 2; ++lane) {
        const auto answer = sut.ask(heartbeat.frame, t0, lane);
        EXPECT_TRUE(answer.admitted);
        Limiter::count(answer, t0);
        EXPECT_FALSE(sut.ask(heartbeat.frame, t0, lane).admitted);
    }
}

TEST(RateLimiter, TheRateForOthersIsForEachOfThem) {
    Limiter sut = limiter_of({{"HEARTBEAT", 1}, {"*", 0.5}});

    EXPECT_TRUE(sut.admit(Heartbeat(1, 30).frame, t0));
    EXPECT_TRUE(sut.admit(Heartbeat(1, 31).frame, t0));
    EXPECT_FALSE(sut.admit(Heartbeat(1, 30).frame, t0 + 1s));
    EXPECT_TRUE(sut.admit(Heartbeat(1, 0).frame, t0));
    EXPECT_TRUE(sut.admit(Heartbeat(1, 0).frame, t0 + 1s));
}

TEST(RateLimiter, AClockSetBackDoesNotSilenceAStream) {
    Limiter sut = limiter_of({{"HEARTBEAT", 1}});
    EXPECT_TRUE(sut.admit(Heartbeat().frame, t0));

    EXPECT_TRUE(sut.admit(Heartbeat().frame, t0 - 1h));
    EXPECT_FALSE(sut.admit(Heartbeat().frame, t0 - 1h + 500ms));
    EXPECT_TRUE(sut.admit(Heartbeat().frame, t0 - 1h + 1s));
}

TEST(RateLimiter, AFrameThatWasAskedForOnlyIsNotCounted) {
    Limiter sut = limiter_of({{"HEARTBEAT", 1}});
    const Heartbeat heartbeat;

    EXPECT_TRUE(sut.ask(heartbeat.frame, t0).admitted);
    EXPECT_TRUE(sut.admit(heartbeat.frame, t0));
    EXPECT_FALSE(sut.ask(heartbeat.frame, t0).admitted);
}

TEST(RateLimiter, MoreStreamsThanItRemembersStillPass) {
    Limiter sut = limiter_of({{"*", 1}});
    int count = 0;
    for (std::uint32_t id = 100'000; id < 200'000; ++id)
        count += sut.admit(Heartbeat(1, id).frame, t0);  // no definition

    EXPECT_EQ(count, 100'000);
}

}  // namespace
}  // namespace mavloom::dialect
