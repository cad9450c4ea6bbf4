// SPDX-License-Identifier: MIT
// Endpoints that are added, removed and replaced while a router runs, over loopback. Rules: docs/guide/route.md.
#include "mavloom/router/router.hpp"

#include <gmock/gmock.h>

#include "support/temp_dir.hpp"
#include "unit/link/fixture.hpp"

namespace mavloom::router {
namespace {

using namespace std::chrono_literals;
using link::testing::Bytes;
using link::testing::endpoint_of;
using link::testing::PlainSocket;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::uint16_t free_port() { return PlainSocket::udp().port(); }
std::string udpin(std::uint16_t port, std::string_view options = "") {
    return fmt::format("udpin://127.0.0.1:{}{}", port, options);
}

struct RouterTest : testing::Test {
    void add(const std::string& url) {
        const auto added = sut->add(endpoint_of(url));
        ASSERT_TRUE(added) << added.error().text;
    }
    void apply(const std::vector<std::string>& urls) {
        std::vector<endpoint::Endpoint> endpoints;
        for (const auto& url : urls) endpoints.push_back(endpoint_of(url));
        notices.clear();
        sut->apply(endpoints);
    }
    template <class Condition>
    bool until(Condition&& condition) {
        for (const auto deadline = mono_now() + 60s; !condition();) {
            if (mono_now() > deadline) return false;
            sut->turn(mono_now() + 1ms);
        }
        return true;
    }
    // The socket's heartbeat has arrived at `port`; it is a link there.
    bool heard(const PlainSocket& from, std::uint16_t port, std::uint8_t system) {
        const auto before = sut->links().links().size();
        from.send_to(port, link::testing::heartbeat(0, system));
        return until([&] { return sut->links().links().size() > before; });
    }
    [[nodiscard]] std::vector<std::string> labels() const {
        std::vector<std::string> all;
        for (const auto& endpoint : sut->links().endpoints()) all.push_back(endpoint.label());
        return all;
    }
    [[nodiscard]] std::vector<std::uint32_t> link_ids() const {
        std::vector<std::uint32_t> ids;
        for (const auto& link : sut->links().links()) ids.push_back(link.id.value);
        return ids;
    }

    [[nodiscard]] std::uint64_t frames_in() const { return sut->links().links().at(0).counters->frames_in.value(); }

    std::vector<std::string> notices;
    std::unique_ptr<Router> sut = std::move(
        *Router::create(dialect::default_dialect(), {.route_timeout = 60s},
                        [this](config::LogLevel, std::string_view text) { notices.emplace_back(text); }));
    test::TempDir folder;
};

TEST_F(RouterTest, AnEndpointThatIsRemovedTakesItsRoutesAlong) {
    const auto port = free_port(), other = free_port();
    add(udpin(port));
    add(udpin(other));
    const auto vehicle = PlainSocket::udp();
    ASSERT_TRUE(heard(vehicle, port, 1));
    ASSERT_EQ(sut->engine().routes(mono_now()).size(), 1u);

    EXPECT_TRUE(sut->remove(udpin(port)));

    EXPECT_THAT(sut->engine().routes(mono_now()), IsEmpty());
    EXPECT_THAT(labels(), ElementsAre(udpin(other)));
    EXPECT_FALSE(sut->remove(udpin(port)));
}

TEST_F(RouterTest, APeerIsClosedByTheNameOfItsLinkAndMayComeBack) {
    const auto port = free_port();
    add(udpin(port));
    const auto vehicle = PlainSocket::udp();
    ASSERT_TRUE(heard(vehicle, port, 1));

    EXPECT_TRUE(sut->remove(fmt::format("{}#127.0.0.1:{}", udpin(port), vehicle.port())));

    EXPECT_THAT(link_ids(), IsEmpty());
    ASSERT_TRUE(heard(vehicle, port, 1));
    EXPECT_THAT(link_ids(), ElementsAre(2));
}

TEST_F(RouterTest, AReloadTouchesOnlyWhatChanged) {
    const auto same = free_port(), changed = free_port(), gone = free_port(), fresh = free_port();
    for (const auto port : {same, changed, gone}) add(udpin(port));
    const PlainSocket vehicle = PlainSocket::udp(), station = PlainSocket::udp();
    ASSERT_TRUE(heard(vehicle, same, 1));
    ASSERT_TRUE(heard(station, changed, 255));

    apply({udpin(same), udpin(changed, "?in_block=ATTITUDE"), udpin(fresh)});

    EXPECT_THAT(labels(), ElementsAre(udpin(same), udpin(changed), udpin(fresh)));
    EXPECT_THAT(link_ids(), ElementsAre(1)) << "the vehicle's link stays, the station has to call again";
    EXPECT_THAT(notices, ElementsAre(udpin(changed) + ": removed", udpin(gone) + ": removed",
                                     udpin(changed) + ": added", udpin(fresh) + ": added"));
}

TEST_F(RouterTest, WhatCannotBeOpenedIsLeftOutAndItsFormerSelfContinues) {
    const auto port = free_port();
    const auto taken = PlainSocket::udp();
    add(udpin(port, "?name=air"));

    apply({udpin(taken.port(), "?name=air")});

    EXPECT_THAT(labels(), ElementsAre("air"));
    EXPECT_THAT(notices, AllOf(Contains(HasSubstr("left out:")), Contains("air: continues with its former options")));
    const auto vehicle = PlainSocket::udp();
    EXPECT_TRUE(heard(vehicle, port, 1));
}

TEST_F(RouterTest, AnotherModeOfAGroupReopensAllItsMembers) {
    const auto first = free_port(), second = free_port();
    add(udpin(first, "?group=air&group_mode=all"));
    add(udpin(second, "?group=air"));

    apply({udpin(first, "?group=air&group_mode=best"), udpin(second, "?group=air")});

    EXPECT_THAT(notices, AllOf(Contains(udpin(first) + ": removed"), Contains(udpin(second) + ": removed"),
                               Contains(udpin(first) + ": added"), Contains(udpin(second) + ": added")));
    EXPECT_THAT(notices, Not(Contains(HasSubstr("left out"))));
}

TEST_F(RouterTest, AGroupHasOneMode) {
    add(udpin(free_port(), "?group=air&group_mode=best"));

    const auto added = sut->add(endpoint_of(udpin(free_port(), "?group=air&group_mode=primary")));

    ASSERT_FALSE(added);
    EXPECT_EQ(added.error().code, SetupCode::usage);
    EXPECT_THAT(added.error().text, HasSubstr("already has group_mode=best"));
    add(udpin(free_port(), "?group=air"));
}

TEST_F(RouterTest, RefusesWhatIsNoEndpointOfARouter) {
    EXPECT_EQ(sut->add(endpoint_of("shm://px4")).error().code, SetupCode::usage);
    const auto silent = sut->add(endpoint_of(udpin(free_port(), "?heartbeat=true")));
    EXPECT_THAT(silent.error().text, HasSubstr(std::string(config::heartbeat_needs_id)));
    EXPECT_THAT(labels(), IsEmpty());
}

TEST_F(RouterTest, RecordsWhatArrivesAndEndsARecordingThatIsRemoved) {
    const auto port = free_port();
    const auto recording = "tlog://" + (folder / "a.tlog").string();
    add(udpin(port));
    add(recording);
    EXPECT_EQ(sut->add(endpoint_of(recording + "?name=again")).error().code, SetupCode::usage);
    const auto vehicle = PlainSocket::udp();
    ASSERT_TRUE(heard(vehicle, port, 1));

    EXPECT_TRUE(sut->remove(recording));
    sut->finish(0s);

    constexpr std::uintmax_t time_bytes = 8;
    EXPECT_EQ(std::filesystem::file_size(folder / "a.tlog"), time_bytes + link::testing::heartbeat(0).size());
}

// More than a turn reads.
TEST_F(RouterTest, TheEndHandlesWhatHasArrived) {
    const auto port = free_port();
    add(udpin(port));
    const auto vehicle = PlainSocket::udp();
    ASSERT_TRUE(heard(vehicle, port, 1));
    for (int i = 1; i < 150; ++i) vehicle.send_to(port, link::testing::heartbeat(static_cast<std::uint8_t>(i)));

    sut->finish(60s);

    EXPECT_EQ(frames_in(), 150u);
}

// Without the limit, it reads for up to 64 turns.
TEST_F(RouterTest, TheEndReadsNoLongerThanItsLimit) {
    const auto port = free_port();
    add(udpin(port));
    const auto vehicle = PlainSocket::udp();
    ASSERT_TRUE(heard(vehicle, port, 1));
    for (int i = 1; i < 150; ++i) vehicle.send_to(port, link::testing::heartbeat(static_cast<std::uint8_t>(i)));

    sut->finish(0s);

    EXPECT_LT(frames_in(), 150u);
}

TEST_F(RouterTest, AReloadEndsRecordingsThatAreNotWantedAndKeepsTheOthers) {
    const auto port = free_port();
    const auto kept = "tlog://" + (folder / "kept.tlog").string(), ended = "tlog://" + (folder / "ended.tlog").string();
    for (const auto& url : {udpin(port), kept, ended}) add(url);

    apply({udpin(port), kept});

    EXPECT_THAT(notices, ElementsAre(ended + ": removed"));
    std::vector<std::string> open;
    for (const auto* recorder : sut->recorders()) open.push_back(recorder->label());
    EXPECT_THAT(open, ElementsAre(kept));
}

// A flood of requests takes at most a fifth of the time.
TEST_F(RouterTest, PostedWorkRestsAfterAnItem) {
    MonoTime end_of_first{}, begin_of_second{};
    Nanoseconds took{};
    sut->post([&] {
        const MonoTime begin = mono_now();
        while (mono_now() - begin < 5ms) {}
        end_of_first = mono_now();
        took = end_of_first - begin;
    });
    sut->post([&] { begin_of_second = mono_now(); });

    ASSERT_TRUE(until([&] { return begin_of_second != MonoTime{}; }));
    EXPECT_GE(begin_of_second - end_of_first, 4 * took);
}

}  // namespace
}  // namespace mavloom::router
