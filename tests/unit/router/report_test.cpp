// SPDX-License-Identifier: MIT
#include "mavloom/router/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mavloom/dialect/dialect.hpp"

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

// Its text is made on another thread, while the router continues.
TEST_F(RouterReport, IsACopyThatNeedsNoRouter) {
    const auto stats = report_stats(*router);
    const auto metrics = report_metrics(*router);
    const auto links = answer_request(*router, R"({"cmd":"links"})");
    router.reset();

    EXPECT_THAT(stats(),
                ElementsAre(StartsWith(R"({"kind":"router",)"), StartsWith(R"({"kind":"endpoint","endpoint":"far",)"),
                            StartsWith(R"({"kind":"gone","endpoint":"far",)"),
                            StartsWith(R"({"kind":"link","link":"far","endpoint":"far",)")));
    EXPECT_THAT(metrics(), HasSubstr("mavloom_link_frames_in_total{link=\"far\"} 0\n"));
    // These numbers are corrected later and may fall, which Prometheus takes for the restart of a counter.
    EXPECT_THAT(metrics(), AllOf(HasSubstr("# TYPE mavloom_link_lost_total gauge\n"),
                                 HasSubstr("# TYPE mavloom_gone_resync_total gauge\n"),
                                 HasSubstr("# TYPE mavloom_link_frames_in_total counter\n")));
    EXPECT_THAT(links(), ElementsAre(StartsWith(R"({"kind":"link","link":"far",)"), R"({"ok":true})"));
}

TEST_F(RouterReport, RefusesWhatIsNoRequest) {
    EXPECT_THAT(answer_request(*router, "links")(), ElementsAre(StartsWith(R"({"ok":false,"error":"a request is)")));
    EXPECT_THAT(answer_request(*router, R"({"cmd":"fly"})")(),
                ElementsAre(AllOf(StartsWith(R"({"ok":false,)"), HasSubstr("'fly'"))));
}

}  // namespace
}  // namespace mavloom::router
