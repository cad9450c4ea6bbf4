// SPDX-License-Identifier: MIT
// The ranks of links: docs/guide/routing.md, "Trust", rule 1. Module route tests what they decide.
#include <ifaddrs.h>
#include <sys/stat.h>

#include <fstream>

#include "link/core/core.hpp"
#include "support/temp_dir.hpp"
#include "unit/link/fixture.hpp"

namespace mavloom::link {
namespace {

using namespace testing;

// ---- by address -----------------------------------------------------------------------------------------------------

class RankOf : public ::testing::Test {
protected:
    Rank rank(const char* host, std::optional<bool> trusted = {}) {
        endpoint::EndpointOptions options;
        options.trusted = trusted;
        return core_.rank_of(options, *net::Address::parse(host, 14550));
    }

private:
    detail::Core core_{dialect::default_dialect(), std::move(*net::EventLoop::create()),
                       std::move(*net::ReceiveBatch::create())};
};

// Addresses of this machine that are not loopback, without those of one link only.
std::vector<std::string> addresses_here(int family) {
    std::vector<std::string> found;
    ifaddrs* all = nullptr;
    if (getifaddrs(&all) != 0) return found;
    for (const ifaddrs* it = all; it != nullptr; it = it->ifa_next) {
        if (it->ifa_addr == nullptr || it->ifa_addr->sa_family != family) continue;
        const socklen_t size = family == AF_INET ? sizeof(sockaddr_in) : sizeof(sockaddr_in6);
        const std::string text = net::Address::from_sockaddr(it->ifa_addr, size)->host_text();
        if (!text.starts_with("127.") && text != "::1" && !text.starts_with("fe80")) found.push_back(text);
    }
    freeifaddrs(all);
    return found;
}

constexpr const char *near[] = {"127.0.0.1", "127.9.8.7", "::1", "::ffff:127.0.0.1"},
                     *far[] = {"10.254.253.252", "192.0.2.1", "2001:db8::1", "::ffff:192.0.2.1", "::ffff:128.0.0.1"};

TEST_F(RankOf, LoopbackIsOwnAndOtherMachinesAreStrangers) {
    for (const char* host : near) EXPECT_EQ(rank(host), Rank::own) << host;
    for (const char* host : far) EXPECT_EQ(rank(host), Rank::stranger) << host;
}

TEST_F(RankOf, AnIpv4AddressOfThisMachineIsOwn) {
    const auto hosts = addresses_here(AF_INET);
    if (hosts.empty()) GTEST_SKIP() << "this machine has loopback addresses only";
    for (const auto& host : hosts) {
        EXPECT_EQ(rank(host.c_str()), Rank::own) << host;
        EXPECT_EQ(rank(("::ffff:" + host).c_str()), Rank::own) << host;
        EXPECT_EQ(rank(host.c_str(), false), Rank::stranger) << host;
    }
}

// The kernel lets datagrams in that come from outside with such an address.
TEST_F(RankOf, AnIpv6AddressOfThisMachineIsAStranger) {
    const auto hosts = addresses_here(AF_INET6);
    if (hosts.empty()) GTEST_SKIP() << "this machine has no IPv6 address";
    for (const auto& host : hosts) EXPECT_EQ(rank(host.c_str()), Rank::stranger) << host;
}

TEST_F(RankOf, TrustedDecidesForAllAddresses) {
    for (const auto& hosts : {std::span<const char* const>(near), std::span<const char* const>(far)})
        for (const char* host : hosts) {
            EXPECT_EQ(rank(host, true), Rank::own) << host;
            EXPECT_EQ(rank(host, false), Rank::stranger) << host;
        }
}

// ---- by endpoint ----------------------------------------------------------------------------------------------------

class RankOfLinks : public ::testing::Test {
protected:
    // The rank of the one link that is up.
    Rank rank() {
        EXPECT_TRUE(until([&] { return !node.recorder.ups.empty(); }, node));
        return node.links->rank(node.recorder.ups.back().first);
    }
    // The rank of somebody on loopback who sends to this endpoint that listens.
    Rank rank_of_peer(const std::string& url) {
        const bool is_tcp = url.starts_with("tcp");
        const std::uint16_t port = node.port(node.add(url));
        const PlainSocket peer = is_tcp ? PlainSocket::connected_tcp(port) : PlainSocket::udp();
        if (!is_tcp) peer.send_to(port, heartbeat(0));
        return rank();
    }
    std::string key_file() {
        std::ofstream(dir_ / "key") << std::string(64, 'a') << '\n';
        ::chmod((dir_ / "key").c_str(), 0600);
        return (dir_ / "key").string();
    }

    Node node;

private:
    mavloom::test::TempDir dir_;
};

TEST_F(RankOfLinks, AFarSideThatTheUserNamedIsOwn) {
    node.add("udpout://192.0.2.1:14550");
    EXPECT_EQ(rank(), Rank::own);
}

TEST_F(RankOfLinks, AServerThatTheUserNamedIsOwn) {
    Node server;
    node.add(fmt::format("tcpout://127.0.0.1:{}", server.port(server.add("tcpin://127.0.0.1:0?trusted=false"))));
    ASSERT_TRUE(until([&] { return !node.recorder.ups.empty() && !server.recorder.ups.empty(); }, node, server));
    EXPECT_EQ(rank(), Rank::own);
    EXPECT_EQ(server.links->rank(server.recorder.ups[0].first), Rank::stranger);
}

TEST_F(RankOfLinks, APeerGetsTheRankOfItsAddressOrOfTrusted) {
    for (const char* scheme : {"udpin", "tcpin"})
        for (const auto& [options, expected] :
             {std::pair{"", Rank::own}, {"?trusted=true", Rank::own}, {"?trusted=false", Rank::stranger}}) {
            node = {};
            EXPECT_EQ(rank_of_peer(fmt::format("{}://127.0.0.1:0{}", scheme, options)), expected) << scheme << options;
        }
}

// Anybody may answer or send there, also from this machine.
TEST_F(RankOfLinks, BroadcastsAndGroupsAreStrangersUnlessTrusted) {
    for (const char* url : {"udpbcast://127.255.255.255:14550?fixed=true", "udpmcast://239.255.145.50:14550?iface=lo"})
        for (const auto& [options, expected] :
             {std::pair{"", Rank::stranger}, {"&trusted=true", Rank::own}, {"&trusted=false", Rank::stranger}}) {
            node = {};
            node.add(fmt::format("{}{}", url, options));
            EXPECT_EQ(rank(), expected) << url << options;
        }
}

TEST_F(RankOfLinks, WhoAnswersABroadcastGetsTheRankOfItsAddress) {
    for (const auto& [options, expected] : {std::pair{"", Rank::own}, {"?trusted=false", Rank::stranger}}) {
        node = {};
        EXPECT_EQ(rank_of_peer(fmt::format("udpbcast://127.255.255.255:14550{}", options)), expected) << options;
    }
}

TEST_F(RankOfLinks, VerifyDecidesBeforeAllElse) {
    const std::string verify = "verify=" + key_file();
    for (const std::string& url :
         {"udpout://192.0.2.1:14550?" + verify, "udpbcast://127.255.255.255:14550?fixed=true&trusted=false&" + verify,
          "udpmcast://239.255.145.50:14550?iface=lo&trusted=true&" + verify}) {
        node = {};
        node.add(url);
        EXPECT_EQ(rank(), Rank::verified) << url;
    }
    node = {};
    EXPECT_EQ(rank_of_peer("tcpin://127.0.0.1:0?trusted=false&" + verify), Rank::verified);
}

TEST_F(RankOfLinks, NoLinkIsAStranger) { EXPECT_EQ(node.links->rank(LinkId{77}), Rank::stranger); }

}  // namespace
}  // namespace mavloom::link
