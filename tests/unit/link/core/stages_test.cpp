// SPDX-License-Identifier: MIT
// Stages at the border of a link, over each kind of link: real sockets and a pseudo-terminal. The transport with
// threads is played.
#include "mavloom/link/stage.hpp"

#include "mavloom/link/flush.hpp"
#include "mavloom/link/transport.hpp"
#include "unit/link/fixture.hpp"
#include "unit/net/pty.hpp"

namespace mavloom::link {
namespace {

using namespace testing;
using namespace std::chrono_literals;
using mavloom::testing::Pty;
using ::testing::ElementsAre;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAre;

// ---- the far side of a link -----------------------------------------------------------------------------------------

class FarSide {
public:
    virtual ~FarSide() = default;
    // Opens an endpoint with these options, and waits for its link.
    virtual void open(Node& node, const std::string& options) = 0;
    virtual void write(const Bytes& bytes) = 0;
    // The bytes that have arrived since the last call.
    [[nodiscard]] virtual Bytes read() = 0;
    virtual void close() = 0;
    EndpointId endpoint;
};

class Udp final : public FarSide {
public:
    void open(Node& node, const std::string& options) override {
        endpoint = node.add("udpin://127.0.0.1:0?" + options);
        port_ = node.port(endpoint);
        write(heartbeat(0));
        ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 1; }, node));
        closing_ = [&node] { node.links->close(node.recorder.ups.at(0).first); };
    }
    void write(const Bytes& bytes) override { socket_.send_to(port_, bytes); }
    Bytes read() override { return socket_.read(); }
    void close() override { closing_(); }

private:
    PlainSocket socket_ = PlainSocket::udp();
    std::uint16_t port_ = 0;
    std::function<void()> closing_;
};

class Tcp final : public FarSide {
public:
    void open(Node& node, const std::string& options) override {
        endpoint = node.add("tcpin://127.0.0.1:0?" + options);
        socket_.emplace(PlainSocket::connected_tcp(node.port(endpoint)));
        ASSERT_TRUE(until([&] { return node.recorder.ups.size() == 1; }, node));
    }
    void write(const Bytes& bytes) override { socket_->write(bytes); }
    Bytes read() override { return socket_->read(); }
    void close() override { socket_->close(); }

private:
    std::optional<PlainSocket> socket_;
};

class Serial final : public FarSide {
public:
    void open(Node& node, const std::string& options) override {
        endpoint = node.add("serial://" + far_->device() + "?baud=921600&" + options);
        ASSERT_TRUE(until([&] { return node.recorder.ups.size() == 1; }, node));
    }
    void write(const Bytes& bytes) override { far_->write(bytes); }
    Bytes read() override { return far_->read(); }
    void close() override { far_.reset(); }

private:
    std::optional<Pty> far_ = std::make_optional<Pty>();
};

struct PlayedTransport final : Transport {
    explicit PlayedTransport(std::shared_ptr<Mailbox> box) : mailbox(std::move(box)) { last = this; }
    SetupResult<void> open(const std::vector<net::Address>&) override { return {}; }
    std::size_t send(PeerNumber peer, std::span<const iovec> frames) override {
        for (const iovec& piece : frames) {
            const auto* const from = static_cast<const std::uint8_t*>(piece.iov_base);
            sent.insert(sent.end(), from, from + piece.iov_len);
            mailbox->note_sent(peer, piece.iov_len);
        }
        return 0;
    }
    void close(PeerNumber, std::string_view) override {}
    void resume() override {}

    static inline PlayedTransport* last = nullptr;
    std::shared_ptr<Mailbox> mailbox;
    Bytes sent;
};

class ThreadedFarSide final : public FarSide {
public:
    void open(Node& node, const std::string& options) override {
        register_transport(endpoint::Scheme::wsout,
                           [](const endpoint::Endpoint&, std::shared_ptr<Mailbox> mailbox) -> std::unique_ptr<Transport> {
                               return std::make_unique<PlayedTransport>(std::move(mailbox));
                           });
        endpoint = node.add("wsout://127.0.0.1:14550?" + options);
        PlayedTransport::last->mailbox->join({.number = 1, .address = {}});
        ASSERT_TRUE(until([&] { return node.recorder.ups.size() == 1; }, node));
    }
    void write(const Bytes& bytes) override {
        EXPECT_TRUE(PlayedTransport::last->mailbox->deliver(1, bytes, wall_now()));
    }
    Bytes read() override { return std::exchange(PlayedTransport::last->sent, {}); }
    void close() override { PlayedTransport::last->mailbox->leave(1, "closed by the far side"); }
};

// ---- stages ---------------------------------------------------------------------------------------------------------

using Script = std::function<void(const Piece&, MonoTime, Next&)>;

struct Scripted final : Stage {
    explicit Scripted(Script does) : script(std::move(does)) {}
    void take(const Piece& piece, MonoTime now, Next& next) noexcept override { script(piece, now, next); }
    Script script;
};

std::vector<std::unique_ptr<Stage>> chain(std::initializer_list<Script> scripts) {
    std::vector<std::unique_ptr<Stage>> stages;
    for (const Script& script : scripts) stages.push_back(std::make_unique<Scripted>(script));
    return stages;
}
Stages inward(std::initializer_list<Script> scripts) { return {chain(scripts), {}}; }
Stages outward(std::initializer_list<Script> scripts) { return {{}, chain(scripts)}; }

void pass(const Piece& piece, MonoTime, Next& next) { next.pass(piece); }
void drop(const Piece&, MonoTime, Next&) {}
void copy(const Piece& piece, MonoTime, Next& next) {
    next.pass(piece);
    next.pass(piece);
}
Script hold(Nanoseconds time) {
    return [time](const Piece& piece, MonoTime now, Next& next) { next.pass_at(piece, now + time); };
}
// Passes all but the last bytes.
Script cut(std::size_t bytes) {
    return [bytes](const Piece& piece, MonoTime, Next& next) {
        Piece shorter = piece;
        shorter.bytes = piece.bytes.first(piece.bytes.size() - std::min(bytes, piece.bytes.size()));
        next.pass(shorter);
    };
}
// Inverts a bit of the last byte, which belongs to the checksum.
void damage(const Piece& piece, MonoTime, Next& next) {
    Bytes bytes(piece.bytes.begin(), piece.bytes.end());
    bytes.back() ^= 1;
    Piece changed = piece;
    changed.bytes = bytes;
    next.pass(changed);
}

Bytes damaged(Bytes bytes) {
    bytes.back() ^= 1;
    return bytes;
}

template <class Far>
class StagesOf : public ::testing::Test {
protected:
    void open(const std::string& options = "queue_age=60") {
        ASSERT_NO_FATAL_FAILURE(far.open(node, options));
        node.recorder.frames.clear();
        id = node.recorder.ups.at(0).first;
    }
    void put(Stages stages) {
        ASSERT_TRUE(node.links->set_stages(id, [&](const StageSite&) { return std::move(stages); }));
    }
    void send(const Bytes& frame) { EXPECT_EQ(node.links->send(id, view(frame)), 1u); }
    [[nodiscard]] bool far_gets(const Bytes& bytes) {
        return until([&] { return (got = std::move(got) + far.read()).size() >= bytes.size(); }, node) && got == bytes;
    }
    [[nodiscard]] bool hears(std::size_t frames) {
        return until([&] { return node.recorder.frames.size() >= frames; }, node);
    }
    [[nodiscard]] const LinkCounters& counters() const { return node.counters(id); }

    Node node;
    Far far;
    LinkId id;
    Bytes got;
};
using Kinds = ::testing::Types<Udp, Tcp, Serial, ThreadedFarSide>;
TYPED_TEST_SUITE(StagesOf, Kinds);

// ---- what a stage may do --------------------------------------------------------------------------------------------

TYPED_TEST(StagesOf, PassDropCopyAndChangeFramesOutward) {
    this->open();
    this->put(outward({pass, pass}));
    this->send(heartbeat(1));
    this->put(outward({drop}));
    this->send(heartbeat(2));
    this->put(outward({copy, copy}));
    this->send(heartbeat(3));
    this->put(outward({damage}));
    this->send(heartbeat(4));
    this->put(outward({cut(5)}));
    this->send(heartbeat(5));
    this->put({});
    this->send(heartbeat(6));

    Bytes shorter = heartbeat(5);
    shorter.resize(shorter.size() - 5);
    const Bytes four = heartbeat(3) + heartbeat(3) + heartbeat(3) + heartbeat(3);
    EXPECT_TRUE(this->far_gets(heartbeat(1) + four + damaged(heartbeat(4)) + shorter + heartbeat(6)));
    this->node.poll();
    EXPECT_FALSE(this->node.links->pending());
    EXPECT_THAT(this->node.links->links(), SizeIs(1));  // which settles what was sent
    EXPECT_EQ(this->counters().frames_out.value(), 8u) << "each piece counts";
}

TYPED_TEST(StagesOf, PassDropCopyAndChangeBytesInward) {
    this->open();
    const auto hear = [&](const Script& script, const Bytes& bytes) {
        bool came = false;
        this->put(inward({pass, [&](const Piece& piece, MonoTime now, Next& next) {
                              came = true;
                              script(piece, now, next);
                          }}));
        this->far.write(bytes);
        return until([&] { return came; }, this->node);
    };
    ASSERT_TRUE(hear(pass, heartbeat(1)));
    ASSERT_TRUE(hear(drop, heartbeat(2)));
    ASSERT_TRUE(hear(copy, heartbeat(3)));
    ASSERT_TRUE(hear(damage, heartbeat(4)));
    EXPECT_EQ(this->counters().crc_error.value(), 1u);
    ASSERT_TRUE(hear(cut(5), heartbeat(5)));
    ASSERT_TRUE(hear(pass, heartbeat(6)));
    ASSERT_TRUE(hear(pass, heartbeat(7)));
    ASSERT_TRUE(this->hears(5));
    EXPECT_EQ(this->node.recorder.bytes(), heartbeat(1) + heartbeat(3) + heartbeat(3) + heartbeat(6) + heartbeat(7));
    EXPECT_EQ(this->counters().junk_bytes.value(), 2 * heartbeat(0).size() - 5);
}

// ---- holding --------------------------------------------------------------------------------------------------------

TYPED_TEST(StagesOf, AFrameThatIsHeldLeavesOnTimeAndCountsAsQueued) {
    this->open();
    this->node.poll();
    this->put(outward({hold(30ms)}));
    const MonoTime begin = mono_now();
    this->send(heartbeat(1));
    this->node.poll();
    EXPECT_TRUE(this->node.links->pending());
    EXPECT_EQ(this->node.links->queued_bytes(this->far.endpoint), heartbeat(1).size());
    EXPECT_EQ(this->node.links->queued_bytes(this->id), heartbeat(1).size());
    for (int turns = 0; this->node.links->pending() && turns < 10; ++turns)
        this->node.links->turn(this->node.recorder, mono_now() + 60s);  // nothing else wakes it
    EXPECT_TRUE(this->far_gets(heartbeat(1)));
    EXPECT_GE(mono_now() - begin, 25ms) << "the time of the turn is a little earlier";
    EXPECT_LT(mono_now() - begin, 10s);
}

TYPED_TEST(StagesOf, WhatIsHeldInwardArrivesLaterAndHasTheLaterTime) {
    this->open();
    this->put(inward({hold(30ms)}));
    this->far.write(heartbeat(1));
    const WallTime begin = wall_now();
    ASSERT_TRUE(this->hears(1));
    EXPECT_EQ(this->node.recorder.bytes(), heartbeat(1));
    EXPECT_GE(this->node.recorder.frames[0].time - begin, 25ms);
    EXPECT_GE(wall_now() - begin, 25ms);
}

TYPED_TEST(StagesOf, FramesLeaveInTheOrderOfTheirTimes) {
    this->open();
    int count = 0;
    std::vector<Nanoseconds> later;
    this->put(
        outward({[&](const Piece& piece, MonoTime now, Next& next) { next.pass_at(piece, now + (3 - ++count) * 5ms); },
                 [&, first = MonoTime{}](const Piece& piece, MonoTime now, Next& next) mutable {
                     if (later.empty()) first = now;
                     later.push_back(now - first);
                     next.pass(piece);
                 }}));
    for (std::uint8_t i = 1; i <= 3; ++i) this->send(heartbeat(i));
    EXPECT_TRUE(this->far_gets(heartbeat(3) + heartbeat(2) + heartbeat(1)));
    EXPECT_THAT(later, ElementsAre(0ms, 5ms, 10ms)) << "the next stage gets the exact times";
}

TYPED_TEST(StagesOf, WhatExceedsQueueBytesIsDroppedAndCounted) {
    this->open("queue_bytes=1000");
    this->put({chain({hold(1h)}), chain({hold(1h)})});
    const std::size_t most = 1000 / heartbeat(0).size();
    for (std::uint8_t i = 0; i < 100; ++i) this->send(heartbeat(i));
    EXPECT_EQ(this->counters().held_dropped.value(), 100 - most);
    EXPECT_EQ(this->node.links->queued_bytes(this->id), most * heartbeat(0).size());
    Bytes twelve;
    for (std::uint8_t i = 0; i < 12; ++i) twelve = std::move(twelve) + attitude(i);
    ASSERT_LT(twelve.size(), 1000u);
    this->far.write(twelve);
    this->far.write(twelve);
    this->far.write(twelve);
    EXPECT_TRUE(until([&] { return this->counters().held_dropped.value() > 100 - most; }, this->node));
    EXPECT_EQ(this->node.links->queued_bytes(this->id), most * heartbeat(0).size()) << "inward has its own bound";
}

// Each takes memory, however short it is.
TEST(Stages, ManyShortPiecesAreDroppedToo) {
    Node node;
    ThreadedFarSide far;
    far.open(node, "queue_bytes=1000");
    const LinkId link = node.recorder.ups.at(0).first;
    ASSERT_TRUE(node.links->set_stages(link, [](const StageSite&) { return inward({hold(1h)}); }));
    for (int i = 0; i < 500; ++i) far.write({0});
    node.poll();
    EXPECT_EQ(node.counters(link).held_dropped.value(), 500u - 1000 / 8) << "the shortest frame has 8 bytes";
    node.links->remove(far.endpoint);
}

// ---- changes --------------------------------------------------------------------------------------------------------

TYPED_TEST(StagesOf, WhatIsHeldPassesOnBeforeAnythingElseWhenTheyAreReplaced) {
    this->open();
    const CreateStages create = [](const StageSite&) {
        return Stages{chain({hold(1h), drop}), chain({hold(1h), drop})};
    };
    ASSERT_TRUE(this->node.links->set_stages(this->far.endpoint, create));
    this->send(heartbeat(1));
    this->send(heartbeat(2));
    bool arrived = false;
    const Script watch = [&](const Piece& piece, MonoTime now, Next& next) {
        arrived = true;
        next.pass_at(piece, now + 1h);
    };
    this->put({chain({watch}), chain({hold(1h)})});
    this->far.write(heartbeat(4));
    ASSERT_TRUE(until([&] { return arrived; }, this->node));
    ASSERT_TRUE(this->node.links->set_stages(this->far.endpoint, {}));
    this->send(heartbeat(3));
    EXPECT_TRUE(this->far_gets(heartbeat(1) + heartbeat(2) + heartbeat(3)));
    ASSERT_TRUE(this->hears(1));
    this->far.write(heartbeat(5));
    ASSERT_TRUE(this->hears(2));
    EXPECT_EQ(this->node.recorder.bytes(), heartbeat(4) + heartbeat(5));
    EXPECT_EQ(this->counters().held_dropped.value(), 0u);
}

TYPED_TEST(StagesOf, AFlushWaitsForWhatIsHeld) {
    this->open();
    this->put(outward({hold(30ms)}));
    this->send(heartbeat(1));
    flush(*this->node.links, this->node.recorder, 60s);
    EXPECT_FALSE(this->node.links->pending());
    EXPECT_TRUE(this->far_gets(heartbeat(1)));
}

TYPED_TEST(StagesOf, WhatIsHeldAtTheEndOfALinkIsDeliveredOrCounted) {
    this->open();
    bool arrived = false;
    const Script watch = [&](const Piece& piece, MonoTime now, Next& next) {
        arrived = true;
        next.pass_at(piece, now + 1h);
    };
    this->put({chain({watch}), chain({hold(1h)})});
    this->far.write(heartbeat(1));
    ASSERT_TRUE(until([&] { return arrived; }, this->node));
    this->send(heartbeat(2));
    this->far.close();
    for (int i = 0; i < 20; ++i) this->node.links->turn(this->node.recorder, mono_now() + 1ms);
    const bool is_gone = this->node.links->counters(this->id) == nullptr;
    const EndpointCounters& sums = *this->node.info(this->far.endpoint).counters;
    if constexpr (std::is_same_v<TypeParam, Udp>) {
        EXPECT_THAT(this->node.recorder.frames, SizeIs(0)) << "it was closed on this side";
        EXPECT_EQ(sums.gone.held_dropped.value(), 2u);
    } else {
        EXPECT_EQ(this->node.recorder.bytes(), heartbeat(1));
        EXPECT_THAT(this->node.recorder.downs, SizeIs(1));
    }
    if constexpr (std::is_same_v<TypeParam, Tcp>) {
        EXPECT_TRUE(is_gone);
        EXPECT_EQ(sums.gone.held_dropped.value(), 1u);
    }
    if constexpr (std::is_same_v<TypeParam, Serial> || std::is_same_v<TypeParam, ThreadedFarSide>) {
        EXPECT_EQ(this->node.links->queued_bytes(this->id), heartbeat(2).size()) << "for the next connection";
    }
    this->node.links->remove(this->far.endpoint);
    this->node.poll();
}

// ---- endpoints ------------------------------------------------------------------------------------------------------

TEST(Stages, EveryLinkOfAnEndpointHasItsOwn) {
    Node node;
    std::vector<std::string> sites;
    const auto in = node.add("udpin://127.0.0.1:0");
    const auto stream = node.add("tcpin://127.0.0.1:0");
    const CreateStages create = [&](const StageSite& site) {
        sites.push_back(fmt::format("{} {}", site.name, site.is_stream ? "stream" : "datagrams"));
        return inward({drop});
    };
    ASSERT_TRUE(node.links->set_stages(in, create));
    ASSERT_TRUE(node.links->set_stages(stream, create));
    const auto first = PlainSocket::udp(), second = PlainSocket::udp();
    first.send_to(node.port(in), heartbeat(0));
    second.send_to(node.port(in), heartbeat(0));
    const auto client = PlainSocket::connected_tcp(node.port(stream));
    ASSERT_TRUE(until([&] { return node.recorder.ups.size() == 3; }, node));
    EXPECT_THAT(node.recorder.frames, SizeIs(0));
    const auto name = [&](const char* scheme, EndpointId endpoint, const PlainSocket& socket, const char* unit) {
        return fmt::format("{}://127.0.0.1:{}#127.0.0.1:{} {}", scheme, node.port(endpoint), socket.port(), unit);
    };
    EXPECT_THAT(sites,
                UnorderedElementsAre(name("udpin", in, first, "datagrams"), name("udpin", in, second, "datagrams"),
                                     name("tcpin", stream, client, "stream")));
}

TEST(Stages, AnEndpointThatDidNotOpenLeavesNoTrace) {
    Node node;
    (void)node.refused("tcpout://127.0.0.1:1?required=true");
    Udp far;
    far.open(node, "idle=60");
    std::uint64_t ordinal = 99;
    ASSERT_TRUE(node.links->set_stages(node.recorder.ups.at(0).first, [&](const StageSite& site) {
        ordinal = site.ordinal;
        return Stages{};
    }));
    EXPECT_EQ(ordinal, 0u) << "it decides the random numbers of faults";
}

TEST(Stages, RingsAndWhatIsGoneHaveNone) {
    Node node;
    const auto ring = node.add("shm://stages_test");
    const CreateStages create = [](const StageSite&) { return inward({drop}); };
    EXPECT_FALSE(node.links->set_stages(ring, create));
    EXPECT_FALSE(node.links->set_stages(node.links->links().at(0).id, create));
    EXPECT_FALSE(node.links->set_stages(EndpointId{99}, create));
    EXPECT_FALSE(node.links->set_stages(LinkId{99}, create));
}

TEST(Stages, BroadcastAndMulticastHaveThem) {
    Node node;
    bool was_sent = false;
    for (const char* url : {"udpbcast://127.255.255.255:14991", "udpmcast://239.255.1.1:14990?iface=lo&ttl=0"}) {
        auto id = node.links->add(endpoint_of(url));
        if (!id) continue;  // no such network here
        EXPECT_TRUE(node.links->set_stages(*id, [](const StageSite&) { return outward({hold(1h)}); }));
        if (node.links->send(*id, view(heartbeat(1))) == 0) continue;
        EXPECT_EQ(node.links->queued_bytes(*id), heartbeat(1).size()) << url;
        was_sent = true;
    }
    if (!was_sent) GTEST_SKIP() << "this machine can send neither a broadcast nor a multicast on loopback";
}

}  // namespace
}  // namespace mavloom::link
