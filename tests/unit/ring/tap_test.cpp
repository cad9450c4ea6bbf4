// SPDX-License-Identifier: MIT
#include "mavloom/ring/tap.hpp"

#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <map>
#include <semaphore>

#include "mavloom/shm/ring_info.hpp"
#include "mavloom/shm/ring_reader.hpp"
#include "support/ring_name.hpp"
#include "unit/link/fixture.hpp"
#include "unit/ring/allocations.hpp"

namespace mavloom::ring {
namespace {

using namespace link::testing;
using test::RingName;

const shm::RingOptions options{.capacity = 1 << 20, .when_full = shm::WhenFull::evict};

std::unique_ptr<RingTap> open(
    const RingName& name, std::function<void()> ready = [] {}) {
    auto tap = RingTap::open(name.text(), options, std::move(ready));
    if (!tap) throw std::runtime_error(tap.error().text);
    return std::move(*tap);
}

link::RxFrame received(const Bytes& bytes, LinkId link = {}, WallTime time = {}) {
    link::RxFrame rx;
    rx.frame = view(bytes);
    rx.link = link;
    rx.time = time;
    return rx;
}

TEST(RingTap, WritesFramesAsTheyAreAndAllocatesNothing) {
    const RingName name;
    const auto tap = open(name);
    auto reader = shm::RingReader::open(name.text(), {.from = shm::ReaderOptions::From::oldest});
    ASSERT_TRUE(reader) << reader.error().text;
    const Bytes bytes = attitude(7);
    const link::RxFrame rx = received(bytes, LinkId{5}, WallTime{Nanoseconds{1'700'000'000'000'000'123}});
    const std::size_t before = test::allocations_so_far();
    for (int i = 0; i < 1000; ++i) tap->write(rx, route::Verdict::filtered, false);
    EXPECT_EQ(test::allocations_so_far(), before);

    for (int i = 0; i < 1000; ++i) {
        const auto record = reader->try_read();
        ASSERT_TRUE(record);
        EXPECT_TRUE(std::ranges::equal(record->data, bytes));
        EXPECT_EQ(record->info.time, rx.time);
        EXPECT_EQ(record->info.link, rx.link);
        EXPECT_EQ(record->info.kind, 1u);
        EXPECT_EQ(record->info.verdict, 3u);
    }
    EXPECT_FALSE(reader->try_read());
}

TEST(RingTap, AReaderThatHoldsTheRingLosesItsHold) {
    const RingName name;
    const auto tap = open(name);
    auto reader = shm::RingReader::open(name.text(), {.lossless = true, .from = shm::ReaderOptions::From::oldest});
    ASSERT_TRUE(reader);
    const Bytes bytes = attitude(7);
    const link::RxFrame rx = received(bytes);
    tap->write(rx, route::Verdict::forwarded, false);
    ASSERT_TRUE(reader->try_read());
    constexpr std::uint64_t written = 50'000;  // 3 times round
    for (std::uint64_t i = 1; i < written; ++i) tap->write(rx, route::Verdict::forwarded, false);

    const auto status = shm::ring_status(name.text());
    ASSERT_TRUE(status);
    EXPECT_EQ(status->records, written);
    EXPECT_EQ(status->dropped, 0u);
    EXPECT_EQ(status->evictions, 1u);
}

TEST(RingTap, GoesWithRingAndPage) {
    const RingName name;
    open(name).reset();
    EXPECT_FALSE(shm::ring_status(name.text()));
    EXPECT_FALSE(shm::read_counters(name.text()));
}

TEST(RingTap, GoesWithTheRingThatIsBeingCreatedAgain) {
    const RingName name;
    Node node;
    std::binary_semaphore ready{0};
    auto tap = open(name, [&] { ready.release(); });
    ::unlink(name.path().c_str());
    EXPECT_THAT(tap->maintain(*node.links), ::testing::IsEmpty());
    const Bytes bytes = attitude(7);
    tap->write(received(bytes), route::Verdict::forwarded, false);
    ASSERT_TRUE(ready.try_acquire_for(std::chrono::seconds(60)));
    EXPECT_EQ(shm::ring_status(name.text())->records, 0u) << "what came meanwhile went into the old one";
    tap.reset();
    EXPECT_FALSE(shm::ring_status(name.text()));
}

TEST(RingTap, WhatIsRemovedIsCreatedAgainWithTheNames) {
    const RingName name;
    Node node;
    const auto in = node.add("udpin://127.0.0.1:0");
    const auto peer = PlainSocket::udp();
    peer.send_to(node.port(in), heartbeat(1));
    ASSERT_TRUE(until([&] { return !node.recorder.ups.empty(); }, node));
    std::binary_semaphore ready{0};
    const auto tap = open(name, [&] { ready.release(); });
    tap->on_link_up(node.recorder.ups[0].first, node.recorder.ups[0].second);
    EXPECT_THAT(tap->maintain(*node.links), ::testing::IsEmpty());
    ASSERT_TRUE(shm::remove_ring(name.text()));

    EXPECT_THAT(tap->maintain(*node.links), ::testing::IsEmpty()) << "another thread makes it";
    ASSERT_TRUE(ready.try_acquire_for(std::chrono::seconds(60)));
    EXPECT_THAT(tap->maintain(*node.links), ::testing::ElementsAre(::testing::HasSubstr("is created again")));
    EXPECT_THAT(tap->maintain(*node.links), ::testing::IsEmpty());
    const auto page = shm::read_counters(name.text());
    ASSERT_TRUE(page);
    EXPECT_THAT(page->links, ::testing::ElementsAre(node.recorder.ups[0]));
}

// Of a router that is killed: links 1 to `links`, and a frame of link 2.
void leave_a_ring(const RingName& name, std::uint32_t links) {
    const pid_t child = ::fork();
    if (child == 0) {
        const auto tap = open(name);
        for (std::uint32_t id = 1; id <= links; ++id)
            tap->on_link_up(LinkId{tap->last_link().value + id}, fmt::format("link {}", tap->last_link().value + id));
        tap->write(received(attitude(7), LinkId{tap->last_link().value + 2}), route::Verdict::forwarded, false);
        ::kill(::getpid(), SIGKILL);
    }
    ASSERT_EQ(::waitpid(child, nullptr, 0), child);
}

TEST(RingTap, LinksOfARouterThatWasKilledKeepTheirNamesAndNumbers) {
    const RingName name;
    EXPECT_EQ(open(name)->last_link(), LinkId{0});
    leave_a_ring(name, 3);
    leave_a_ring(name, 2);
    const auto tap = open(name);
    EXPECT_EQ(tap->last_link(), LinkId{5});
    tap->on_link_up(LinkId{6}, "link 6");
    const auto page = shm::read_counters(name.text());
    ASSERT_TRUE(page);
    std::map<LinkId, std::string> names;
    for (std::uint32_t id = 1; id <= 6; ++id) names.emplace(LinkId{id}, fmt::format("link {}", id));
    EXPECT_EQ(page->links, names);
}

TEST(RingTap, ContinuesBehindTheNumbersOfRecordsWhereThereIsNoPage) {
    const RingName name;
    leave_a_ring(name, 3);
    ASSERT_EQ(::unlink((name.path() + ".stat").c_str()), 0);
    EXPECT_EQ(open(name)->last_link(), LinkId{2});
}

TEST(RingTap, LinksCountOnFromAGivenNumber) {
    Node node;
    node.links->count_from(LinkId{1000});
    const auto in = node.add("udpin://127.0.0.1:0");
    for (int i = 0; i < 2; ++i) PlainSocket::udp().send_to(node.port(in), heartbeat(1));
    ASSERT_TRUE(until([&] { return node.recorder.ups.size() == 2; }, node));
    EXPECT_EQ(node.recorder.ups[0].first, LinkId{1001});
    EXPECT_EQ(node.recorder.ups[1].first, LinkId{1002});
}

// ---- the page

struct Counted {
    LinkId id;
    link::LinkCounters counters;
};

std::vector<link::LinkInfo> infos(const std::vector<Counted>& links) {
    std::vector<link::LinkInfo> all;
    all.reserve(links.size());
    for (const auto& link : links)
        all.push_back({link.id, {}, fmt::format("link {}", link.id.value), true, Rank::own, &link.counters});
    return all;
}

std::vector<Counted> links_with(const std::vector<std::uint64_t>& frames) {
    std::vector<Counted> links;
    for (const auto count : frames) {
        links.push_back({LinkId{static_cast<std::uint32_t>(links.size() + 1)}, {}});
        links.back().counters.frames_in.set(count);
    }
    return links;
}

std::vector<std::uint32_t> ids(const std::vector<const link::LinkInfo*>& links) {
    std::vector<std::uint32_t> all;
    all.reserve(links.size());
    for (const auto* link : links) all.push_back(link->id.value);
    return all;
}

TEST(BusiestLinks, AreThoseOfMostFramesInAndOut) {
    auto links = links_with({5, 1, 9, 2, 7});
    links[1].counters.frames_out.set(7);
    const auto all = infos(links);
    EXPECT_THAT(ids(busiest_links(all, 10)), ::testing::ElementsAre(1, 2, 3, 4, 5));
    EXPECT_THAT(ids(busiest_links(all, 3)), ::testing::ElementsAre(2, 3, 5));
    EXPECT_THAT(ids(busiest_links(infos(links_with({4, 4, 4})), 2)), ::testing::ElementsAre(1, 2))
        << "the older of equals";
    EXPECT_TRUE(busiest_links({}, 3).empty());
}

std::map<std::string, std::uint64_t> unlinked(const shm::CounterSnapshot& page) {
    std::map<std::string, std::uint64_t> values;
    for (const auto& counter : page.counters)
        if (!counter.link) values[counter.label] = counter.value;
    return values;
}

std::vector<std::uint32_t> rows(const shm::CounterSnapshot& page) {
    std::vector<std::uint32_t> all;
    for (const auto& counter : page.counters)
        if (counter.link && counter.label == "frames_in") all.push_back(counter.link->value);
    std::ranges::sort(all);
    return all;
}

TEST(RingPage, TheBusiestHaveRowsAndTheRestASum) {
    const RingName name;
    auto page = RingPage::create(name.text(), 0600);
    ASSERT_TRUE(page) << page.error().text;
    auto links = links_with(std::vector<std::uint64_t>(300, 10));
    link::EndpointCounters endpoint;
    endpoint.gone.frames_in.set(5);
    endpoint.stray_bytes.set(77);
    std::vector<link::EndpointInfo> endpoints(1);
    endpoints[0].id = link::EndpointId{4};
    endpoints[0].counters = &endpoint;
    page->refresh(infos(links), endpoints, link::EndpointId{4}, {1234, 6});

    auto seen = shm::read_counters(name.text());
    ASSERT_TRUE(seen);
    EXPECT_EQ(rows(*seen).size(), 256u);
    EXPECT_EQ(unlinked(*seen)["others_frames_in"], 44u * 10 + 5);
    EXPECT_EQ(unlinked(*seen)["ring_records"], 1234u);
    EXPECT_EQ(unlinked(*seen)["ring_dropped"], 6u);
    EXPECT_EQ(unlinked(*seen)["links"], 300u);
    EXPECT_EQ(unlinked(*seen)["inlet_stray_bytes"], 77u);

    // A source that becomes busy gets a row, and an idle one returns its row: again and again, in the same room.
    for (std::size_t busy = 256; busy < 300; ++busy) {
        links[busy].counters.frames_in.set(1000);
        page->refresh(infos(links), endpoints, link::EndpointId{4}, {});
    }
    seen = shm::read_counters(name.text());
    ASSERT_TRUE(seen);
    const auto now = rows(*seen);
    EXPECT_EQ(now.size(), 256u);
    for (std::uint32_t id = 257; id <= 300; ++id) EXPECT_TRUE(std::ranges::binary_search(now, id)) << id;
    EXPECT_EQ(unlinked(*seen)["others_frames_in"], 44u * 10 + 5);
}

TEST(RingPage, ALinkThatWasNeverUpHasANameAndItsState) {
    const RingName name;
    auto page = RingPage::create(name.text(), 0600);
    ASSERT_TRUE(page);
    const auto links = links_with({0, 3});
    auto all = infos(links);
    all[0].up = false;
    page->refresh(all, {}, {}, {});
    const auto seen = shm::read_counters(name.text());
    ASSERT_TRUE(seen);
    EXPECT_EQ(seen->links.at(LinkId{1}), "link 1");
    std::map<LinkId, std::uint64_t> up;
    for (const auto& counter : seen->counters)
        if (counter.label == "up") up.emplace(*counter.link, counter.value);
    EXPECT_THAT(up, ::testing::ElementsAre(std::pair(LinkId{1}, 0u), std::pair(LinkId{2}, 1u)));
}

TEST(RingPage, ALinkWithANameShowsWhereItSendsTo) {
    const RingName name;
    auto page = RingPage::create(name.text(), 0600);
    ASSERT_TRUE(page);
    const std::string to_station = "udpout://127.0.0.1:14550", to_tablet = "udpout://10.0.0.2:14550";
    const link::LinkCounters counters;
    const link::EndpointCounters of_endpoint;
    std::vector<link::LinkInfo> links;
    std::vector<link::EndpointInfo> endpoints;
    for (const auto& url :
         {to_station + "?name=station&mtu=0", to_tablet, std::string("udpin://0.0.0.0:14540?name=in")}) {
        const auto id = static_cast<std::uint32_t>(links.size() + 1);
        const auto endpoint = endpoint::parse_endpoint(url);
        ASSERT_TRUE(endpoint);
        endpoints.push_back({.id = link::EndpointId{id}, .endpoint = *endpoint, .counters = &of_endpoint});
        links.push_back({LinkId{id}, link::EndpointId{id}, endpoint->label(), true, Rank::own, &counters});
        page->name_link(LinkId{id}, endpoint->label());
    }
    const auto destinations = [&] {
        page->refresh(links, endpoints, {}, {});
        const auto seen = shm::read_counters(name.text());
        return seen ? seen->sends_to : std::map<LinkId, std::string>{};
    };
    EXPECT_THAT(destinations(), ::testing::ElementsAre(std::pair(LinkId{1}, to_station)));
    page->link_removed(LinkId{1});
    page->name_link(LinkId{1}, "station");
    EXPECT_THAT(destinations(), ::testing::ElementsAre(std::pair(LinkId{1}, to_station))) << "it came again";
}

TEST(RingPage, KeepsTheNamesOfLinksThatWentWhileThereIsRoom) {
    const RingName name;
    auto page = RingPage::create(name.text(), 0600);
    ASSERT_TRUE(page);
    constexpr std::uint32_t all = 6000;
    for (std::uint32_t id = 1; id <= all; ++id) {
        page->name_link(LinkId{id}, fmt::format("peer {}", id));
        page->link_removed(LinkId{id});
    }
    page->name_link(LinkId{all + 1}, "who lives");
    const auto seen = shm::read_counters(name.text());
    ASSERT_TRUE(seen);
    EXPECT_EQ(seen->links.size(), RingPage::max_gone + 1);
    EXPECT_EQ(seen->links.at(LinkId{all}), "peer 6000");
    EXPECT_EQ(seen->links.at(LinkId{all + 1}), "who lives");
}

TEST(RingPage, ALinkThatComesAgainIsNotGone) {
    const RingName name;
    auto page = RingPage::create(name.text(), 0600);
    ASSERT_TRUE(page);
    page->name_link(LinkId{1}, "tcpout");
    page->link_removed(LinkId{1});
    page->name_link(LinkId{1}, "tcpout");
    for (std::uint32_t id = 2; id <= 3000; ++id) {
        page->name_link(LinkId{id}, "peer");
        page->link_removed(LinkId{id});
    }
    const auto seen = shm::read_counters(name.text());
    ASSERT_TRUE(seen);
    EXPECT_EQ(seen->links.at(LinkId{1}), "tcpout");
}

}  // namespace
}  // namespace mavloom::ring
