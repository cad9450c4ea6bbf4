// SPDX-License-Identifier: MIT
#include "mavloom/control/metrics_text.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "mavloom/base/version.hpp"

namespace mavloom::control {
namespace {

TEST(MetricsText, EachMetricHasItsHelpAndTypeBeforeItsSamples) {
    MetricsText sut;
    constexpr std::string_view crc_error_help = "frames with a wrong checksum";
    sut.add("link", {"crc_error", 5, crc_error_help}, MetricsText::label("link", "A"));
    sut.add("link", {"lost", 7, "frames that the link lost, by gaps in the sequence numbers"},
            MetricsText::label("link", "A"));
    sut.add("link", {"crc_error", 6, crc_error_help}, MetricsText::label("link", "B"));

    EXPECT_EQ(sut.text(),
              fmt::format("# HELP mavloom_build_info The version of Mavloom.\n"
                          "# TYPE mavloom_build_info gauge\n"
                          "mavloom_build_info{{version=\"{}\"}} 1\n"
                          "# HELP mavloom_link_crc_error_total Of each link: frames with a wrong checksum.\n"
                          "# TYPE mavloom_link_crc_error_total counter\n"
                          "mavloom_link_crc_error_total{{link=\"A\"}} 5\n"
                          "mavloom_link_crc_error_total{{link=\"B\"}} 6\n"
                          "# HELP mavloom_link_lost_total Of each link: frames that the link lost, by gaps in "
                          "the sequence numbers.\n"
                          "# TYPE mavloom_link_lost_total gauge\n"
                          "mavloom_link_lost_total{{link=\"A\"}} 7\n",
                          version()));
}

}  // namespace
}  // namespace mavloom::control
