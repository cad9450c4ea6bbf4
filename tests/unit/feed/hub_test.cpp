// SPDX-License-Identifier: MIT
#include "mavloom/feed/hub.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>

#include "feed/hub_links.hpp"
#include "mavloom/feed/fork.hpp"
#include "mavloom/shm/ring_writer.hpp"
#include "support/ring_name.hpp"
#include "support/temp_dir.hpp"
#include "support/thread_sanitizer.hpp"
#include "unit/feed/fixture.hpp"

namespace mavloom::feed {
namespace {

using namespace testing;
using ::testing::HasSubstr;

// The same as connect() holds: the hub, one endpoint of it, its channel and the channel's first reader.
class Opened {
public:
    explicit Opened(const std::string& url, std::size_t buffer_bytes = 1 << 22)
        : hub(Hub::get().value()),
          channel(make_channel(buffer_bytes)),
          reader(std::make_unique<ChannelReader>(channel, dialect::Filter{})),
          opened(hub->open(endpoint_of(url), channel, *reader)) {
        EXPECT_TRUE(opened) << url << ": " << (opened ? "" : opened.error().text);
    }
    ~Opened() { close(); }
    Opened(const Opened&) = delete;
    Opened& operator=(const Opened&) = delete;

    EndpointStats close() {
        if (!hub || !opened || !std::exchange(is_open_, false)) return {};
        auto stats = hub->close(id());
        hub.reset();
        return stats;
    }
    [[nodiscard]] link::EndpointId id() const { return opened->endpoint; }
    [[nodiscard]] std::uint16_t port() const { return opened->port; }
    // Waits until this many frames have come.
    [[nodiscard]] std::vector<std::uint32_t> numbers(std::size_t count) const {
        std::vector<std::uint32_t> all;
        const auto limit = mono_now() + long_enough;
        while (all.size() < count && !reader->closed() && mono_now() < limit) {
            const auto some = numbers_in(*reader);
            all.insert(all.end(), some.begin(), some.end());
            if (some.empty()) reader->wait(limit);
        }
        return all;
    }
    [[nodiscard]] bool has_peer() const {
        return eventually([&] { return channel->peers() != 0; });
    }

    std::shared_ptr<Hub> hub;
    std::shared_ptr<Channel> channel;
    std::unique_ptr<ChannelReader> reader;
    SetupResult<Hub::Opened> opened;

private:
    bool is_open_ = true;
};

// A TCP client that parses what it gets.
class TcpPeer {
public:
    explicit TcpPeer(std::uint16_t port) : socket(PlainSocket::connected_tcp(port)) {}
    // Reads until `count` frames have come in all, or the stream has ended.
    void read_frames(std::size_t count) {
        while (frames < count) {
            Bytes bytes(65'536);
            const auto got = ::recv(socket.fd(), bytes.data(), bytes.size(), 0);
            if (got <= 0) return;
            bytes.resize(static_cast<std::size_t>(got));
            parser.feed(bytes, mono_now(), [&](const wire::ParseEvent& event) {
                if (event.kind != wire::ParseEvent::Kind::frame) return;
                ++frames;
                by_system[event.frame.system().value].push_back(number_of(event.frame));
            });
        }
    }
    PlainSocket socket;
    wire::StreamParser parser{dialect::default_dialect().wire_table()};
    std::size_t frames = 0;
    std::map<std::uint8_t, std::vector<std::uint32_t>> by_system;
};

TEST(Hub, ReceivesEachEndpointIntoItsChannelInOrder) {
    Opened one("udpin://127.0.0.1:0"), other("udpin://127.0.0.1:0");
    const auto peer = PlainSocket::udp();
    for (std::uint32_t number = 1; number <= 200; ++number) {
        peer.send_to(one.port(), numbered(number));
        peer.send_to(other.port(), numbered(1000 + number));
    }
    EXPECT_EQ(one.numbers(200), from_to(1, 200));
    EXPECT_EQ(other.numbers(200), from_to(1001, 1200));
    EXPECT_EQ(one.channel->peers(), 1u);
    const auto stats = one.hub->stats(one.id());
    EXPECT_EQ(stats.links.frames_in.value(), 200u);
    EXPECT_EQ(stats.peers, 1u);
}

TEST(Hub, OneServesAllAndEndsWithTheLast) {
    auto first = std::make_unique<Opened>("udpin://127.0.0.1:0");
    auto second = std::make_unique<Opened>("tcpin://127.0.0.1:0");
    EXPECT_EQ(first->hub, second->hub);
    const std::weak_ptr<Hub> hub = first->hub;
    first.reset();
    EXPECT_FALSE(hub.expired());
    second.reset();
    EXPECT_TRUE(hub.expired());
    EXPECT_NE(Hub::get().value(), nullptr);
}

TEST(Hub, WhatCannotBeOpenedStatesWhyAndLeavesTheHubAsItWas) {
    Opened taken("udpin://127.0.0.1:0");
    const auto channel = make_channel();
    const ChannelReader reader(channel, {});
    const auto again = taken.hub->open(endpoint_of(fmt::format("udpin://127.0.0.1:{}?required=true", taken.port())),
                                       channel, reader);
    ASSERT_FALSE(again);
    EXPECT_THAT(again.error().text, HasSubstr(std::to_string(taken.port())));
    const auto closed_port = PlainSocket(SOCK_STREAM).port();
    const auto absent = taken.hub->open(endpoint_of(fmt::format("tcpout://127.0.0.1:{}?required=true", closed_port)),
                                        channel, reader);
    ASSERT_FALSE(absent);
    EXPECT_THAT(absent.error().text, HasSubstr(std::to_string(closed_port)));

    PlainSocket::udp().send_to(taken.port(), numbered(1));
    EXPECT_EQ(taken.numbers(1), from_to(1, 1));
}

TEST(Hub, ARequiredFarSideThatIsThereIsWaitedFor) {
    const PlainSocket listening(SOCK_STREAM);
    ASSERT_EQ(::listen(listening.fd(), 1), 0);
    Opened required(fmt::format("tcpout://127.0.0.1:{}?required=true", listening.port()));
    EXPECT_EQ(required.channel->peers(), 1u);
}

TEST(Hub, SendersOfSeveralThreadsKeepTheirOrderAndLoseNothing) {
    Opened server("tcpin://127.0.0.1:0");
    TcpPeer peer(server.port());
    ASSERT_TRUE(server.has_peer());
    constexpr std::uint32_t each = 3000;
    std::vector<std::thread> senders;
    for (std::uint8_t system = 1; system <= 4; ++system)
        senders.emplace_back([&, system] {
            for (std::uint32_t number = 1; number <= each; ++number)
                EXPECT_TRUE(server.hub->send(server.id(), view(numbered(number, system))));
        });
    peer.read_frames(4 * each);
    for (auto& sender : senders) sender.join();
    for (std::uint8_t system = 1; system <= 4; ++system) EXPECT_EQ(peer.by_system[system], from_to(1, each));
    EXPECT_EQ(server.close().links.frames_out.value(), 4 * each);
}

TEST(Hub, ClosingSendsWhatIsQueued) {
    Opened server("tcpin://127.0.0.1:0");
    TcpPeer peer(server.port());
    ASSERT_TRUE(server.has_peer());
    for (std::uint32_t number = 1; number <= 500; ++number)
        ASSERT_TRUE(server.hub->send(server.id(), view(numbered(number))));
    server.close();
    peer.read_frames(1'000'000);  // to the end of the stream
    EXPECT_EQ(peer.by_system[1], from_to(1, 500));
    EXPECT_TRUE(server.reader->closed());
}

TEST(HubLinks, AreFlushedOnceAllIsSentOrNobodyIsThere) {
    HubLinks links(std::move(*Sources::create(dialect::default_dialect())));
    const auto channel = make_channel();
    const ChannelReader reader(channel, {});
    const auto opened = links.open(endpoint_of("tcpin://127.0.0.1:0"), channel, reader);
    ASSERT_TRUE(opened);
    EXPECT_TRUE(links.is_flushed(opened->endpoint));
    const auto turn_until = [&](auto&& condition) {
        return eventually([&] {
            links.turn(MonoTime{});
            return condition();
        });
    };
    TcpPeer slow(opened->port);
    ASSERT_TRUE(turn_until([&] { return channel->peers() == 1; }));
    EXPECT_TRUE(turn_until([&] {
        for (int i = 0; i < 200; ++i) links.send(opened->endpoint, view(frame_of(131, Bytes(255, 1))));
        links.turn(MonoTime{});
        return !links.is_flushed(opened->endpoint);
    }));
    EXPECT_TRUE(turn_until([&] {
        static_cast<void>(slow.socket.read());
        return links.is_flushed(opened->endpoint);
    }));

    for (int i = 0; i < 20'000; ++i) links.send(opened->endpoint, view(frame_of(131, Bytes(255, 1))));
    slow.socket.close();
    EXPECT_TRUE(turn_until([&] { return channel->peers() == 0; }));
    EXPECT_TRUE(links.is_flushed(opened->endpoint));
}

// A peer that never reads: its frames wait in its own queue, which drops by its policy. Other links are served.
TEST(Hub, APeerThatDoesNotReadDelaysNoOtherLink) {
    Opened blocked("tcpin://127.0.0.1:0?queue_bytes=64KiB"), served("udpin://127.0.0.1:0");
    const auto silent = PlainSocket::connected_tcp(blocked.port(), 4096);
    ASSERT_TRUE(blocked.has_peer());
    std::atomic<bool> done{false};
    std::thread sending([&] {
        const auto longest = frame_of(131, Bytes(255, 1));
        while (!done) EXPECT_TRUE(blocked.hub->send(blocked.id(), view(longest)));
    });
    EXPECT_TRUE(eventually([&] {
        const auto stats = blocked.hub->stats(blocked.id());
        return stats.links.queue_bytes.value() != 0 || stats.links.queue_age.value() != 0;
    }));
    const auto peer = PlainSocket::udp();
    for (std::uint32_t number = 1; number <= 20; ++number) {
        peer.send_to(served.port(), numbered(number));
        EXPECT_EQ(served.numbers(1), from_to(number, number));
    }
    done = true;
    sending.join();
}

TEST(Hub, LinksComeAndGoWhileOthersReceiveAndSend) {
    Opened steady("udpin://127.0.0.1:0");
    std::atomic<bool> done{false};
    std::vector<std::thread> threads;
    for (int i = 0; i < 3; ++i)
        threads.emplace_back([&] {
            const auto peer = PlainSocket::udp();
            for (int round = 0; round < 15; ++round) {
                Opened brief("udpin://127.0.0.1:0");
                peer.send_to(brief.port(), numbered(1));
                EXPECT_EQ(brief.numbers(1), from_to(1, 1));
                EXPECT_TRUE(brief.hub->send(brief.id(), view(numbered(2))));
                EXPECT_EQ(brief.hub->stats(brief.id()).links.frames_in.value(), 1u);
            }
        });
    std::thread asking([&] {
        while (!done) EXPECT_EQ(steady.hub->stats(steady.id()).links.lost.value(), 0u);
    });
    const auto peer = PlainSocket::udp();
    for (std::uint32_t number = 1; number <= 300; ++number) {
        peer.send_to(steady.port(), numbered(number));
        EXPECT_EQ(steady.numbers(1), from_to(number, number));
    }
    for (auto& thread : threads) thread.join();
    done = true;
    asking.join();
}

TEST(Hub, LossesOfAPeerThatWentStayInTheSums) {
    Opened server("tcpin://127.0.0.1:0");
    {
        const auto peer = PlainSocket::connected_tcp(server.port());
        peer.write(link::testing::heartbeat(1));
        peer.write(link::testing::heartbeat(5));
        EXPECT_EQ(server.numbers(2).size(), 2u);
    }
    ASSERT_TRUE(eventually([&] { return server.channel->peers() == 0; }));
    const auto stats = server.hub->stats(server.id());
    EXPECT_EQ(stats.links.lost.value(), 3u);
    EXPECT_EQ(stats.peers, 0u);
    ASSERT_EQ(stats.losses.size(), 1u);
    EXPECT_EQ(stats.losses.begin()->second.lost, 3u);
}

// ---- the end

TEST(Hub, StoppingReleasesSendersReadersAndCallers) {
    for (int round = 0; round < 10; ++round) {
        Opened server("tcpin://127.0.0.1:0");
        const auto silent = PlainSocket::connected_tcp(server.port(), 4096);
        ASSERT_TRUE(server.has_peer());
        std::atomic<int> sent{0};
        std::vector<std::thread> threads;
        for (int i = 0; i < 3; ++i)
            threads.emplace_back([&] {
                while (server.hub->send(server.id(), view(numbered(1)))) ++sent;
            });
        threads.emplace_back([&] {
            for (FrameBatch batch; server.reader->take(batch, 1); batch.clear()) server.reader->wait(MonoTime::max());
        });
        threads.emplace_back([&] {
            while (!server.channel->latest({}, {}, MonoTime::min()) && !server.reader->closed())
                static_cast<void>(server.hub->stats(server.id()));
        });
        EXPECT_TRUE(eventually([&] { return sent > 100; }));
        std::thread other([] { Hub::stop_all(); });  // two threads may stop one hub
        Hub::stop_all();
        other.join();
        for (auto& thread : threads) thread.join();
        EXPECT_FALSE(server.hub->send(server.id(), view(numbered(1))));
        EXPECT_FALSE(server.hub->inlet(server.id()));
        const auto channel = make_channel();
        EXPECT_FALSE(server.hub->open(endpoint_of("udpin://127.0.0.1:0"), channel, *server.reader));
        EXPECT_NE(Hub::get().value(), server.hub);  // a link that is opened later gets one that runs
    }
}

TEST(Hub, LinksThatAreMadeAndClosedByManyThreadsShareWholeHubs) {
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([] {
            for (int round = 0; round < 10; ++round) {
                Opened link("udpin://127.0.0.1:0");
                EXPECT_NE(link.port(), 0);
            }
        });
    for (auto& thread : threads) thread.join();
}

// ---- rings

struct HubRingTest : ::testing::Test {
    void write_numbers(std::uint32_t last) {
        for (std::uint32_t number = 1; number <= last; ++number)
            ASSERT_TRUE(writer.write(numbered(number), {.kind = 1}, mono_now() + long_enough));
        writer.flush();
    }
    test::RingName name;
    shm::RingWriter writer = *shm::RingWriter::open(name.text(), {.capacity = shm::min_capacity});
};

// The ring and the buffer are each smaller than what is written: the reader's pace reaches the writer.
TEST_F(HubRingTest, ALosslessRingWaitsForTheReader) {
    Opened ring("shm://" + name.text() + "?lossless=true", smallest_buffer);
    constexpr std::uint32_t last = 10'000;
    std::thread writing([&] { write_numbers(last); });
    std::vector<std::uint32_t> heard;
    while (heard.size() < last) {
        FrameBatch batch;
        ASSERT_TRUE(ring.reader->take(batch, 100));
        while (const auto* item = batch.next()) heard.push_back(number_of(batch.frame(*item)));
        std::this_thread::sleep_for(1ms);  // far slower than the hub
    }
    writing.join();
    EXPECT_EQ(heard, from_to(1, last));
    EXPECT_EQ(ring.reader->missed(), 0u);
    EXPECT_EQ(ring.channel->peers(), 0u);  // nothing can be sent into a ring
}

TEST_F(HubRingTest, AReaderThatIsClosedNoLongerHoldsTheWriter) {
    Opened ring("shm://" + name.text() + "?lossless=true", smallest_buffer);
    std::thread writing([&] { write_numbers(10'000); });
    ASSERT_TRUE(eventually([&] { return ring.reader->newest() > 500; }));
    ring.reader->close();
    writing.join();
    EXPECT_EQ(writer.records(), 10'000u);
}

TEST_F(HubRingTest, AnswersOfReadersReachThePeersOfTheEndpointThatFillsTheRing) {
    const test::TempDir run;
    ::setenv("MAVLOOM_RUN", run.path().c_str(), 1);
    Opened vehicle("tcpin://127.0.0.1:0"), ring("shm://" + name.text());
    TcpPeer peer(vehicle.port());
    ASSERT_TRUE(vehicle.has_peer());
    ASSERT_TRUE(vehicle.hub->serve_inlet(vehicle.id(), name.text(), 0600));
    EXPECT_FALSE(vehicle.hub->serve_inlet(vehicle.id(), name.text(), 0600));

    const auto inlet = ring.hub->inlet(ring.id());
    ASSERT_TRUE(inlet);
    EXPECT_EQ(ring.hub->inlet(ring.id()).value(), *inlet);
    ASSERT_TRUE(ring.has_peer());
    ASSERT_TRUE(ring.hub->send(*inlet, view(numbered(7))));
    peer.read_frames(1);
    EXPECT_EQ(peer.by_system[1], from_to(7, 7));
    const auto stats = vehicle.close();
    EXPECT_EQ(stats.answers, 1u);
    EXPECT_EQ(stats.unheard_answers, 0u);
    ::unsetenv("MAVLOOM_RUN");
}

// ---- forks

int status_of(pid_t child) {
    int status = -1;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    return status;
}

TEST(Fork, AnObjectKnowsWhetherThisProcessMadeIt) {
    const ForkGuard made;
    const auto before = forks();
    const pid_t child = ::fork();
    if (child == 0) {
        const ForkGuard own;
        ::_exit(!made.is_own_process() && own.is_own_process() && forks() == before + 1 ? 0 : 1);
    }
    EXPECT_EQ(status_of(child), 0);
    EXPECT_TRUE(made.is_own_process());
    EXPECT_EQ(forks(), before);
}

TEST(Fork, AChildMakesAHubOfItsOwnAndTheParentsContinues) {
    if (!test::child_may_start_threads) GTEST_SKIP() << "the child starts threads";
    Opened link("udpin://127.0.0.1:0");
    const pid_t child = ::fork();
    if (child == 0) {
        ::alarm(60);
        const auto hub = Hub::get();
        bool works = hub && *hub != link.hub;
        Opened own("udpin://127.0.0.1:0");
        PlainSocket::udp().send_to(own.port(), numbered(1));
        works = works && own.numbers(1) == from_to(1, 1);
        ::_exit(works ? 0 : 1);
    }
    EXPECT_EQ(status_of(child), 0);
    PlainSocket::udp().send_to(link.port(), numbered(2));
    EXPECT_EQ(link.numbers(1), from_to(2, 2));
}

// The fork may come while another thread holds the lock of the hubs.
TEST(Fork, AChildIsNotLockedOutByTheThreadsThatOpenLinks) {
    std::atomic<bool> done{false};
    std::thread opening([&] {
        while (!done) Opened link("udpin://127.0.0.1:0");
    });
    for (int i = 0; i < 20; ++i) {
        const pid_t child = ::fork();
        if (child == 0) {
            ::alarm(60);
            Hub::stop_all();
            ::_exit(0);
        }
        EXPECT_EQ(status_of(child), 0);
    }
    done = true;
    opening.join();
}

}  // namespace
}  // namespace mavloom::feed
