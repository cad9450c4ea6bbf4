// SPDX-License-Identifier: MIT
// Options that Links refuses, and its error messages.
#include <sys/stat.h>

#include <fstream>
#include <set>

#include "mavloom/wire/crc.hpp"
#include "unit/link/fixture.hpp"

namespace mavloom::link {
namespace {

using namespace testing;
using ::testing::AllOf;
using ::testing::HasSubstr;

struct Refusal {
    const char* url;
    const char* says;
};

TEST(LinksOptions, NothingIsSilentlyIgnored) {
    for (const auto& [url, says] : {
             Refusal{"shm://ring?lossless=false", "'lossless' applies to a ring that is read"},
             Refusal{"shm://ring?from=oldest", "'from' applies to a ring that is read"},
             Refusal{"shm://ring?verify=key", "set verify= at the endpoint that receives the frames"},
             Refusal{"shm://ring?tap=true", "tap= applies only to mavloom route"},
             Refusal{"tlog://flight.tlog", "a recording is not a link"},
             Refusal{"udpin://127.0.0.1:1?group=air", "group= applies only to mavloom route"},
             Refusal{"udpin://127.0.0.1:1?max_rate=ATTITUDE:10", "max_rate= applies only to mavloom route"},
             Refusal{"udpin://127.0.0.1:1?max_bytes=5000", "max_bytes= applies only to mavloom route"},
             Refusal{"udpin://127.0.0.1:1?in_allow=sys:1", "in_allow= applies only to mavloom route"},
             Refusal{"udpin://127.0.0.1:1?out_block=ATTITUDE", "out_block= applies only to mavloom route"},
             Refusal{"udpin://127.0.0.1:1?tap=true", "tap= applies only to mavloom route"},
             Refusal{"udpin://127.0.0.1:1?private=true", "private= applies only to mavloom route"},
             Refusal{"udpin://127.0.0.1:1?heartbeat=true", "heartbeat= applies only to mavloom route"},
             Refusal{"udpin://127.0.0.1:1?ttl=0", "ttl=0 keeps datagrams of a multicast group"},
             Refusal{"udpmcast://239.255.145.50:14550?max_peers=3", "max_peers= has no effect"},
             Refusal{"udpbcast://127.255.255.255:14550?fixed=true&max_peers=3", "max_peers= has no effect"},
         }) {
        Node node;
        const auto error = node.refused(url);
        EXPECT_EQ(error.code, SetupCode::usage) << url;
        EXPECT_THAT(error.text, HasSubstr(says)) << url;
    }
}

TEST(LinksOptions, AQueueHasNoMoreThanOneGibibyte) {
    Node node;
    auto endpoint = endpoint_of("udpin://127.0.0.1:0");
    endpoint.options.queue_bytes = 2'000'000'000;
    EXPECT_THAT(node.links->add(endpoint).error().text, HasSubstr("queue_bytes= goes up to 1 GiB"));
}

TEST(LinksOptions, WhatIsNoDestinationIsRefusedWithTheSpellingToType) {
    Node node;
    endpoint::Endpoint endpoint;
    endpoint.scheme = endpoint::Scheme::udpout;
    endpoint.address = {"0.0.0.0", 14550};
    auto refused = node.links->add(endpoint);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, SetupCode::usage);
    EXPECT_THAT(refused.error().text, AllOf(HasSubstr("udpin://0.0.0.0:14550"), HasSubstr("udpout://127.0.0.1:14550")));
    endpoint.address = {"::", 14550};
    EXPECT_THAT(node.links->add(endpoint).error().text,
                AllOf(HasSubstr("udpin://[::]:14550"), HasSubstr("udpout://[::1]:14550")));
    endpoint.address = {"127.0.0.1", 0};
    EXPECT_THAT(node.links->add(endpoint).error().text, HasSubstr("port 0 is not a destination"));
    endpoint.address = {"239.1.2.3", 14550};
    EXPECT_THAT(node.links->add(endpoint).error().text, HasSubstr("udpmcast://239.1.2.3:14550"));
    endpoint.scheme = endpoint::Scheme::tcpout;
    endpoint.address = {"0.0.0.0", 5760};
    EXPECT_THAT(node.links->add(endpoint).error().text, HasSubstr("tcpout://127.0.0.1:5760"));
}

TEST(LinksOptions, AnUnknownHostIsNamed) {
    Node node;
    for (const auto* scheme : {"udpin", "tcpin"}) {
        const auto error = node.refused(fmt::format("{}://no-such-host.invalid:14550", scheme));
        EXPECT_THAT(error.text, HasSubstr("no-such-host.invalid"));
    }
    node.add("udpout://no-such-host.invalid:14550");
    EXPECT_TRUE(until([&] { return !node.recorder.notices.empty(); }, node)) << "what calls tries again for ever";
    EXPECT_THAT(node.recorder.notices[0], HasSubstr("no-such-host.invalid"));
}

TEST(LinksOptions, NobodyWaitsForANameOnceTheTurnsHaveBegun) {
    Node node;
    node.poll();
    const auto in = node.add("udpin://localhost:0");
    EXPECT_EQ(node.port(in), 0u) << "its name is still looked up";
    for (const auto* scheme : {"udpout", "udpbcast", "tcpout"})
        node.add(fmt::format("{}://no-such-host.invalid:14550?required=true", scheme));
    EXPECT_TRUE(until([&] { return node.port(in) != 0; }, node));
}

TEST(LinksOptions, TwoEndpointsOfOneNameAreRefused) {
    Node node;
    node.add("udpout://127.0.0.1:14550?name=gcs");
    EXPECT_THAT(node.refused("udpout://127.0.0.1:14551?name=gcs").text, HasSubstr("two endpoints are named gcs"));
}

TEST(LinksOptions, BindFixesTheLocalSide) {
    Node node;
    const auto far = PlainSocket::udp();
    std::uint16_t port;
    { port = PlainSocket::udp().port(); }
    const auto out = node.add(fmt::format("udpout://127.0.0.1:{}?bind=127.0.0.1:{}", far.port(), port));
    EXPECT_EQ(node.port(out), port);
    EXPECT_EQ(node.refused(fmt::format("udpout://127.0.0.1:{}?bind=127.0.0.1:{}", far.port() + 1, port)).code,
              SetupCode::in_use);
}

class LinksSigning : public ::testing::Test {
protected:
    std::string key_file(char digit) {
        const std::string path = fmt::format("{}/links_key_{}_{}", ::testing::TempDir(), ::getpid(), digit);
        std::ofstream(path) << std::string(64, digit) << '\n';
        ::chmod(path.c_str(), 0600);
        files_.push_back(path);
        return path;
    }
    ~LinksSigning() override {
        for (const auto& file : files_) ::unlink(file.c_str());
    }

private:
    std::vector<std::string> files_;
};

TEST_F(LinksSigning, SignedFramesPassVerificationOthersAreCounted) {
    Node listener, right, wrong, unsigned_one;
    const auto in = listener.add("udpin://127.0.0.1:0?verify=" + key_file('a'));
    const std::string url = fmt::format("udpout://127.0.0.1:{}", listener.port(in));
    const auto from_right = right.add(url + "?sign=" + key_file('a'));
    const auto from_wrong = wrong.add(url + "?sign=" + key_file('b'));
    const auto from_unsigned = unsigned_one.add(url);
    for (std::uint8_t i = 0; i < 3; ++i) {
        right.links->send(from_right, view(attitude(i)));
        wrong.links->send(from_wrong, view(attitude(i)));
        unsigned_one.links->send(from_unsigned, view(attitude(i)));
    }
    const std::size_t unsigned_bytes = 3 * attitude(0).size(), wrong_bytes = unsigned_bytes + 3 * wire::signature_length;
    const auto& counters = *listener.info(in).counters;
    ASSERT_TRUE(until(
        [&] {
            return counters.stray_bytes.value() == unsigned_bytes + wrong_bytes && listener.recorder.frames.size() == 3;
        },
        listener, right, wrong, unsigned_one));
    EXPECT_EQ(listener.links->links().size(), 1u) << "those without a good signature are no links";
    EXPECT_EQ(counters.gone.bad_signature.value(), 6u);
    const LinkCounters& peer = listener.counters(listener.recorder.frames[0].link);
    EXPECT_EQ(peer.bad_signature.value(), 0u);
    for (const auto& heard : listener.recorder.frames) {
        EXPECT_EQ(heard.bytes.size(), attitude(0).size() + wire::signature_length);
        EXPECT_TRUE(view(heard.bytes).is_signed());
    }
}

TEST_F(LinksSigning, AReplayFromAnotherAddressMakesNoPeer) {
    Node listener, right;
    const auto in = listener.add("udpin://127.0.0.1:0?max_peers=1&verify=" + key_file('a'));
    const auto from_right = right.add(fmt::format("udpout://127.0.0.1:{}?sign={}", listener.port(in), key_file('a')));
    right.links->send(from_right, view(attitude(0)));
    ASSERT_TRUE(until([&] { return listener.recorder.frames.size() == 1; }, listener, right));
    const Bytes heard = listener.recorder.frames[0].bytes;
    PlainSocket::udp().send_to(listener.port(in), heard);
    PlainSocket::udp().send_to(listener.port(in), attitude(1));
    ASSERT_TRUE(until(
        [&] { return listener.info(in).counters->stray_bytes.value() == heard.size() + attitude(1).size(); }, listener));
    EXPECT_EQ(listener.recorder.frames.size(), 1u);
    EXPECT_EQ(listener.links->links().size(), 1u);
    EXPECT_EQ(listener.info(in).counters->peers_evicted.value(), 0u);
}

// Signed again it would have a checksum that nobody can check.
TEST_F(LinksSigning, AFrameWhoseChecksumNobodyKnowsLeavesAsItIs) {
    Node node;
    const auto far = PlainSocket::udp();
    const auto out = node.add(fmt::format("udpout://127.0.0.1:{}?sign={}", far.port(), key_file('a')));
    Bytes frame = attitude(0);
    frame[8] = 0x70;  // an id without definition
    const auto before_extra = wire::crc_update(wire::crc_seed, ByteView(frame).subspan(1, frame.size() - 3));
    const auto checksum = [&] { return static_cast<std::uint16_t>(frame[frame.size() - 2] | frame.back() << 8); };
    while (wire::crc_extra_between(before_extra, checksum()) >= 0) ++frame.back();
    EXPECT_EQ(node.links->send(out, view(frame)), 1u);
    node.poll();
    EXPECT_EQ(far.read(), frame);
}

TEST_F(LinksSigning, AMissingKeyIsAnError) {
    Node node;
    const auto error = node.refused("udpin://127.0.0.1:0?verify=/no/such/key");
    EXPECT_EQ(error.code, SetupCode::bad_input);
    EXPECT_THAT(error.text, HasSubstr("mavloom key new '/no/such/key'"));
}

// A receiver keeps a time for each link id.
TEST_F(LinksSigning, AnEndpointThatIsOpenedAgainSignsAsTheSameLink) {
    Node node;
    const auto first = PlainSocket::udp(), second = PlainSocket::udp();
    const auto url = [&](const PlainSocket& to, const char* more) {
        return fmt::format("udpout://127.0.0.1:{}?sign={}{}", to.port(), key_file('a'), more);
    };
    const auto signing_id = [&](EndpointId id, const PlainSocket& to) {
        EXPECT_EQ(node.links->send(id, view(heartbeat(0))), 1u);
        Bytes got;
        EXPECT_TRUE(until([&] { return !(got = to.read()).empty(); }, node));
        return int{got.at(heartbeat(0).size())};
    };
    const auto before = node.add(url(first, "")), other = node.add(url(second, ""));
    const auto was = signing_id(before, first), of_other = signing_id(other, second);
    node.links->remove(before);
    const auto after = node.add(url(first, "&queue_age=1"));

    EXPECT_EQ(signing_id(after, first), was);
    EXPECT_EQ(signing_id(other, second), of_other);
    EXPECT_NE(was, of_other);
}

// A signature has 8 bits for the link id: endpoints come and go, but no two that are open share one.
TEST_F(LinksSigning, EndpointsThatAreOpenNeverShareASigningId) {
    Node node;
    const auto far = PlainSocket::udp(), stays = PlainSocket::udp();
    const auto url = [&](const PlainSocket& to, int n) {
        return fmt::format("udpout://127.0.0.1:{}?sign={}&name=e{}", to.port(), key_file('a'), n);
    };
    const auto signing_id = [&](EndpointId id, const PlainSocket& to) {
        EXPECT_EQ(node.links->send(id, view(heartbeat(0))), 1u);
        Bytes got;
        EXPECT_TRUE(until([&] { return !(got = to.read()).empty(); }, node));
        return int{got.at(heartbeat(0).size())};
    };
    const int stays_as = signing_id(node.add(url(stays, 0)), stays);
    std::set<int> used{stays_as};
    for (int n = 1; n < 600; ++n) {
        const auto next = node.add(url(far, n));
        const int id = signing_id(next, far);
        EXPECT_NE(id, stays_as) << n;
        used.insert(id);
        node.links->remove(next);
    }
    EXPECT_EQ(used.size(), 256u) << "the id that was left longest ago is used first";
}

TEST_F(LinksSigning, The257thEndpointThatSignsIsRefusedWithTheReason) {
    Node node;
    const auto far = PlainSocket::udp();
    const auto url = [&](int n) {
        return fmt::format("udpout://127.0.0.1:{}?sign={}&name=e{}", far.port(), key_file('a'), n);
    };
    for (int n = 0; n < 256; ++n) node.add(url(n));

    const auto refused = node.links->add(*endpoint::parse_endpoint(url(256)));

    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().text, HasSubstr("256 endpoints sign already"));
    const auto plain = fmt::format("udpout://127.0.0.1:{}?name=plain", far.port());
    EXPECT_TRUE(node.links->add(*endpoint::parse_endpoint(plain)));
}

}  // namespace
}  // namespace mavloom::link
