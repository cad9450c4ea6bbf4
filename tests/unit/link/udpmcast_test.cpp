// SPDX-License-Identifier: MIT
// IPv4 over the loopback interface, which carries its groups when it is named; IPv6 groups have no route there and take
// another interface, with ttl=0, so that nothing leaves this machine.
#include <ifaddrs.h>
#include <net/if.h>

#include "unit/link/fixture.hpp"

namespace mavloom::link {
namespace {

using namespace testing;
using ::testing::HasSubstr;
using ::testing::SizeIs;

// Empty: there is none.
std::string interface_for(int family) {
    if (family == AF_INET) return "lo";
    std::string found;
    ifaddrs* all = nullptr;
    if (getifaddrs(&all) != 0) return found;
    for (const ifaddrs* it = all; it != nullptr && found.empty(); it = it->ifa_next) {
        const bool usable = (it->ifa_flags & IFF_UP) != 0 && (it->ifa_flags & IFF_MULTICAST) != 0;
        if (usable && it->ifa_addr != nullptr && it->ifa_addr->sa_family == AF_INET6) found = it->ifa_name;
    }
    freeifaddrs(all);
    return found;
}

class LinksUdpMulticast : public ::testing::TestWithParam<const char*> {
protected:
    // A port that nobody has a moment ago.
    LinksUdpMulticast() : port_(PlainSocket::udp().port()) {}
    void SetUp() override {
        if (interface_.empty()) GTEST_SKIP() << "no interface with IPv6 and multicast here";
    }
    [[nodiscard]] std::string url() const {
        return fmt::format("udpmcast://{}:{}?iface={}&ttl=0", GetParam(), port_, interface_);
    }
    std::string interface_ = interface_for(GetParam()[0] == '[' ? AF_INET6 : AF_INET);
    std::uint16_t port_;
};

INSTANTIATE_TEST_SUITE_P(Families, LinksUdpMulticast,
                         ::testing::Values("239.255.145.50", "[ff02::4d41]", "[ff15::4d41]"),
                         [](const auto& family) { return "Group" + std::to_string(family.index); });

TEST_P(LinksUdpMulticast, ThreeProgramsOfOneMachineHearEachOtherAndNotThemselves) {
    Node a, b, c;
    const auto in_a = a.add(url()), in_b = b.add(url());
    c.add(url());
    EXPECT_EQ(a.links->send(in_a, view(heartbeat(1))), 1u);
    EXPECT_EQ(b.links->send(in_b, view(heartbeat(2))), 1u);
    ASSERT_TRUE(until([&] { return c.recorder.frames.size() == 2; }, a, b, c));
    ASSERT_TRUE(until([&] { return a.recorder.frames.size() == 1 && b.recorder.frames.size() == 1; }, a, b, c));
    EXPECT_EQ(a.recorder.bytes(), heartbeat(2));
    EXPECT_EQ(b.recorder.bytes(), heartbeat(1));
    EXPECT_THAT(c.links->links(), SizeIs(1));
}

TEST(LinksUdpMulticastSetup, AnInterfaceThatIsNotThereIsAwaitedOrRefused) {
    Node node;
    node.add("udpmcast://239.255.145.50:14550?iface=no-such-one");
    ASSERT_TRUE(until([&] { return !node.recorder.notices.empty(); }, node));
    EXPECT_THAT(node.recorder.notices[0], HasSubstr("there is no interface 'no-such-one'; there are lo"));
    const std::string required = "udpmcast://239.255.145.51:14550?iface=no-such-one&required=true";
    node.add(required);  // counts at the start only
    EXPECT_EQ(Node().refused(required).code, SetupCode::not_found);
}

TEST(LinksUdpMulticastSetup, TheInterfaceOfAZoneIsAwaitedToo) {
    Node node;
    node.add("udpmcast://[ff02::4d41%25no-such-one]:14550");
    ASSERT_TRUE(until([&] { return !node.recorder.notices.empty(); }, node));
    EXPECT_THAT(node.recorder.notices[0], HasSubstr("there is no interface 'no-such-one'; there are lo"));
}

TEST(LinksUdpMulticastSetup, APortThatIsNotSharedIsInUse) {
    sockaddr_in any{};
    any.sin_family = AF_INET;
    const int alone = ::socket(AF_INET, SOCK_DGRAM, 0);
    ASSERT_EQ(::bind(alone, reinterpret_cast<sockaddr*>(&any), sizeof any), 0);
    socklen_t length = sizeof any;
    getsockname(alone, reinterpret_cast<sockaddr*>(&any), &length);
    Node node;
    EXPECT_EQ(node.refused(fmt::format("udpmcast://239.255.145.50:{}?iface=lo", ntohs(any.sin_port))).code,
              SetupCode::in_use);
    ::close(alone);
}

}  // namespace
}  // namespace mavloom::link
