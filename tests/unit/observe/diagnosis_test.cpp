// SPDX-License-Identifier: MIT
// Each rule on plain evidence: the case that it must find, and the nearest one that it must not.
#include "mavloom/observe/diagnosis.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <utility>

#include "mavloom/msg/attitude.hpp"
#include "mavloom/msg/command_long.hpp"
#include "mavloom/msg/message_interval.hpp"
#include "mavloom/msg/radio_status.hpp"
#include "mavloom/msg/request_data_stream.hpp"
#include "unit/observe/fixture.hpp"

namespace mavloom::observe {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr LinkId one{1}, two{2};

// A healthy vehicle at 100 Hz on one link, heard for 10 s.
Evidence healthy() {
    Evidence evidence{.dialect = &dialect::default_dialect(), .duration = 10s};
    evidence.sources.push_back({.name = "udpin", .duration = 10s, .counts = {{"frames_in", 1000}}});
    evidence.links.push_back({one, "udpin#a", 0});
    evidence.losses.push_back({.link = one, .link_name = "udpin#a", .source = vehicle, .received = 1000});
    SenderStream sender{.source = vehicle, .frames = 1000, .first = wall(0s), .last = wall(10s), .heartbeats = 10};
    sender.links[one] = 1000;
    sender.unsigned_frames = 1000;
    evidence.senders.push_back({sender});
    evidence.asked.emplace_back();
    evidence.streams.push_back({one, vehicle, msg::Attitude::id, "ATTITUDE", 1000, 40'000, 100});
    return evidence;
}

std::vector<std::string> ids(const Evidence& evidence) {
    std::vector<std::string> all;
    for (const auto& finding : diagnose(evidence)) all.emplace_back(finding.id);
    return all;
}

struct DiagnosisTest : ::testing::Test {
    [[nodiscard]] Listened& source() { return evidence.sources.front(); }
    [[nodiscard]] SenderStream& sender() { return evidence.senders.front().front(); }
    [[nodiscard]] SenderLoss& loss() { return evidence.losses.front(); }
    void count(const std::string& name, std::uint64_t value) { source().counts.push_back({name, value}); }
    void silence() {
        evidence = {.dialect = &dialect::default_dialect(), .duration = 10s};
        evidence.sources.push_back({.name = "udpin", .silence = "does it send?"});
        evidence.senders.emplace_back();
        evidence.asked.emplace_back();
    }
    Evidence evidence = healthy();
};

TEST_F(DiagnosisTest, NothingIsWrong) { EXPECT_THAT(ids(evidence), IsEmpty()); }

TEST_F(DiagnosisTest, LossesOfAPercentAreFound) {
    loss().lost = 5;
    EXPECT_THAT(ids(evidence), IsEmpty());
    loss().lost = 31;
    EXPECT_THAT(ids(evidence), ElementsAre("lost-before"));
    EXPECT_EQ(diagnose(evidence).front().what,
              "3.0 % of its frames did not arrive here: 31 of 1031 are missing in its sequence numbers.");
}

TEST_F(DiagnosisTest, OurOwnLossIsNotTheRadios) {
    loss().lost = 300;
    count("kernel_drop", 280);
    EXPECT_THAT(ids(evidence), ElementsAre("kernel-drop"));
}

TEST_F(DiagnosisTest, WhatARingMissesIsNotTheRadiosLoss) {
    source().kind = Listened::Kind::ring;
    loss().lost = 300;
    evidence.hops_before = {{.name = "router", .losses = {{"ring_dropped", 7}}}};
    evidence.hops_after = evidence.hops_before;
    EXPECT_THAT(ids(evidence), ElementsAre("lost-before"));
    evidence.hops_after.front().losses.front().count = 307;
    EXPECT_THAT(ids(evidence), ElementsAre("ring-dropped"));
}

TEST_F(DiagnosisTest, DamagedFramesExplainGaps) {
    loss().lost = 60;
    count("crc_error", 60);
    EXPECT_THAT(ids(evidence), ElementsAre("damaged-frames"));
}

TEST_F(DiagnosisTest, AMessageWithoutAGoodChecksumIsOfAnotherDialect) {
    count("crc_error", 60);
    evidence.bad_checksums.push_back({one, MessageId{74}, 60});
    EXPECT_THAT(ids(evidence), ElementsAre("wrong-dialect"));
    evidence.bad_checksums.front().id = msg::Attitude::id;  // of which there are good ones
    EXPECT_THAT(ids(evidence), ElementsAre("damaged-frames"));
}

TEST_F(DiagnosisTest, AMessageWithoutDefinition) {
    evidence.streams.push_back({one, vehicle, MessageId{70'000}, {}, 10, 300, 1});
    EXPECT_THAT(ids(evidence), ElementsAre("wrong-dialect"));
}

TEST_F(DiagnosisTest, DatagramsThatEthernetSplits) {
    count("long_datagrams", 7);
    EXPECT_THAT(ids(evidence), ElementsAre("long-datagrams"));
}

TEST_F(DiagnosisTest, CopiesShowHowMuchAStationLoses) {
    sender().links[two] = 1000;
    sender().frames = 2000;
    sender().copies_across = 1000;
    sender().station_lost = 1000;
    evidence.links.push_back({two, "udpin#b", 0});
    ASSERT_THAT(ids(evidence), ElementsAre("two-links"));
    EXPECT_THAT(diagnose(evidence).front().why, ::testing::HasSubstr("about 33.3 %"));
}

TEST_F(DiagnosisTest, TwoSequencesOnOneLinkAreTwoSenders) {
    sender().conflicts_on_link = 200;
    loss().lost = 500;
    EXPECT_THAT(ids(evidence), ElementsAre("two-senders"));
}

TEST_F(DiagnosisTest, TwoClocksAreTwoSenders) {
    evidence.alarms.push_back({.kind = Alarm::Kind::two_senders, .source = vehicle, .text = "their clocks differ"});
    EXPECT_THAT(ids(evidence), ElementsAre("two-senders"));
}

TEST_F(DiagnosisTest, CopiesButForTheirTimesAreTwoSenders) {
    sender().links[two] = 1000;
    sender().frames = 2000;
    sender().copies_across = 990;
    sender().clocks_across = 3;
    EXPECT_THAT(ids(evidence), ElementsAre("two-senders"));
}

TEST_F(DiagnosisTest, FaultsOfARouterMayExplainLossesAndHideNone) {
    loss().lost = 300;
    evidence.hops_before = {{.name = "router", .links = {{.name = "serial", .losses = {{"fault_lost", 10}}}}}};
    evidence.hops_after = evidence.hops_before;
    EXPECT_THAT(ids(evidence), ElementsAre("lost-before"));
    evidence.hops_after.front().links.front().losses.front().count = 310;
    ASSERT_THAT(ids(evidence), ElementsAre("faults-on", "lost-before"));
    const auto findings = diagnose(evidence);
    EXPECT_THAT(findings.front().what, ::testing::EndsWith(": fault_lost 300."));
    EXPECT_EQ(findings.back().severity, Finding::Severity::warning);
    EXPECT_THAT(findings.back().why, ::testing::HasSubstr("faults-on"));
}

TEST_F(DiagnosisTest, WhatFaultsHeldAndDroppedWasLostOnPurpose) {
    evidence.hops_before = {{.name = "router", .links = {{.name = "serial"}}}};
    evidence.hops_after = {{.name = "router", .links = {{.name = "serial", .losses = {{"held_dropped", 7}}}}}};
    ASSERT_THAT(ids(evidence), ElementsAre("faults-on"));
    EXPECT_THAT(diagnose(evidence).front().what, ::testing::EndsWith(": held_dropped 7."));
}

TEST_F(DiagnosisTest, APortThatIsTakenHidesNoOtherThatIsSilent) {
    silence();
    source().is_asked = false;
    source().refusal = "in use";
    source().is_taken = true;
    EXPECT_THAT(ids(evidence), ElementsAre("port-taken"));
    evidence.sources.push_back({.name = "udpin2", .is_asked = false});
    ASSERT_THAT(ids(evidence), ElementsAre("port-taken", "nothing-heard"));
    EXPECT_THAT(diagnose(evidence).back().why, ::testing::EndsWith("udpin (not open), udpin2."));
}

TEST_F(DiagnosisTest, AVehicleWithTwoPortsIsOne) {
    sender().links[two] = 500;
    sender().frames = 1500;
    sender().conflicts_across = 900;
    EXPECT_THAT(ids(evidence), ElementsAre("two-links"));
    sender().source = loss().source = station;  // it has no clock that would show two of them
    EXPECT_THAT(ids(evidence), ElementsAre("two-senders"));
}

TEST_F(DiagnosisTest, AStreamThatIsSplitIsWhole) {
    sender().links = {{one, 500}, {two, 500}};
    evidence.links.push_back({two, "udpin#b", 0});
    loss().received = loss().lost = 500;
    EXPECT_THAT(ids(evidence), ElementsAre("split-stream"));
    sender().missing = 300;
    EXPECT_THAT(ids(evidence), ElementsAre("lost-before"));
}

TEST_F(DiagnosisTest, OneHeartbeatOfASystemIsEnough) {
    sender().heartbeats = 0;
    EXPECT_THAT(ids(evidence), ElementsAre("no-heartbeat"));
    auto camera = sender();
    camera.source.component = ComponentId{100};
    camera.heartbeats = 10;
    evidence.senders.front().push_back(camera);
    EXPECT_THAT(ids(evidence), IsEmpty());
}

TEST_F(DiagnosisTest, HighLatencyAndRadiosNeedNoHeartbeat) {
    sender().heartbeats = 0;
    for (const auto id : {MessageId{235}, msg::RadioStatus::id}) {
        evidence.streams = {{one, vehicle, id, "X", 10, 100, 1}};
        EXPECT_THAT(ids(evidence), IsEmpty()) << id.value;
    }
}

TEST_F(DiagnosisTest, UnsignedBesideSigned) {
    auto ground = sender();
    ground.source = station;
    ground.unsigned_frames = 0;
    ground.signed_frames = 50;
    evidence.senders.front().push_back(ground);
    ASSERT_THAT(ids(evidence), ElementsAre("unsigned-frames"));
    EXPECT_EQ(diagnose(evidence).front().what, "255/190 signs its frames, 1/1 does not.");
}

TEST_F(DiagnosisTest, ASilentPortStatesWhatToCheck) {
    silence();
    ASSERT_THAT(ids(evidence), ElementsAre("nothing-heard"));
    EXPECT_EQ(diagnose(evidence).front().remedy, "Check: does it send?");
}

TEST_F(DiagnosisTest, JunkOnASerialPortIsAWrongBaudRate) {
    silence();
    count("junk_bytes", 1000);
    EXPECT_THAT(ids(evidence), ElementsAre("not-mavlink"));
    source().kind = Listened::Kind::serial;
    EXPECT_THAT(ids(evidence), ElementsAre("wrong-baud"));
    evidence.bad_checksums = {{one, MessageId{74}, 4}};  // junk has the ids of messages here and there
    EXPECT_THAT(ids(evidence), ElementsAre("wrong-baud"));
}

TEST_F(DiagnosisTest, OfPortsThatWereOnlyTriedOneIsEnough) {
    source().is_asked = false;
    evidence.sources.push_back({.name = "udpin2", .is_asked = false});
    EXPECT_THAT(ids(evidence), IsEmpty());
    source().counts.clear();
    EXPECT_THAT(ids(evidence), ElementsAre("nothing-heard"));
}

TEST_F(DiagnosisTest, ABufferIsTooSmallIfItHoldsLessThanATenthOfASecond) {
    source().rcvbuf_asked = 32u << 20;
    source().rcvbuf_granted = 425'984;
    EXPECT_THAT(ids(evidence), IsEmpty());
    source().counts = {{"frames_in", 100'000}};
    EXPECT_THAT(ids(evidence), ElementsAre("receive-buffer"));
}

TEST_F(DiagnosisTest, OnlyLossesThatGrowAreFound) {
    HopLink link{.name = "serial", .losses = {{"queue_age", 10}}, .refused = 5};
    evidence.hops_before = {{.name = "router", .links = {link}}};
    evidence.hops_after = evidence.hops_before;
    EXPECT_THAT(ids(evidence), IsEmpty());
    evidence.hops_after.front().links.front().losses.front().count = 12;
    EXPECT_THAT(ids(evidence), ElementsAre("queue-drop"));
    evidence.hops_after.front().links.front().refused = 6;
    EXPECT_THAT(ids(evidence), ElementsAre("queue-drop", "port-refused"));
}

// The doctor itself may have opened it, and a link with a name does not show its port.
TEST_F(DiagnosisTest, APortThatWasOpenedMeanwhileIsNotClosed) {
    evidence.hops_before = {{.name = "router", .links = {{.name = "tablet", .frames_out = 100, .refused = 5}}}};
    evidence.hops_settled = evidence.hops_after = evidence.hops_before;
    auto &settled = evidence.hops_settled.front().links.front(), &after = evidence.hops_after.front().links.front();
    settled.refused = after.refused = 95;
    EXPECT_THAT(ids(evidence), ElementsAre("port-refused")) << "nothing was sent since";
    after.frames_out = 900;
    EXPECT_THAT(ids(evidence), IsEmpty());
    after.refused = 96;
    EXPECT_THAT(ids(evidence), ElementsAre("port-refused")) << "it is closed again";
}

TEST_F(DiagnosisTest, APortThatOnlyTheDoctorHasOpenWasNotClosedByMistake) {
    source().kind = Listened::Kind::listens;
    source().name = "udpin://127.0.0.1:14550";
    evidence.hops_before = {
        {.name = "router", .links = {{.name = "tablet", .sends_to = "udpout://127.0.0.1:14550", .refused = 5}}}};
    evidence.hops_after = evidence.hops_before;
    auto& link = evidence.hops_after.front().links.front();
    link.refused = 95;
    EXPECT_THAT(ids(evidence), IsEmpty());
    link.sends_to = "udpout://192.0.2.7:14550";
    EXPECT_THAT(ids(evidence), ElementsAre("port-refused")) << "the same port of another machine";
}

TEST_F(DiagnosisTest, TheCountsOfALinkThatClosedAreOld) {
    evidence.hops_before = {{.name = "router", .links = {{.name = "closed links", .is_sum = true}}}};
    evidence.hops_after = evidence.hops_before;
    auto& sum = evidence.hops_after.front().links.front();
    sum.losses = {{"queue_age", 12}};
    sum.refused = 6;
    EXPECT_THAT(ids(evidence), IsEmpty());
}

TEST_F(DiagnosisTest, AFullLineNamesItsLargestStream) {
    source().kind = Listened::Kind::serial;
    source().baud = 57'600;
    count("bytes_in", 30'000);
    EXPECT_THAT(ids(evidence), IsEmpty());
    count("bytes_in", 20'000);
    ASSERT_THAT(ids(evidence), ElementsAre("link-full"));
    EXPECT_THAT(diagnose(evidence).front().why,
                ::testing::HasSubstr("ATTITUDE of 1/1 at 100 Hz (100.0 %). Nobody asked for ATTITUDE"));
}

TEST_F(DiagnosisTest, RadiosThatAreFullOrWeak) {
    RadioReport radio;
    radio.link = one;
    radio.count = 100;
    radio.rxerrors = 4;
    radio.lowest_margin = 60;
    evidence.radios = {radio};
    EXPECT_THAT(ids(evidence), IsEmpty());
    evidence.radios.front().rxerrors = 40;
    EXPECT_THAT(ids(evidence), ElementsAre("radio-weak"));
    evidence.radios.front().lowest_txbuf_percent = 10;
    EXPECT_THAT(ids(evidence), ElementsAre("radio-full", "radio-weak"));
}

TEST_F(DiagnosisTest, SilenceAndClocksOfLinksThatLive) {
    for (const auto& [kind, id] : {std::pair{Alarm::Kind::silent, "went-silent"},
                                   {Alarm::Kind::clock, "clock-jump"},
                                   {Alarm::Kind::restart, "restart"}}) {
        evidence.alarms = {{.kind = kind, .source = vehicle, .text = "something happened"}};
        EXPECT_THAT(ids(evidence), ElementsAre(id));
    }
    evidence.alarms = {{.kind = Alarm::Kind::silent, .source = vehicle}};
    evidence.is_recorded = true;
    EXPECT_THAT(ids(evidence), IsEmpty());
}

TEST_F(DiagnosisTest, WhatIsLostBetweenTwoSourcesIsNoLossBeforeTheSecond) {
    evidence.sources.push_back(source());
    evidence.senders.push_back(evidence.senders.front());
    evidence.asked.emplace_back();
    evidence.links.push_back({two, "second", 1});
    evidence.losses.push_back({.link = two, .source = vehicle, .received = 900, .lost = 100});
    EXPECT_THAT(ids(evidence), ElementsAre("lost-before"));
    Passage passage{.source = vehicle, .is_comparable = true, .before = 1000, .lost = 100};
    passage.messages = {{msg::Attitude::id, 900, 100}};
    evidence.passages = {{passage}};
    EXPECT_THAT(ids(evidence), ElementsAre("lost-between"));
    passage.filtered = std::exchange(passage.lost, 0);
    passage.messages.front().is_filtered = true;
    evidence.passages = {{passage}};
    EXPECT_THAT(ids(evidence), ElementsAre("filtered-between"));
}

// ---- rates

struct RatesTest : DiagnosisTest {
    template <class Message>
    void hear(const Message& message, Nanoseconds at, Source from = vehicle) {
        const auto bytes = frame_of(message, from);
        rates.take({.frame = view(bytes), .link = one, .link_name = "a", .time = wall(at), .now = mono(at)});
    }
    void ask(float interval_us, Nanoseconds at = 0s, Source from = station) {
        hear(msg::CommandLong{.target_system = 1, .command = 511, .param1 = 30, .param2 = interval_us}, at, from);
    }
    // ATTITUDE at 10 Hz.
    void stream() {
        for (int i = 0; i < 100; ++i) hear(msg::Attitude{}, i * 100ms);
    }
    [[nodiscard]] std::vector<std::string> found() {
        evidence.asked.front() = rates.all();
        return ids(evidence);
    }
    AskedRates rates;
};

TEST_F(RatesTest, ARateThatIsMetIsRight) {
    ask(100'000);
    stream();
    EXPECT_THAT(found(), IsEmpty());
}

TEST_F(RatesTest, ARateThatIsNotMet) {
    ask(20'000);
    stream();
    EXPECT_THAT(found(), ElementsAre("rate-low"));
    EXPECT_EQ(diagnose(evidence).front().what, "ATTITUDE came at 10 Hz, 50 Hz asked by 255/190.");
}

TEST_F(RatesTest, ARateThatIsTooHigh) {
    ask(1'000'000);
    stream();
    EXPECT_THAT(found(), ElementsAre("rate-high"));
}

TEST_F(RatesTest, AMessageThatShallNotComeAndComes) {
    ask(-1);
    stream();
    EXPECT_THAT(found(), ElementsAre("rate-high"));
}

TEST_F(RatesTest, TheUsualRateIsNoRequest) {
    ask(20'000);
    ask(0);
    stream();
    EXPECT_THAT(found(), IsEmpty());
}

TEST_F(RatesTest, ALaterRequestCounts) {
    ask(20'000);
    ask(100'000, 1ms);
    stream();
    EXPECT_THAT(found(), IsEmpty());
}

TEST_F(RatesTest, TwoStationsThatDisagree) {
    ask(20'000);
    ask(100'000, 1ms, {SystemId{254}, ComponentId{190}});
    stream();
    EXPECT_THAT(found(), ElementsAre("rate-contested"));
}

TEST_F(RatesTest, TheVehiclesOwnReport) {
    hear(msg::MessageInterval{.message_id = 30, .interval_us = 20'000}, 0s);
    stream();
    EXPECT_THAT(found(), ElementsAre("rate-low"));
    ask(100'000);  // counts more
    stream();
    EXPECT_THAT(found(), IsEmpty());
}

TEST_F(RatesTest, AStreamGroupThatIsIgnored) {
    hear(msg::RequestDataStream{.target_system = 1, .req_stream_id = 10, .req_message_rate = 50, .start_stop = 1}, 0s,
         station);
    stream();
    ASSERT_THAT(found(), ElementsAre("rate-low"));
    EXPECT_THAT(diagnose(evidence).front().why, ::testing::HasSubstr("PX4 ignores"));
}

TEST_F(RatesTest, FramesThatAreLostAreNotMissed) {
    ask(80'000);  // 12.5 Hz
    stream();
    EXPECT_THAT(found(), IsEmpty());
    ask(50'000, 1ms);
    stream();
    loss().lost = 1000;
    EXPECT_THAT(found(), ElementsAre("lost-before"));
}

TEST(RadioReports, CountersGrowAndWrap) {
    RadioReports radios;
    for (const std::uint16_t errors : std::to_array<std::uint16_t>({65'530, 65'535, 4})) {
        const auto bytes = frame_of(
            msg::RadioStatus{.rssi = 100, .remrssi = 90, .txbuf = 50, .noise = 40, .remnoise = 50, .rxerrors = errors});
        radios.take({.frame = view(bytes), .link = one, .link_name = "a", .time = {}, .now = {}});
    }
    const auto& radio = radios.all().front();
    EXPECT_EQ(radio.rxerrors, 10u);
    EXPECT_EQ(radio.lowest_margin, 40);
    EXPECT_EQ(radio.lowest_txbuf_percent, 50);
    EXPECT_EQ(radio.count, 3u);
}

}  // namespace
}  // namespace mavloom::observe
