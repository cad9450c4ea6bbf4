// SPDX-License-Identifier: MIT
#include "link/admission.hpp"

#include <gtest/gtest.h>

#include <string>

namespace mavloom::link::detail {
namespace {

using namespace std::chrono_literals;

net::Address sender(std::uint32_t number) {
    const std::string host = "10.0.0." + std::to_string(1 + number / 65000);
    return *net::Address::parse(host, static_cast<std::uint16_t>(1 + number % 65000));
}

constexpr MonoTime start{std::chrono::hours{1000}};

bool admits(Admission& admission, const net::Address& who, MonoTime now) {
    return admission.ask(who, now) == Admission::Answer::admitted;
}

Admission used_up(std::size_t burst) {
    Admission admission(burst);
    for (std::uint32_t i = 0; i < burst; ++i) {
        EXPECT_TRUE(admits(admission, sender(1000 + i), start));
        admission.note_entry();
    }
    return admission;
}

TEST(Admission, LetsABurstInThenFiftyASecond) {
    Admission sut = used_up(64);
    EXPECT_FALSE(admits(sut, sender(1), start));

    int entered = 0;
    for (int ms = 1; ms <= 1000; ++ms) {
        if (!admits(sut, sender(static_cast<std::uint32_t>(2000 + ms)), start + ms * 1ms)) continue;
        sut.note_entry();
        ++entered;
    }

    EXPECT_EQ(entered, 50);
}

TEST(Admission, LetsASenderInThatRepeatsWithinTenSeconds) {
    for (const auto& [wait, enters] : {std::pair{499ms, false}, std::pair{500ms, true}, std::pair{10'000ms, true}}) {
        Admission sut = used_up(64);
        ASSERT_FALSE(admits(sut, sender(1), start));
        // A flood keeps the steady rate used up.
        for (int i = 0; i < 600; ++i) {
            const MonoTime now = start + wait * i / 600;
            if (admits(sut, sender(static_cast<std::uint32_t>(2000 + i)), now)) sut.note_entry();
        }
        while (admits(sut, sender(70000), start + wait)) sut.note_entry();

        EXPECT_EQ(admits(sut, sender(1), start + wait), enters) << wait.count();
    }
}

TEST(Admission, ASenderThatComesBackAfterALongTimeIsNew) {
    Admission sut = used_up(64);
    ASSERT_FALSE(admits(sut, sender(1), start));
    const MonoTime later = start + 10'001ms;
    while (admits(sut, sender(70000), later)) sut.note_entry();

    EXPECT_FALSE(admits(sut, sender(1), later));
    EXPECT_TRUE(admits(sut, sender(1), later + 500ms));
}

// 12,000 addresses, each of which sends every 0.6 s.
TEST(Admission, LetsAHundredRepeatersInASecond) {
    Admission sut = used_up(64);
    int entered = 0, limited = 0;
    for (std::uint32_t i = 0; i < 120'000; ++i) {
        const auto answer = sut.ask(sender(i % 12'000), start + i * 50us);
        if (answer == Admission::Answer::admitted) {
            sut.note_entry();
            ++entered;
        }
        limited += answer == Admission::Answer::limited ? 1 : 0;
    }

    EXPECT_GE(entered, 6 * (50 + 100) - 100);
    EXPECT_LE(entered, 6 * (50 + 100) + 100);
    EXPECT_GT(limited, 100'000);
}

// 200,000 addresses in a second: three times as many as the table has room for.
TEST(Admission, LetsARepeaterInAtOnceAmongInventedAddresses) {
    constexpr std::uint32_t invented = 200'000;
    const net::Address repeater = sender(invented);
    Admission sut = used_up(64);
    for (std::uint32_t i = 0; i < invented; ++i) {
        const MonoTime now = start + i * 5us;
        if (admits(sut, sender(i), now)) sut.note_entry();
        if (i == 100) {
            ASSERT_FALSE(admits(sut, repeater, now));
        }
    }

    EXPECT_TRUE(admits(sut, repeater, start + invented * 5us));
}

}  // namespace
}  // namespace mavloom::link::detail
