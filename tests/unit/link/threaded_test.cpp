// SPDX-License-Identifier: MIT
// Transports of other modules. The one here stands for them: its test plays the network and the transport's threads.
#include <atomic>
#include <future>
#include <thread>

#include "mavloom/link/transport.hpp"
#include "unit/link/fixture.hpp"

namespace mavloom::link {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

struct Played final : Transport {
    Played(const endpoint::Endpoint& endpoint, std::shared_ptr<Mailbox> box)
        : port(endpoint.address.port), mailbox(std::move(box)) {
        last = this;
    }
    ~Played() override { last = nullptr; }
    SetupResult<void> open(const std::vector<net::Address>& to) override {
        calls.push_back(to.front().text());
        if (port == 1) return setup_error(SetupCode::in_use, "port 1 is taken");
        return {};
    }
    [[nodiscard]] std::uint16_t local_port() const override { return port; }
    std::size_t send(PeerNumber peer, std::span<const iovec> frames) override {
        Bytes message;
        for (const iovec& piece : frames) {
            const auto* const from = static_cast<const std::uint8_t*>(piece.iov_base);
            message.insert(message.end(), from, from + piece.iov_len);
        }
        const std::size_t size = message.size();
        messages.emplace_back(peer, std::move(message));
        return sends_at_once ? size : 0;
    }
    void close(PeerNumber peer, std::string_view) override { closed.push_back(peer); }
    void resume() override { ++resumed; }
    void refresh(EndpointCounters& counters) override { counters.http_refused.set(7); }

    [[nodiscard]] Bytes sent() const {
        Bytes all;
        for (const auto& [peer, message] : messages) all = std::move(all) + message;
        return all;
    }

    static inline std::atomic<Played*> last = nullptr;
    std::uint16_t port;
    bool sends_at_once = false;
    std::shared_ptr<Mailbox> mailbox;
    std::vector<std::string> calls;
    std::vector<std::pair<PeerNumber, Bytes>> messages;
    std::vector<PeerNumber> closed;
    int resumed = 0;
};

class Threaded : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        const CreateTransport create = [](const endpoint::Endpoint& endpoint, std::shared_ptr<Mailbox> mailbox) {
            return std::unique_ptr<Transport>(std::make_unique<Played>(endpoint, std::move(mailbox)));
        };
        register_transport(endpoint::Scheme::wsin, create);
        register_transport(endpoint::Scheme::wsout, create);
    }
    // Opens an endpoint with one connection, number 1.
    Played& connected(const std::string& url) {
        id = node.add(url);
        Played& transport = *Played::last.load();
        transport.mailbox->join({.number = 1, .address = net::Address::parse("127.0.0.1", 999)});
        node.poll();
        EXPECT_FALSE(node.recorder.ups.empty());
        return transport;
    }
    // Numbers 2 and 3.
    void join_page_and_far_client(Played& transport) {
        transport.mailbox->join({.number = 2, .address = net::Address::parse("127.0.0.1", 998), .is_foreign = true});
        transport.mailbox->join({.number = 3, .address = net::Address::parse("198.51.100.1", 998)});
        node.poll();
    }
    [[nodiscard]] const LinkCounters& counters() const { return node.counters(node.recorder.ups.at(0).first); }

    Node node;
    EndpointId id;
};

TEST_F(Threaded, AMessageOfSeveralFramesArrivesInOrder) {
    Played& transport = connected("wsin://127.0.0.1:14550");
    EXPECT_TRUE(transport.mailbox->deliver(1, heartbeat(0) + attitude(1), WallTime{} + std::chrono::seconds(5)));
    EXPECT_TRUE(transport.mailbox->deliver(1, attitude(2), wall_now()));
    node.poll();
    EXPECT_EQ(node.recorder.bytes(), heartbeat(0) + attitude(1) + attitude(2));
    EXPECT_EQ(node.recorder.frames[0].time, WallTime{} + std::chrono::seconds(5));
    EXPECT_EQ(node.recorder.ups[0].second, "wsin://127.0.0.1:14550#127.0.0.1:999");
}

TEST_F(Threaded, AFrameThatIsCutBetweenTwoMessagesIsJunk) {
    Played& transport = connected("wsin://127.0.0.1:14550");
    const Bytes frame = attitude(1);
    EXPECT_TRUE(transport.mailbox->deliver(1, ByteView(frame).first(20), wall_now()));
    EXPECT_TRUE(transport.mailbox->deliver(1, ByteView(frame).subspan(20), wall_now()));
    node.poll();
    EXPECT_THAT(node.recorder.frames, SizeIs(0));
    EXPECT_EQ(counters().junk_bytes.value(), frame.size());
}

TEST_F(Threaded, FramesLeaveInWholeMessagesAndCountOnceTheyHaveLeft) {
    Played& transport = connected("wsout://127.0.0.1:14550");
    ASSERT_EQ(node.links->send(id, view(heartbeat(0))), 1u);
    ASSERT_EQ(node.links->send(id, view(attitude(1))), 1u);
    node.poll();
    EXPECT_THAT(transport.messages, ElementsAre(std::pair(PeerNumber{1}, heartbeat(0) + attitude(1))));
    EXPECT_TRUE(node.links->pending());
    EXPECT_EQ(counters().frames_out.value(), 0u);
    transport.mailbox->note_sent(1, transport.sent().size());
    node.poll();
    EXPECT_EQ(counters().frames_out.value(), 2u);
    EXPECT_EQ(counters().bytes_out.value(), transport.sent().size());
    EXPECT_FALSE(node.links->pending());
}

TEST_F(Threaded, WhatLeavesAtOnceCountsAtOnceAndIsNotBounded) {
    Played& transport = connected("wsout://127.0.0.1:14550");
    transport.sends_at_once = true;
    for (std::uint8_t i = 0; i < 40; ++i) {
        ASSERT_EQ(node.links->send(id, view(attitude(i))), 1u);
        node.poll();
    }
    EXPECT_THAT(transport.messages, SizeIs(40));
    EXPECT_EQ(counters().frames_out.value(), 40u);
    EXPECT_FALSE(node.links->pending());
}

TEST_F(Threaded, ATransportGetsNoMoreThanItMustHold) {
    Played& transport = connected("wsout://127.0.0.1:14550");
    for (int i = 0; i < 10'000; ++i) ASSERT_EQ(node.links->send(id, view(frame_bytes(131, 7))), 1u);
    node.poll();
    EXPECT_LE(transport.sent().size(), Transport::max_unsent_bytes);
    EXPECT_GT(transport.sent().size(), Transport::max_unsent_bytes / 2);
}

TEST_F(Threaded, WhatASlowTransportCannotTakeWaitsInTheQueueAndIsReplacedThere) {
    Played& transport = connected("wsout://127.0.0.1:14550?queue_bytes=1000");
    for (int i = 0; i < 2000; ++i) {
        EXPECT_EQ(node.links->send(id, view(attitude(static_cast<std::uint8_t>(i)))), 1u);
        node.poll();
    }
    ASSERT_EQ(node.links->send(id, view(heartbeat(7))), 1u);
    const std::size_t taken = transport.messages.size();
    EXPECT_LE(taken, 16u);
    EXPECT_GT(counters().queue_bytes.value(), 1900u);
    EXPECT_LE(node.links->queued_bytes(id), 1000u);
    transport.mailbox->note_sent(1, transport.sent().size());
    node.poll();
    EXPECT_GT(transport.messages.size(), taken);
    const Bytes& last = transport.messages.back().second;
    EXPECT_EQ(Bytes(last.end() - static_cast<std::ptrdiff_t>(heartbeat(7).size()), last.end()), heartbeat(7));
}

TEST_F(Threaded, FramesThatTheTransportHadWhenItEndedAreCounted) {
    Played& transport = connected("wsout://127.0.0.1:14550");
    ASSERT_EQ(node.links->send(id, view(heartbeat(0))), 1u);
    node.poll();
    transport.mailbox->leave(1, "closed by the far side");
    node.poll();
    ASSERT_THAT(node.recorder.downs, SizeIs(1));
    EXPECT_EQ(node.recorder.downs[0].second, "closed by the far side");
    EXPECT_EQ(counters().frames_not_sent.value(), 1u);
    EXPECT_FALSE(node.links->pending());
    EXPECT_EQ(node.links->send(id, view(heartbeat(1))), 0u);
}

TEST_F(Threaded, ACallIsRepeatedAfterFailuresAndAfterTheEndOfAConnection) {
    id = node.add("wsout://127.0.0.1:14550");
    Played& transport = *Played::last.load();
    EXPECT_THAT(transport.calls, ElementsAre("127.0.0.1:14550"));
    transport.mailbox->fail({SetupCode::unreachable, 0, "nobody is there"});
    ASSERT_TRUE(until([&] { return transport.calls.size() == 2; }, node));
    ASSERT_THAT(node.recorder.notices, SizeIs(1));
    EXPECT_THAT(node.recorder.notices[0], HasSubstr("nobody is there; trying again"));
    EXPECT_EQ(node.links->failure(id)->text, "nobody is there");
    transport.mailbox->join({.number = 4, .address = {}});
    node.poll();
    transport.mailbox->leave(4, "closed by the far side");
    ASSERT_TRUE(until([&] { return transport.calls.size() == 3; }, node));
    transport.mailbox->join({.number = 5, .address = {}});
    node.poll();
    EXPECT_EQ(node.info(id).counters->reconnects.value(), 1u);
}

TEST_F(Threaded, ARequiredCallThatFailsIsAnError) {
    ASSERT_EQ(Played::last, nullptr);
    const auto refuse = std::async(std::launch::async, [] {
        while (Played::last == nullptr) std::this_thread::yield();
        const auto mailbox = Played::last.load()->mailbox;  // which outlives the endpoint
        mailbox->fail({SetupCode::unreachable, 0, "nobody is there"});
    });
    EXPECT_THAT(node.refused("wsout://127.0.0.1:14999?required=true").text, HasSubstr("nobody is there"));
}

TEST_F(Threaded, ARequiredCallLeavesTheFirstFramesToTheFirstTurn) {
    const auto greet = std::async(std::launch::async, [] {
        while (Played::last == nullptr) std::this_thread::yield();
        const auto mailbox = Played::last.load()->mailbox;
        mailbox->join({.number = 1, .address = {}});
        EXPECT_TRUE(mailbox->deliver(1, heartbeat(0), wall_now()));
    });
    node.add("wsout://127.0.0.1:14999?required=true");
    greet.wait();
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 1; }, node));
}

TEST_F(Threaded, ARequiredHostThatDoesNotExistIsNamed) {
    const auto error = node.refused("wsout://no-such-host.invalid:80?required=true");
    EXPECT_EQ(error.code, SetupCode::not_found);
    EXPECT_THAT(error.text, HasSubstr("no-such-host.invalid"));
}

TEST_F(Threaded, AQueueThatIsTooOldAtTheNextConnectionDoesNotStopIt) {
    Played& transport = connected("wsout://127.0.0.1:14550?queue_age=1ms");
    for (int i = 0; i < 1000; ++i) ASSERT_EQ(node.links->send(id, view(attitude(static_cast<std::uint8_t>(i)))), 1u);
    node.poll();
    transport.mailbox->leave(1, "closed by the far side");
    node.poll();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));  // longer than queue_age
    transport.messages.clear();
    transport.mailbox->join({.number = 2, .address = {}});
    node.poll();
    ASSERT_EQ(node.links->send(id, view(heartbeat(7))), 1u);
    node.poll();
    EXPECT_EQ(transport.sent(), heartbeat(7));
}

TEST_F(Threaded, APortInUseIsAnError) { EXPECT_EQ(node.refused("wsin://127.0.0.1:1").code, SetupCode::in_use); }

TEST_F(Threaded, ClientsBeyondTheLimitAreRefusedUnlessOthersAreSilent) {
    Played& transport = connected("wsin://127.0.0.1:14550?max_peers=1");
    EXPECT_TRUE(transport.mailbox->deliver(1, heartbeat(0), wall_now()));
    transport.mailbox->join({.number = 2, .address = net::Address::parse("127.0.0.1", 998)});
    node.poll();
    EXPECT_THAT(transport.closed, ElementsAre(2u));
    EXPECT_EQ(node.info(id).counters->peers_refused.value(), 1u);

    Played& other = connected("wsin://127.0.0.1:14551?max_peers=1");
    other.mailbox->join({.number = 2, .address = net::Address::parse("127.0.0.1", 998)});
    node.poll();
    EXPECT_THAT(other.closed, ElementsAre(1u));
    EXPECT_EQ(node.info(id).counters->peers_evicted.value(), 1u);
}

TEST_F(Threaded, RanksFollowTheAddressAndForeignClientsAreStrangers) {
    Played& transport = connected("wsin://127.0.0.1:14550");
    join_page_and_far_client(transport);
    ASSERT_THAT(node.recorder.ups, SizeIs(3));
    EXPECT_EQ(node.links->rank(node.recorder.ups[0].first), Rank::own);
    EXPECT_EQ(node.links->rank(node.recorder.ups[1].first), Rank::stranger);
    EXPECT_EQ(node.links->rank(node.recorder.ups[2].first), Rank::stranger);
}

// Behind a proxy that ends TLS, all clients have its address.
TEST_F(Threaded, TrustedDecidesForAllClients) {
    for (const auto& [url, expected] : {std::pair{"wsin://127.0.0.1:14550?trusted=true", Rank::own},
                                        {"wsin://127.0.0.1:14551?trusted=false", Rank::stranger}}) {
        node.recorder.ups.clear();
        Played& transport = connected(url);
        join_page_and_far_client(transport);
        ASSERT_THAT(node.recorder.ups, SizeIs(3));
        for (const auto& up : node.recorder.ups) EXPECT_EQ(node.links->rank(up.first), expected) << url;
    }
}

TEST_F(Threaded, TheLinkOfAWsoutEndpointIsOwn) {
    connected("wsout://192.0.2.1:14550");
    EXPECT_EQ(node.links->rank(node.recorder.ups.at(0).first), Rank::own);
}

TEST_F(Threaded, AnIdleClientIsClosed) {
    Played& transport = connected("wsin://127.0.0.1:14550?idle=20ms");
    ASSERT_TRUE(until([&] { return !node.recorder.downs.empty(); }, node));
    EXPECT_EQ(node.recorder.downs[0].second, "idle");
    EXPECT_THAT(transport.closed, ElementsAre(1u));
}

TEST_F(Threaded, AFullMailboxRefusesMessagesUntilItHasRoom) {
    Played& transport = connected("wsin://127.0.0.1:14550");
    const Bytes message(80'000, 0);
    int taken = 0;
    while (transport.mailbox->deliver(1, message, wall_now())) ++taken;
    EXPECT_EQ(taken, 3);
    EXPECT_TRUE(transport.mailbox->deliver(2, message, wall_now())) << "one peer harms no other";
    ASSERT_TRUE(until([&] { return transport.resumed == 1; }, node));
    EXPECT_TRUE(transport.mailbox->deliver(1, heartbeat(0), wall_now()));
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 1; }, node));
}

// As it is for streams: frames may cost much because they go to many links.
TEST_F(Threaded, AfterATurnThatTookLongTheNextHandlesLess) {
    Played& transport = connected("wsin://127.0.0.1:14550");
    for (int i = 0; i < 2500; ++i)
        EXPECT_TRUE(transport.mailbox->deliver(1, attitude(static_cast<std::uint8_t>(i)), wall_now()));
    node.recorder.answer = [&](const RxFrame&) {  // the time of the turn is what is tested
        if (node.recorder.frames.size() == 1) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    };
    node.poll();
    const std::size_t first = node.recorder.frames.size();
    node.poll();
    const std::size_t second = node.recorder.frames.size() - first;
    EXPECT_GT(first, 1000u);
    EXPECT_LT(second, 100u);
    EXPECT_TRUE(until([&] { return node.recorder.frames.size() == 2500; }, node));
}

TEST_F(Threaded, NothingReachesAnEndpointThatWasRemoved) {
    Played& transport = connected("wsin://127.0.0.1:14550");
    const auto mailbox = transport.mailbox;
    node.links->remove(id);
    for (int i = 0; i < 100; ++i)
        EXPECT_TRUE(mailbox->deliver(1, Bytes(80'000, 0), wall_now())) << "discarded, else it would be full";
    EXPECT_TRUE(mailbox->deliver(1, heartbeat(0), wall_now()));
    node.poll();
    EXPECT_THAT(node.recorder.frames, SizeIs(0));
}

TEST_F(Threaded, TheTransportsOwnCountersAreReadOnRequest) {
    connected("wsin://127.0.0.1:14550");
    node.links->refresh_counters();
    EXPECT_EQ(node.info(id).counters->http_refused.value(), 7u);
}

TEST_F(Threaded, AThreadDeliversWhileLinksReads) {
    Played& transport = connected("wsin://127.0.0.1:14550");
    std::thread sender([&] {
        for (int i = 0; i < 2000; ++i)
            while (!transport.mailbox->deliver(1, attitude(static_cast<std::uint8_t>(i)), wall_now())) {}
    });
    EXPECT_TRUE(until([&] { return node.recorder.frames.size() == 2000; }, node));
    sender.join();
    EXPECT_EQ(counters().lost.value(), 0u);
}

}  // namespace
}  // namespace mavloom::link
