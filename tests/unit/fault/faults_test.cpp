// SPDX-License-Identifier: MIT
// In simulated time, receivers measure what was injected. And faults of real links.
#include "mavloom/fault/faults.hpp"

#include <algorithm>
#include <map>

#include "mavloom/wire/sequence.hpp"
#include "unit/link/fixture.hpp"

namespace mavloom::fault {
namespace {

using namespace std::chrono_literals;
using namespace link::testing;
using link::LinkCounters;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Plan plan(const std::string& out, std::uint64_t seed = 1) {
    auto faults = endpoint::parse_faults(out);
    EXPECT_TRUE(faults) << (faults ? "" : faults.error().text);
    return {.out = faults.value_or(endpoint::Faults{}), .seed = seed};
}

// A line with faults, and a receiver at its end that counts as every link does.
class Line {
public:
    explicit Line(const Plan& plan, std::uint64_t ordinal = 0)
        : stages_(stages_of(plan, "line", {LinkId{1}, "line", true, ordinal, counters, table()})) {}

    // Sends `count` frames, one every 10 ms, then waits until nothing is held.
    void send(int count) {
        for (int i = 0; i < count; ++i, now_ += 10ms) {
            release(now_);
            const Bytes frame = heartbeat(static_cast<std::uint8_t>(i));
            bytes_sent += frame.size();
            sent_at.push_back(now_);
            pass(0, {.bytes = frame}, now_);
        }
        release(MonoTime::max());
        parser_.finish([&](const wire::ParseEvent& event) { note(event); });
    }

    LinkCounters counters;
    std::vector<std::uint8_t> arrived;  // their sequence numbers
    std::vector<MonoTime> times;        // of the pieces that arrived
    std::vector<MonoTime> sent_at;
    std::size_t bytes_sent = 0;

private:
    struct Held {
        std::size_t place;
        Bytes bytes;
    };
    class Step final : public link::Next {
    public:
        Step(Line& line, std::size_t place, MonoTime now) : line_(line), place_(place), now_(now) {}
        void pass(const link::Piece& piece) noexcept override { line_.pass(place_, piece, now_); }
        void pass_at(const link::Piece& piece, MonoTime when) noexcept override {
            if (when <= now_) return pass(piece);
            line_.held_.emplace(when, Held{place_, {piece.bytes.begin(), piece.bytes.end()}});
        }

    private:
        Line& line_;
        std::size_t place_;
        MonoTime now_;
    };

    void pass(std::size_t place, const link::Piece& piece, MonoTime now) {
        if (place == stages_.out.size()) return arrive(piece.bytes, now);
        Step next(*this, place + 1, now);
        stages_.out[place]->take(piece, now, next);
    }
    void release(MonoTime end) {
        while (!held_.empty() && held_.begin()->first <= end) {
            const auto node = held_.extract(held_.begin());
            pass(node.mapped().place, {.bytes = node.mapped().bytes}, node.key());
        }
    }
    void arrive(ByteView bytes, MonoTime now) {
        times.push_back(now);
        parser_.feed(bytes, now, [&](const wire::ParseEvent& event) { note(event); });
    }
    void note(const wire::ParseEvent& event) {
        using Kind = wire::ParseEvent::Kind;
        if (event.kind == Kind::bad_checksum) counters.crc_error.add();
        if (event.kind == Kind::junk) counters.junk_bytes.add(event.bytes);
        if (event.kind != Kind::frame) return;
        counters.frames_in.add();
        counters.bytes_in.add(event.frame.size());
        if (event.info == nullptr) counters.unknown_ids.add();
        arrived.push_back(event.frame.sequence());
        counters.add(tracker_.update(event.frame, event.info));
    }

    link::Stages stages_;
    std::multimap<MonoTime, Held> held_;
    MonoTime now_{1h};
    wire::StreamParser parser_{table()};
    wire::SequenceTracker tracker_;
};

constexpr int many = 20'000;

// Frames lost before the first and after the last that arrived leave no gap.
std::uint64_t at_the_ends(const Line& line) {
    const auto first = line.arrived.front();
    const auto last = static_cast<std::uint8_t>(many - 1 - line.arrived.back());
    return std::uint64_t{first} + last;
}

TEST(Injected, LossIsWhatTheReceiverCounts) {
    for (const char* faults : {"loss:0.05", "loss:0.3", "loss:0.05/8", "loss:0.2/6", "loss:0.01/10"}) {
        Line line(plan(faults));
        line.send(many);
        const LinkCounters& c = line.counters;
        EXPECT_EQ(c.frames_in.value() + c.fault_lost.value(), many) << faults;
        EXPECT_EQ(c.lost.value() + at_the_ends(line), c.fault_lost.value()) << faults;
        EXPECT_EQ(c.late.value() + c.duplicate.value() + c.resync.value(), 0u) << faults;
        EXPECT_GT(c.fault_lost.value(), 0u) << faults;
    }
}

TEST(Injected, CopiesAreWhatTheReceiverCounts) {
    Line line(plan("duplicate:0.1"));
    line.send(many);
    EXPECT_EQ(line.counters.duplicate.value(), line.counters.fault_duplicated.value());
    EXPECT_EQ(line.counters.frames_in.value(), many + line.counters.fault_duplicated.value());
    EXPECT_EQ(line.counters.lost.value() + line.counters.late.value() + line.counters.resync.value(), 0u);
    EXPECT_NEAR(static_cast<double>(line.counters.fault_duplicated.value()), 2000, 5 * 42.5);
}

// Frames that were held back when no more followed, so that nothing overtook them. Those that passed at once arrive
// every 10 ms, until 10 ms before the end; the time of the last ones is later.
std::uint64_t held_at_the_end(const Line& line) {
    const auto last_passed = std::ranges::find_if(line.sent_at.rbegin(), line.sent_at.rend(), [&](MonoTime sent) {
        return std::ranges::find(line.times, sent) != line.times.end();
    });
    return static_cast<std::uint64_t>(last_passed - line.sent_at.rbegin());
}

// Nine frames follow within the 95 ms. That all of those are held back too has a probability of 1e-9.
TEST(Injected, OvertakenFramesAreWhatTheReceiverCounts) {
    Line line(plan("reorder:0.1/95ms"));
    line.send(many);
    const LinkCounters& c = line.counters;
    EXPECT_EQ(c.late.value() + held_at_the_end(line), c.fault_reordered.value());
    EXPECT_EQ(c.frames_in.value(), many);
    EXPECT_EQ(c.lost.value() + c.duplicate.value() + c.resync.value(), 0u);
}

TEST(Injected, EachBlackOutIsOneGapOrOneResync) {
    Line shorter(plan("blackout:500ms/2s"));
    shorter.send(2000);  // 20 s: ten black-outs of 50 frames, the last at the end
    EXPECT_EQ(shorter.counters.fault_blackout.value(), 500u);
    EXPECT_EQ(shorter.counters.lost.value(), 450u);
    EXPECT_EQ(shorter.counters.resync.value(), 0u);

    Line longer(plan("blackout:1500ms/4s"));
    longer.send(2100);  // 21 s: five black-outs of 150 frames
    EXPECT_EQ(longer.counters.fault_blackout.value(), 750u);
    EXPECT_EQ(longer.counters.lost.value(), 0u) << "a gap of more than 100 frames is no loss";
    EXPECT_EQ(longer.counters.resync.value(), 5u);
}

TEST(Injected, AStallLosesNothingAndKeepsTheOrder) {
    Line line(plan("stall:500ms/2s"));
    line.send(2000);
    EXPECT_EQ(line.counters.fault_stalled.value(), 500u);
    EXPECT_EQ(line.counters.frames_in.value(), 2000u);
    EXPECT_EQ(line.counters.lost.value() + line.counters.late.value() + line.counters.resync.value(), 0u);
}

// With an inverted bit in its message id, a frame may pass as one of an unknown message.
TEST(Injected, EachCorruptedFrameIsMissingAndItsBytesAreCounted) {
    Line line(plan("corrupt:0.05"));
    line.send(many);
    const LinkCounters& c = line.counters;
    const std::uint64_t whole = c.frames_in.value() - c.unknown_ids.value();
    EXPECT_EQ(whole + c.fault_corrupted.value(), many);
    EXPECT_EQ(c.bytes_in.value() + c.junk_bytes.value(), line.bytes_sent);
    EXPECT_EQ(c.lost.value() + c.unknown_ids.value() + at_the_ends(line), c.fault_corrupted.value());
    EXPECT_GT(c.crc_error.value(), c.fault_corrupted.value() / 2);
    EXPECT_EQ(c.resync.value() + c.late.value(), 0u);
}

TEST(Injected, EachCutFrameIsMissingAndNoOther) {
    Line line(plan("cut:0.05"));
    line.send(many);
    const LinkCounters& c = line.counters;
    EXPECT_EQ(c.frames_in.value() + c.fault_cut.value(), many);
    EXPECT_EQ(c.lost.value() + at_the_ends(line), c.fault_cut.value());
    EXPECT_GT(c.junk_bytes.value(), c.fault_cut.value() - 1) << "at least a byte of each";
}

// 21 bytes every 10 ms are 2100 bytes a second.
TEST(Injected, ANarrowLineCarriesItsRateAndCountsTheRest) {
    Line line(plan("rate:1050/420"));
    line.send(many);
    const LinkCounters& c = line.counters;
    EXPECT_EQ(c.frames_in.value() + c.fault_queue.value(), many);
    EXPECT_EQ(c.lost.value() + at_the_ends(line), c.fault_queue.value());
    EXPECT_NEAR(static_cast<double>(c.frames_in.value()), 0.5 * many + 20, 2) << "half of it, and the full queue";
    for (std::size_t i = 1; i < line.times.size(); ++i) ASSERT_GE(line.times[i] - line.times[i - 1], 20ms);
}

TEST(Injected, TheOrderOfFaultsIsThatOfNetem) {
    Line line(plan("rate:1050/420,loss:0.5"));  // as typed, the queue would come first
    line.send(many);
    EXPECT_NEAR(static_cast<double>(line.counters.fault_lost.value()), 0.5 * many, 5 * 71);
    EXPECT_LT(line.counters.fault_queue.value(), many / 20) << "what is lost does not load the line";
}

TEST(Injected, TheSameSeedDoesTheSame) {
    const char* const faults =
        "loss:0.1/3,duplicate:0.05,corrupt:0.02,cut:0.02,delay:80ms~40ms,reorder:0.05/60ms,rate:2k";
    const auto fate = [&](std::uint64_t seed, std::uint64_t ordinal = 0) {
        Line line(plan(faults, seed), ordinal);
        line.send(2000);
        return std::pair(line.arrived, line.times);
    };
    EXPECT_EQ(fate(1), fate(1));
    EXPECT_NE(fate(1), fate(2));
    EXPECT_NE(fate(1), fate(1, 1)) << "another link of the endpoint";
}

TEST(Injected, WithoutFaultsThereAreNoStages) {
    LinkCounters counters;
    const auto stages = stages_of(plan("loss:0"), "line", {LinkId{1}, "line", true, 0, counters, table()});
    EXPECT_THAT(stages.in, IsEmpty());
    EXPECT_THAT(stages.out, IsEmpty());
    EXPECT_EQ(stages.text, "");
}

// ---- links ----------------------------------------------------------------------------------------------------------

struct FaultyNode : Node {
    link::EndpointId open(const std::string& url) {
        const auto id = fault::add(*links, endpoint_of(url));
        EXPECT_TRUE(id) << url;
        return id.value_or(link::EndpointId{});
    }
    [[nodiscard]] std::string error_of(std::string_view name, const Change& wanted) {
        const auto changed = fault::change(*links, name, wanted);
        return changed ? "" : changed.error().text;
    }
    [[nodiscard]] std::string stages_text() const { return links->links().at(0).stages; }
};

TEST(FaultyLinks, LoseAndCountAndReportIt) {
    FaultyNode node;
    const auto id = node.open("udpin://127.0.0.1:0?name=radio&in_fault=loss:1");
    const auto far = PlainSocket::udp();
    for (std::uint8_t i = 0; i < 10; ++i) far.send_to(node.port(id), heartbeat(i));
    ASSERT_TRUE(until([&] { return !node.recorder.ups.empty(); }, node));
    const LinkId link = node.recorder.ups.at(0).first;
    ASSERT_TRUE(until([&] { return node.counters(link).fault_lost.value() == 10; }, node));
    EXPECT_THAT(node.recorder.frames, IsEmpty());
    EXPECT_THAT(node.recorder.notices, ::testing::Contains("radio: faults on purpose: in loss:1, out off, seed 1"));
    EXPECT_EQ(node.stages_text(), "in loss:1, out off, seed 1");
}

TEST(FaultyLinks, OfAStreamLoseWholeFrames) {
    FaultyNode node;
    const auto id = node.open("tcpin://127.0.0.1:0?name=radio&in_fault=loss:0.5");
    const auto far = PlainSocket::connected_tcp(node.port(id));
    Bytes all;
    for (int i = 0; i < 200; ++i) all = std::move(all) + attitude(static_cast<std::uint8_t>(i));
    far.write(all);
    ASSERT_TRUE(until([&] { return !node.recorder.ups.empty(); }, node));
    const LinkCounters& c = node.counters(node.recorder.ups.at(0).first);
    ASSERT_TRUE(until([&] { return c.frames_in.value() + c.fault_lost.value() == 200; }, node));
    EXPECT_GT(c.fault_lost.value(), 50u);
    EXPECT_EQ(c.junk_bytes.value() + c.crc_error.value(), 0u);
}

// The link must have no more traffic: a later byte would end the wait.
TEST(FaultyLinks, OfAStreamDeliverAFrameBehindNoiseInSilence) {
    FaultyNode node;
    const auto id = node.open("tcpin://127.0.0.1:0?name=radio&in_fault=loss:0.000001");
    const auto far = PlainSocket::connected_tcp(node.port(id));
    far.write(Bytes{0xFD} + heartbeat(0));
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 1; }, node));
    EXPECT_EQ(node.recorder.bytes(), heartbeat(0));
}

// A read ends within a frame when the faults change.
TEST(FaultyLinks, OfAStreamKeepAFrameThatIsUnderWayWhenFaultsChange) {
    FaultyNode node;
    const auto id = node.open("tcpin://127.0.0.1:0?name=radio&in_fault=duplicate:1");
    const auto far = PlainSocket::connected_tcp(node.port(id));
    const Bytes first = attitude(0), second = attitude(1);
    far.write(first + Bytes(second.begin(), second.begin() + 10));
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 2; }, node));
    ASSERT_TRUE(fault::change(*node.links, "radio", {.in = "off", .out = "off"}));
    far.write(Bytes(second.begin() + 10, second.end()));
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 3; }, node));
    EXPECT_EQ(node.recorder.bytes(), first + first + second);
    EXPECT_EQ(node.stages_text(), "");
}

TEST(FaultyLinks, ChangeWhileTheyRun) {
    FaultyNode node;
    const auto id = node.open("udpin://127.0.0.1:0?name=radio&fault_seed=9&fault=off");
    const auto far = PlainSocket::udp(), other = PlainSocket::udp();
    far.send_to(node.port(id), heartbeat(0));
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 1; }, node));
    EXPECT_EQ(node.stages_text(), "");

    const auto name = node.recorder.ups.at(0).second;
    EXPECT_EQ(fault::change(*node.links, name, {.in = "loss:1", .out = "sik"}), "in loss:1, out sik, seed 9");
    far.send_to(node.port(id), heartbeat(1));
    other.send_to(node.port(id), heartbeat(0, 2));
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 2; }, node)) << "only the one link has them";
    const LinkCounters& c = node.counters(node.recorder.ups.at(0).first);
    ASSERT_TRUE(until([&] { return c.fault_lost.value() == 1; }, node));

    EXPECT_EQ(fault::change(*node.links, "radio", {.in = "wifi", .out = "wifi", .seed = "4"}),
              "in and out wifi, seed 4");
    for (const auto& link : node.links->links()) EXPECT_EQ(link.stages, "in and out wifi, seed 4");
    EXPECT_EQ(fault::change(*node.links, "radio", {.in = "off"}), "in off, out wifi, seed 4");
    EXPECT_EQ(fault::change(*node.links, name, {.in = "loss:1"}), "in loss:1, out wifi, seed 4");
    EXPECT_EQ(fault::change(*node.links, "radio", {.out = "off"}), "off");
    far.send_to(node.port(id), heartbeat(2));
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 3; }, node));
    for (const auto& link : node.links->links()) EXPECT_EQ(link.stages, "");
}

// The second peer keeps its random numbers when the first one leaves and the faults begin again.
TEST(FaultyLinks, KeepTheirNumberWhenAnEarlierOneLeaves) {
    const auto fate_of_second = [](bool first_leaves) {
        FaultyNode node;
        const auto id = node.open("udpin://127.0.0.1:0?name=radio");
        const auto first = PlainSocket::udp(), second = PlainSocket::udp();
        first.send_to(node.port(id), heartbeat(0));
        EXPECT_TRUE(until([&] { return node.recorder.ups.size() == 1; }, node));
        second.send_to(node.port(id), heartbeat(0, 2));
        EXPECT_TRUE(until([&] { return node.recorder.ups.size() == 2; }, node));
        if (first_leaves) EXPECT_TRUE(node.links->close(node.recorder.ups.at(0).first));
        EXPECT_TRUE(fault::change(*node.links, "radio", {.in = "loss:0.5"}));
        const LinkCounters& c = node.counters(node.recorder.ups.at(1).first);
        std::string fate;
        for (std::uint8_t i = 1; i <= 40; ++i) {
            const auto lost = c.fault_lost.value(), heard = c.frames_in.value();
            second.send_to(node.port(id), heartbeat(i, 2));
            EXPECT_TRUE(until([&] { return c.fault_lost.value() + c.frames_in.value() > lost + heard; }, node));
            fate += c.fault_lost.value() > lost ? 'x' : '.';
        }
        return fate;
    };
    EXPECT_EQ(fate_of_second(true), fate_of_second(false));
}

TEST(FaultyLinks, ImpossibleChangesAreRefused) {
    FaultyNode node;
    (void)node.open("udpin://127.0.0.1:0?name=radio");
    (void)node.open("shm://faults_test");
    EXPECT_THAT(node.error_of("radoi", {.in = "sik"}), HasSubstr("no endpoint or link 'radoi'"));
    EXPECT_THAT(node.error_of("radio", {}), HasSubstr("'in', 'out' or both are missing"));
    EXPECT_THAT(node.error_of("radio", {.seed = "2"}), HasSubstr("'in', 'out' or both are missing"));
    EXPECT_NE(node.error_of("radio", {.in = ""}), "");
    EXPECT_THAT(node.error_of("radio", {.in = "sick"}), HasSubstr("did you mean 'sik'?"));
    EXPECT_THAT(node.error_of("radio", {.out = "cut:0.1"}), HasSubstr("fault of byte streams"));
    EXPECT_THAT(node.error_of("radio", {.in = "sik", .seed = "x"}), HasSubstr("seed: 'x' is not a whole"));
    EXPECT_THAT(node.error_of("shm://faults_test", {.in = "sik"}), HasSubstr("is a ring"));
}

}  // namespace
}  // namespace mavloom::fault
