// SPDX-License-Identifier: MIT
#include "mavloom/router/report.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "mavloom/dialect/dialect.hpp"
#include "unit/link/fixture.hpp"

namespace mavloom::router {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

struct RouterReport : testing::Test {
    RouterReport()
        : router(*Router::create(dialect::default_dialect(), {}, [](config::LogLevel, std::string_view) {})) {
        EXPECT_TRUE(router->add(*endpoint::parse_endpoint("udpout://127.0.0.1:9?name=far")));
    }
    std::unique_ptr<Router> router;
};

void copy_all(const Report& report) {
    while (report.copy_more && report.copy_more()) {}
}

std::string text_of(const Report& report) {
    std::string all;
    for (auto piece = report.next_text(); !piece.empty(); piece = report.next_text()) all += piece;
    return all;
}

std::vector<std::string> lines_of(const Report& report) {
    std::vector<std::string> lines;
    std::istringstream text(text_of(report));
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return lines;
}

// Its text is made on another thread, while the router continues.
TEST_F(RouterReport, IsACopyThatNeedsNoRouter) {
    const auto stats = report_stats(*router);
    const auto metrics = report_metrics(*router);
    const auto links = answer_request(*router, R"({"cmd":"links"})");
    for (const auto* report : {&stats, &metrics, &links}) copy_all(*report);
    router.reset();

    EXPECT_THAT(lines_of(stats),
                ElementsAre(StartsWith(R"({"kind":"router",)"), StartsWith(R"({"kind":"endpoint","endpoint":"far",)"),
                            StartsWith(R"({"kind":"gone","endpoint":"far",)"),
                            StartsWith(R"({"kind":"link","link":"far","endpoint":"far",)"), R"({"ok":true})"));
    // These numbers are corrected later and may fall, which Prometheus takes for the restart of a counter.
    EXPECT_THAT(text_of(metrics), AllOf(HasSubstr("mavloom_link_frames_in_total{link=\"far\"} 0\n"),
                                        HasSubstr("# TYPE mavloom_link_lost_total gauge\n"),
                                        HasSubstr("# TYPE mavloom_gone_resync_total gauge\n"),
                                        HasSubstr("# TYPE mavloom_link_frames_in_total counter\n")));
    EXPECT_THAT(lines_of(links), ElementsAre(StartsWith(R"({"kind":"link","link":"far",)"), R"({"ok":true})"));
}

TEST_F(RouterReport, RefusesWhatIsNoRequest) {
    EXPECT_THAT(lines_of(answer_request(*router, "links")),
                ElementsAre(StartsWith(R"({"ok":false,"error":"a request is)")));
    EXPECT_THAT(lines_of(answer_request(*router, R"({"cmd":"fly"})")),
                ElementsAre(AllOf(StartsWith(R"({"ok":false,)"), HasSubstr("'fly'"))));
}

link::testing::Bytes heartbeat_of(unsigned sender) {
    const Source source{SystemId{static_cast<std::uint8_t>(1 + sender / 250)},
                        ComponentId{static_cast<std::uint8_t>(1 + sender % 250)}};
    wire::FrameBuffer buffer;
    const auto frame = wire::write_frame(buffer, {wire::Version::v2, 0, source},
                                         *link::testing::table().find(MessageId{0}), link::testing::Bytes(9, 1));
    return {frame.bytes().begin(), frame.bytes().end()};
}

// A sender that invents ids: one link with `senders` of them, each of which sent one frame.
struct ReportOfManySenders : RouterReport {
    static constexpr unsigned senders = 3000;
    ReportOfManySenders() {
        EXPECT_TRUE(router->add(*endpoint::parse_endpoint(fmt::format("udpin://127.0.0.1:{}", port))));
        for (unsigned i = 0; i < senders; ++i) {
            socket.send_to(port, heartbeat_of(i));
            for (const auto deadline = mono_now() + std::chrono::minutes(1); heard() <= i && mono_now() < deadline;)
                router->turn(mono_now() + std::chrono::milliseconds(1));
        }
        EXPECT_EQ(heard(), senders);
    }
    [[nodiscard]] std::uint64_t heard() const {
        std::uint64_t sum = 0;
        for (const auto& link : router->links().links()) sum += link.counters->frames_in.value();
        return sum;
    }

    link::testing::PlainSocket socket = link::testing::PlainSocket::udp();
    std::uint16_t port = link::testing::PlainSocket::udp().port();
};

// One turn copied everything, up to 29 ms.
TEST_F(ReportOfManySenders, IsCopiedInPieces) {
    const auto report = report_stats(*router);
    std::size_t pieces = 1;
    while (report.copy_more()) ++pieces;

    const auto lines = lines_of(report);
    EXPECT_GE(pieces, senders / 512);
    EXPECT_EQ(std::ranges::count_if(lines, [](const auto& l) { return l.starts_with(R"({"kind":"source")"); }), senders);
    EXPECT_EQ(std::ranges::count_if(lines, [](const auto& l) { return l.starts_with(R"({"kind":"message")"); }),
              senders);
}

TEST_F(ReportOfManySenders, IsWrittenInPieces) {
    const auto report = report_stats(*router);
    copy_all(report);

    std::size_t pieces = 0;
    for (auto piece = report.next_text(); !piece.empty(); piece = report.next_text()) ++pieces;
    EXPECT_GE(pieces, 5u);
}

TEST_F(ReportOfManySenders, RequestsThatWaitShareACopy) {
    constexpr std::size_t requests = 8;
    const auto running = report_stats(*router);
    ASSERT_TRUE(running.copy_more());
    std::vector<Report> waiting;
    for (std::size_t i = 0; i < requests; ++i) waiting.push_back(report_stats(*router));
    copy_all(running);

    std::size_t pieces = 0;
    for (const auto& report : waiting)
        for (++pieces; report.copy_more();) ++pieces;
    EXPECT_LT(pieces, requests + 2 * senders / 256);
    for (const auto& report : waiting) EXPECT_EQ(lines_of(report).back(), R"({"ok":true})");
}

}  // namespace
}  // namespace mavloom::router
