// SPDX-License-Identifier: MIT
#include "runtime/echo_filter.hpp"

#include <gtest/gtest.h>

#include <array>

namespace mavloom::runtime::detail {
namespace {

using namespace std::chrono_literals;

// A MAVLink 1 frame without payload; the filter looks at no checksum's truth.
struct Bytes {
    std::array<std::uint8_t, 8> data;
    explicit Bytes(std::uint8_t sequence, std::uint8_t system = 255, std::uint8_t low_checksum = 7)
        : data{0xFE, 0, sequence, system, 190, 0, low_checksum, 9} {}
    [[nodiscard]] wire::FrameView frame() const { return wire::FrameView::unchecked(data); }
};

const MonoTime start{1h};

TEST(EchoFilter, TakesBackWhatWasSentOnce) {
    EchoFilter filter;
    const Bytes sent(1), other_sequence(2), other_checksum(1, 255, 8), other_system(1, 1);
    filter.remember(sent.frame(), start);

    EXPECT_TRUE(filter.knows(SystemId{255}));
    EXPECT_FALSE(filter.knows(SystemId{1}));
    EXPECT_FALSE(filter.takes_back(other_sequence.frame(), start));
    EXPECT_FALSE(filter.takes_back(other_checksum.frame(), start));
    EXPECT_FALSE(filter.takes_back(other_system.frame(), start));
    EXPECT_TRUE(filter.takes_back(sent.frame(), start + 2s));
    EXPECT_FALSE(filter.takes_back(sent.frame(), start + 2s));
}

TEST(EchoFilter, ForgetsAfterTwoSeconds) {
    EchoFilter filter;
    const Bytes sent(1);
    filter.remember(sent.frame(), start);

    EXPECT_FALSE(filter.takes_back(sent.frame(), start + 2s + 1ns));
}

TEST(EchoFilter, RemembersAsManyAsAreSentAtOnce) {
    EchoFilter filter;
    for (int n = 0; n < 256; ++n) filter.remember(Bytes(static_cast<std::uint8_t>(n)).frame(), start);

    for (int n = 0; n < 256; ++n)
        EXPECT_TRUE(filter.takes_back(Bytes(static_cast<std::uint8_t>(n)).frame(), start)) << n;
}

}  // namespace
}  // namespace mavloom::runtime::detail
