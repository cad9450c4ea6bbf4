// SPDX-License-Identifier: MIT
// The simulator on real sockets: allocations, and answers to control requests.
#include "mavloom/simserve/simulator.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/simserve/report.hpp"
#include "support/count_allocations.hpp"

namespace mavloom::simserve {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

// A bound UDP socket that nobody reads: the kernel drops what does not fit.
class Receiver {
public:
    Receiver() {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        EXPECT_EQ(::bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
        socklen_t size = sizeof address;
        ::getsockname(fd_, reinterpret_cast<sockaddr*>(&address), &size);
        port_ = ntohs(address.sin_port);
    }
    Receiver(const Receiver&) = delete;
    Receiver& operator=(const Receiver&) = delete;
    ~Receiver() { ::close(fd_); }
    [[nodiscard]] int port() const { return port_; }

private:
    int fd_ = ::socket(AF_INET, SOCK_DGRAM, 0);
    int port_ = 0;
};

struct SimulatorTest : testing::Test {
    SimulatorTest() { create({.profile = sim::Profile::px4_normal}); }

    void create(const SimulatorOptions& options, std::string_view endpoint_options = "") {
        auto made = Simulator::create(dialect::default_dialect(), options, [](config::LogLevel, std::string_view) {});
        sut = std::move(*made);
        EXPECT_TRUE(sut->add(sim::VehicleOptions{}));
        const auto url = fmt::format("udpout://127.0.0.1:{}{}", receiver.port(), endpoint_options);
        EXPECT_TRUE(sut->add({*endpoint::parse_endpoint(url)}));
    }

    void run(Nanoseconds time) {
        for (const MonoTime end = mono_now() + time; mono_now() < end;) sut->turn(end);
    }
    [[nodiscard]] std::string answer(std::string_view request) const { return sut->answer(request).next_text(); }

    Receiver receiver;
    std::unique_ptr<Simulator> sut;
};

TEST_F(SimulatorTest, SendsWithoutAllocating) {
    run(300ms);
    const auto sent = sut->totals().frames_sent;
    // Most turns do nothing but send; those that refresh pages and look after links may allocate.
    std::size_t turns = 0, clean = 0;
    for (const MonoTime end = mono_now() + 1s; mono_now() < end; ++turns) {
        const std::size_t before = test::allocations;
        sut->turn(end);
        clean += test::allocations == before ? 1 : 0;
    }

    EXPECT_GT(sut->totals().frames_sent, sent + 100);
    EXPECT_GE(clean + 12, turns);
}

TEST_F(SimulatorTest, ALimitCountsRealSecondsAtEverySpeed) {
    create({.speed = 4, .profile = sim::Profile::px4_normal}, "?max_bytes=10000");
    run(500ms);
    const auto before = sut->totals().bytes_sent;
    run(2s);
    const auto bytes_s = static_cast<double>(sut->totals().bytes_sent - before) / 2;
    EXPECT_GT(bytes_s, 5'000);
    EXPECT_LT(bytes_s, 12'000);
}

TEST_F(SimulatorTest, AnswersRequests) {
    run(50ms);
    EXPECT_THAT(answer(R"({"cmd":"state"})"), testing::StartsWith(R"({"kind":"vehicle","system":1,"type":"quad")"));
    EXPECT_THAT(answer(R"({"cmd":"state"})"), testing::EndsWith("{\"ok\":true}\n"));
    EXPECT_THAT(answer(R"({"cmd":"state"})"), HasSubstr(R"("not_finite":0)"));
    EXPECT_THAT(answer(R"({"cmd":"streams"})"), HasSubstr(R"("name":"ATTITUDE","asked_hz":50.0)"));
    EXPECT_THAT(sut->metrics().next_text(), HasSubstr("mavloom_sim_frames_sent_total{}"));
}

TEST_F(SimulatorTest, BadRequestsAreAnswered) {
    for (const auto request : {"", "{", "[]", "1", "null", R"({"cmd":1})", R"({"cmd":"fly"})",
                               R"({"cmd":"arm","system":"1"})", R"({"cmd":"arm","system":1e99})",
                               R"({"cmd":"takeoff","altitude":"high"})", R"({"cmd":"takeoff","altitude":1e400})",
                               R"({"cmd":"mode","mode":"\u0000"})", R"({"cmd":"param","name":"","value":1})",
                               R"({"cmd":"add","url":"udpin"})", R"({"cmd":"remove","name":"x"})"}) {
        const auto lines = answer(request);
        EXPECT_THAT(lines, testing::StartsWith(R"({"ok":false,"error":")")) << request;
        EXPECT_EQ(std::ranges::count(lines, '\n'), 1) << request;
    }
}

TEST_F(SimulatorTest, AValueOfTheWrongTypeIsAnError) {
    const auto error = [](std::string_view text) { return fmt::format("{{\"ok\":false,\"error\":\"{}\"}}\n", text); };
    EXPECT_EQ(answer(R"({"cmd":"param","name":"MIS_TAKEOFF_ALT","value":"20"})"), error("'value' is not a number"));
    EXPECT_EQ(answer(R"({"cmd":"arm","system":"1"})"), error("'system' is not a number"));
    EXPECT_EQ(answer(R"({"cmd":"arm","force":1})"), error("'force' is neither true nor false"));
    EXPECT_EQ(answer(R"({"cmd":"arm","system":7})"), error("there is no vehicle 7"));
}

// The bytes of three seconds of a flight, by such steps.
std::string flown_by(Nanoseconds step) {
    const auto path = std::filesystem::path(testing::TempDir()) / fmt::format("steps-{}.tlog", ::getpid());
    auto sut = *Simulator::create(
        dialect::default_dialect(),
        {.speed = max_speed, .utc_at_start = WallTime{1'000'000s}, .orders = {{2500ms, "arm", R"({"cmd":"arm"})"}}},
        [](config::LogLevel, std::string_view) {});
    EXPECT_TRUE(sut->open_recording(path));
    EXPECT_TRUE(sut->add(sim::VehicleOptions{}));
    sut->pause();
    sut->turn(MonoTime{});
    for (Nanoseconds flown{}; flown < 3s; flown += step) EXPECT_TRUE(sut->step(step));
    EXPECT_EQ(sut->flight_time(), 3s);
    EXPECT_TRUE(sut->finish({}));
    std::ifstream file(path, std::ios::binary);
    std::string bytes(std::istreambuf_iterator<char>(file), {});
    std::filesystem::remove(path);
    return bytes;
}

TEST(Simulator, AFlightDoesNotDependOnItsSteps) {
    const auto flight = flown_by(3s);
    EXPECT_GT(flight.size(), 10'000u);
    for (const Nanoseconds step : {Nanoseconds{1ms}, Nanoseconds{7500us}, Nanoseconds{500ms}})
        EXPECT_TRUE(flown_by(step) == flight) << step.count();
}

}  // namespace
}  // namespace mavloom::simserve
