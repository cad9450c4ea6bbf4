// SPDX-License-Identifier: MIT
// Announcements as rtnetlink(7) describes them: an nlmsghdr, an ndmsg and attributes.
#include "mavloom/net/neighbours.hpp"

#include <gmock/gmock.h>
#include <linux/neighbour.h>
#include <linux/rtnetlink.h>

#include <string>

namespace mavloom::net {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

template <class T>
std::string bytes_of(const T& value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

std::string attribute(std::uint16_t type, const std::string& payload) {
    const auto length = static_cast<std::uint16_t>(sizeof(rtattr) + payload.size());
    return bytes_of(rtattr{length, type}) + payload + std::string((4 - payload.size() % 4) % 4, '\0');
}

std::string announcement(std::uint16_t type, std::uint8_t family, int state, const std::string& host) {
    ndmsg about{};
    about.ndm_family = family;
    about.ndm_ifindex = 7;
    about.ndm_state = static_cast<std::uint16_t>(state);
    const std::string hardware("\x02\0\0\0\0\x01", 6);
    const auto body = bytes_of(about) + attribute(NDA_LLADDR, hardware) + attribute(NDA_DST, host);
    nlmsghdr header{};
    header.nlmsg_len = static_cast<std::uint32_t>(sizeof header + body.size());
    header.nlmsg_type = type;
    return bytes_of(header) + body;
}

const std::string v4("\x0a\x4d\x00\x0c", 4), v6("\xfe\x80\0\0\0\0\0\0\0\0\0\0\0\0\0\x01", 16);

std::vector<std::string> changes_in(const std::string& datagram) {
    std::vector<NeighbourWatch::Change> changes;
    NeighbourWatch::parse({reinterpret_cast<const std::uint8_t*>(datagram.data()), datagram.size()}, changes);
    std::vector<std::string> texts;
    for (const auto& change : changes)
        texts.push_back(change.host.text() + "/" + std::to_string(change.host.scope()) +
                        (change.answers ? " up" : " gone") + " on " + std::to_string(change.interface));
    return texts;
}

TEST(Neighbours, HostsThatAreGoneAndHostsThatAnswer) {
    EXPECT_THAT(changes_in(announcement(RTM_NEWNEIGH, AF_INET, NUD_FAILED, v4)),
                ElementsAre("10.77.0.12:0/0 gone on 7"));
    for (const int state : {NUD_REACHABLE, NUD_STALE, NUD_DELAY, NUD_PROBE, NUD_PERMANENT, NUD_NOARP})
        EXPECT_THAT(changes_in(announcement(RTM_NEWNEIGH, AF_INET, state, v4)), ElementsAre("10.77.0.12:0/0 up on 7"));
}

TEST(Neighbours, SeveralInOneDatagramAndLinkLocalOnesWithTheirInterface) {
    EXPECT_THAT(changes_in(announcement(RTM_NEWNEIGH, AF_INET, NUD_FAILED, v4) +
                           announcement(RTM_NEWNEIGH, AF_INET6, NUD_REACHABLE, v6)),
                ElementsAre("10.77.0.12:0/0 gone on 7", ::testing::EndsWith("/7 up on 7")));
}

TEST(Neighbours, OtherAnnouncementsChangeNothing) {
    EXPECT_THAT(changes_in(announcement(RTM_NEWNEIGH, AF_INET, NUD_INCOMPLETE, v4)), IsEmpty());
    EXPECT_THAT(changes_in(announcement(RTM_DELNEIGH, AF_INET, NUD_FAILED, v4)), IsEmpty());
    EXPECT_THAT(changes_in(announcement(RTM_NEWNEIGH, AF_BRIDGE, NUD_FAILED, v4)), IsEmpty());
    EXPECT_THAT(changes_in(announcement(RTM_NEWNEIGH, AF_INET, NUD_FAILED, v6)), IsEmpty());
}

TEST(Neighbours, WhatIsCutOrMalformedIsIgnored) {
    const auto whole = announcement(RTM_NEWNEIGH, AF_INET, NUD_FAILED, v4);
    for (std::size_t size = 0; size < whole.size(); ++size) EXPECT_THAT(changes_in(whole.substr(0, size)), IsEmpty());
    for (std::size_t at = 0; at < whole.size(); ++at)
        for (const char byte : {'\0', '\x01', '\x7f', '\xff'}) {
            auto damaged = whole;
            damaged[at] = byte;
            EXPECT_LE(changes_in(damaged).size(), 1u);
        }
}

TEST(Neighbours, AnyUserMayWatch) {
    const auto sut = NeighbourWatch::open();
    EXPECT_TRUE(sut) << sut.error().text;
}

TEST(Neighbours, TheInterfaceThatLeadsToAHost) {
    const auto loopback = index_of_zone("lo");
    const auto v4 = *Address::parse("127.0.0.1", 14550), v6 = *Address::parse("::1", 0), any = *Address::parse("::", 0);
    EXPECT_EQ(interface_to(v4, any, 0), loopback);
    EXPECT_EQ(interface_to(v4, v4, loopback), loopback);
    EXPECT_EQ(interface_to(*Address::parse("::ffff:127.0.0.1", 0), any, 0), loopback);
    EXPECT_EQ(interface_to(v6, v6, 0), loopback);
    EXPECT_EQ(interface_to(v4, any, 1u << 30), 0u) << "no such interface";
    EXPECT_EQ(interface_to(v4, *Address::parse("127.255.255.255", 0), 0), loopback);
    EXPECT_EQ(interface_to(Address::parse("fe80::1", 0)->with_scope(7), any, 0), 7u);
}

}  // namespace
}  // namespace mavloom::net
