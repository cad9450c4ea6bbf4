// SPDX-License-Identifier: MIT
#include "mavloom/net/address.hpp"

#include <gtest/gtest.h>

namespace mavloom::net {
namespace {

TEST(Address, ReadsNumbersOnly) {
    EXPECT_EQ(Address::parse("127.0.0.1", 14550)->text(), "127.0.0.1:14550");
    EXPECT_EQ(Address::parse("::1", 5760)->text(), "[::1]:5760");
    EXPECT_EQ(Address::parse("2001:db8:0:0::7", 1)->text(), "[2001:db8::7]:1");
    for (const auto* text :
         {"", "localhost", "127.0.0", "127.0.0.1 ", "256.1.1.1", "[::1]", "::1%", "fe80::1%no_such_interface", ":::"}) {
        EXPECT_FALSE(Address::parse(text, 1)) << text;
    }
}

TEST(Address, KnowsTheScopeOfALinkLocalAddress) {
    const auto by_number = Address::parse("fe80::1%1", 9), by_name = Address::parse("fe80::1%lo", 9);
    ASSERT_TRUE(by_number);
    ASSERT_TRUE(by_name);
    EXPECT_EQ(*by_number, *by_name);
    EXPECT_EQ(by_number->text(), "[fe80::1%1]:9");
}

TEST(Address, RecognisesMulticastAndBroadcast) {
    EXPECT_TRUE(Address::parse("0.0.0.0", 1)->is_any());
    EXPECT_TRUE(Address::parse("::", 1)->is_any());
    EXPECT_FALSE(Address::parse("0.0.0.1", 1)->is_any());
    EXPECT_TRUE(Address::parse("224.0.0.1", 1)->is_multicast());
    EXPECT_TRUE(Address::parse("239.255.255.255", 1)->is_multicast());
    EXPECT_FALSE(Address::parse("240.0.0.1", 1)->is_multicast());
    EXPECT_TRUE(Address::parse("ff02::1", 1)->is_multicast());
    EXPECT_TRUE(Address::parse("255.255.255.255", 1)->is_broadcast());
}

TEST(Address, AnIpv4PeerOfADualStackSocketShowsAsIpv4) {
    EXPECT_EQ(Address::parse("::ffff:10.1.2.3", 7)->text(), "10.1.2.3:7");
}

TEST(Address, EqualityAndHashGoByFamilyAddressAndPort) {
    const auto a = *Address::parse("10.0.0.1", 1), same = *Address::parse("10.0.0.1", 1);
    EXPECT_EQ(a, same);
    EXPECT_EQ(a.hash(), same.hash());
    EXPECT_NE(a, a.with_port(2));
    EXPECT_NE(a, *Address::parse("10.0.0.2", 1));
    EXPECT_NE(*Address::parse("::1", 1), *Address::parse("::2", 1));
    EXPECT_NE(*Address::parse("fe80::1%1", 1), *Address::parse("fe80::1%2", 1));
    EXPECT_EQ(a.with_port(9).port(), 9);
}

TEST(Address, FlowLabelsDoNotMakeAnotherPeer) {
    sockaddr_in6 raw{};
    raw.sin6_family = AF_INET6;
    raw.sin6_addr = in6addr_loopback;
    const auto plain = Address::from_sockaddr(reinterpret_cast<sockaddr*>(&raw), sizeof raw);
    raw.sin6_flowinfo = 77;
    EXPECT_EQ(plain, Address::from_sockaddr(reinterpret_cast<sockaddr*>(&raw), sizeof raw));
}

TEST(Address, RefusesOtherFamiliesAndShortLengths) {
    sockaddr_in6 raw{};
    raw.sin6_family = AF_INET6;
    EXPECT_FALSE(Address::from_sockaddr(reinterpret_cast<sockaddr*>(&raw), sizeof(sockaddr_in)));
    raw.sin6_family = AF_UNIX;
    EXPECT_FALSE(Address::from_sockaddr(reinterpret_cast<sockaddr*>(&raw), sizeof raw));
    EXPECT_FALSE(Address::from_sockaddr(nullptr, 0));
}

// RFC 4291, section 2.5.1: the interface identifier, which a host chooses, is 64 bits.
TEST(Address, TheHostPartLeavesOutWhatAHostMayChoose) {
    const auto part = [](std::string_view host) { return Address::parse(host, 7)->host_part().text(); };

    EXPECT_EQ(part("192.0.2.1"), "192.0.2.1:0");
    EXPECT_EQ(part("::ffff:192.0.2.1"), "192.0.2.1:0");
    EXPECT_EQ(part("2001:db8:1:2:3:4:5:6"), "[2001:db8:1:2::]:0");
    EXPECT_EQ(part("fe80::3:4:5:6"), "[fe80::3:4:5:6]:0");
}

TEST(Address, AnIpv4PeerOfADualStackSocketIsUnmapped) {
    EXPECT_EQ(Address::parse("::ffff:192.0.2.1", 7)->unmapped(), *Address::parse("192.0.2.1", 7));
    EXPECT_EQ(Address::parse("2001:db8::1", 7)->unmapped(), *Address::parse("2001:db8::1", 7));
    EXPECT_EQ(Address::parse("192.0.2.1", 7)->unmapped(), *Address::parse("192.0.2.1", 7));
}

}  // namespace
}  // namespace mavloom::net
