// SPDX-License-Identifier: MIT
#include "mavloom/net/interfaces.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace mavloom::net {
namespace {

TEST(Interfaces, AreFoundByName) {
    EXPECT_EQ(interface_index("lo").value_or(0), 1u);
    const auto missing = interface_index("no-such-one");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, SetupCode::not_found);
    EXPECT_THAT(missing.error().text, ::testing::HasSubstr("there are lo"));
}

TEST(OwnAddresses, KnowThisMachineWhateverThePort) {
    OwnAddresses own;
    const MonoTime now = mono_now();
    EXPECT_FALSE(own.contains(*Address::parse("192.0.2.1", 14550), now));
    EXPECT_TRUE(own.contains(*Address::parse("127.0.0.1", 14550), now));
    EXPECT_FALSE(own.contains(*Address::parse("127.0.0.2", 14550), now + std::chrono::seconds(2)));
}

TEST(OwnAddresses, KnowTheBroadcastAddressOfAllNetworks) {
    OwnAddresses own;
    EXPECT_TRUE(own.has_broadcast(*Address::parse("255.255.255.255", 14550), mono_now()));
    EXPECT_FALSE(own.has_broadcast(*Address::parse("127.0.0.1", 14550), mono_now()));
}

}  // namespace
}  // namespace mavloom::net
